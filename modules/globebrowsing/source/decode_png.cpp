#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>

#include <png.h>

#include "globebrowsing/source/tile_formats.h"

namespace meridian::globebrowsing {

namespace {

struct Input {
  std::span<const std::uint8_t> rest;
  std::array<char, 128> message{};
};

// These leave by longjmp, so nothing between here and setjmp may need a destructor.
void read(png_structp png, png_bytep target, std::size_t count) {
  auto& input = *static_cast<Input*>(png_get_io_ptr(png));
  if (count > input.rest.size()) {
    png_error(png, "the data end early");
  }
  std::memcpy(target, input.rest.data(), count);
  input.rest = input.rest.subspan(count);
}

[[noreturn]] void leave(png_structp png, png_const_charp message) {
  auto& input = *static_cast<Input*>(png_get_error_ptr(png));
  std::strncpy(input.message.data(), message, input.message.size() - 1);
  png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

bool readHeader(png_structp png, png_infop info) {
  if (setjmp(png_jmpbuf(png)) != 0) {
    return false;
  }
  png_set_user_limits(png, longestTileSide, longestTileSide);
  png_set_chunk_cache_max(png, 64);
  png_set_chunk_malloc_max(png, 1 << 20);
  png_read_info(png, info);
  return true;
}

/// Eight bits, RGB and alpha, values as they are stored: no gamma.
bool readPixels(png_structp png, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) {
    return false;
  }
  png_set_expand(png);
  png_set_scale_16(png);
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xFF, PNG_FILLER_AFTER);
  png_set_interlace_handling(png);
  png_start_read_image(png);
  png_read_image(png, rows);
  png_read_end(png, nullptr);
  return true;
}

}  // namespace

TileResult<DecodedImage> decodePng(std::span<const std::uint8_t> bytes, const std::string& where,
                                   const ImageLimits& limits) {
  Input input{bytes};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, leave, ignore);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  if (info == nullptr) {
    png_destroy_read_struct(&png, nullptr, nullptr);
    return failure("there is no memory to read a PNG", where);
  }
  png_set_read_fn(png, &input, read);
  DecodedImage image;
  const auto failed = [&]() -> TileResult<DecodedImage> {
    png_destroy_read_struct(&png, &info, nullptr);
    return failure(std::string("the PNG is damaged (") + input.message.data() + ")", where);
  };
  if (!readHeader(png, info)) {
    return failed();
  }
  const png_uint_32 width = png_get_image_width(png, info);
  const png_uint_32 height = png_get_image_height(png, info);
  if (auto good = checkTileSize(width, height, where, limits); !good) {
    png_destroy_read_struct(&png, &info, nullptr);
    return tl::make_unexpected(std::move(good.error()));
  }
  image.hasAlpha =
      (png_get_color_type(png, info) & PNG_COLOR_MASK_ALPHA) != 0 || png_get_valid(png, info, PNG_INFO_tRNS) != 0;
  image.tile.width = static_cast<int>(width);
  image.tile.height = static_cast<int>(height);
  image.tile.rgba.resize(std::size_t{4} * width * height);
  std::vector<png_bytep> rows(height);
  for (std::size_t row = 0; row < height; ++row) {
    rows[row] = image.tile.rgba.data() + row * width * 4;
  }
  if (!readPixels(png, rows.data())) {
    return failed();
  }
  png_destroy_read_struct(&png, &info, nullptr);
  return image;
}

}  // namespace meridian::globebrowsing
