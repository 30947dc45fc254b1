#include <csetjmp>
#include <cstddef>
#include <cstdio>

#include <jerror.h>
#include <jpeglib.h>  // needs cstdio before it

#include "globebrowsing/source/tile_formats.h"

namespace meridian::globebrowsing {

namespace {

/// libjpeg's state, with what its callbacks need, for one picture after another: to make it takes a fiftieth of a
/// tile's time. Callbacks leave by longjmp, so nothing between may need a destructor.
struct Decompression {
  jpeg_decompress_struct info{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf leave{};
  char message[JMSG_LENGTH_MAX]{};

  Decompression() = default;
  Decompression(const Decompression&) = delete;
  Decompression& operator=(const Decompression&) = delete;
  ~Decompression() { jpeg_destroy_decompress(&info); }
};

[[noreturn]] void leave(j_common_ptr info) {
  auto& state = *static_cast<Decompression*>(info->client_data);
  info->err->format_message(info, static_cast<char*>(state.message));
  std::longjmp(static_cast<std::jmp_buf&>(state.leave), 1);
}

/// Data that end early are filled with grey by the library; here they are errors. All other warnings are harmless.
void warn(j_common_ptr info, int level) {
  if (level < 0 && (info->err->msg_code == JWRN_JPEG_EOF || info->err->msg_code == JWRN_HIT_MARKER)) {
    leave(info);
  }
}

/// A small file can ask for thousands of passes over a large picture.
void watch(j_common_ptr info) {
  constexpr int mostScans = 100;
  if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number > mostScans) {
    info->err->msg_code = JERR_BAD_PROGRESSION;
    leave(info);
  }
}

void begin(Decompression& state, std::span<const std::uint8_t> bytes) {
  if (state.info.mem == nullptr) {
    jpeg_create_decompress(&state.info);
    state.info.client_data = &state;
  }
  jpeg_mem_src(&state.info, bytes.data(), static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&state.info, TRUE);
}

void prepare(Decompression& state) {
  state.info.err = jpeg_std_error(&state.errors);
  state.errors.error_exit = leave;
  state.errors.emit_message = warn;
  state.info.client_data = &state;
}

bool readHeader(Decompression& state, std::span<const std::uint8_t> bytes) {
  if (setjmp(static_cast<std::jmp_buf&>(state.leave)) != 0) {
    return false;
  }
  begin(state, bytes);
  return true;
}

bool readPixels(Decompression& state, std::uint8_t* rgba) {
  if (setjmp(static_cast<std::jmp_buf&>(state.leave)) != 0) {
    return false;
  }
  state.progress.progress_monitor = watch;
  state.info.progress = &state.progress;
  state.info.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&state.info);
  while (state.info.output_scanline < state.info.output_height) {
    JSAMPROW row = rgba + std::size_t{4} * state.info.output_width * state.info.output_scanline;
    jpeg_read_scanlines(&state.info, &row, 1);
  }
  jpeg_finish_decompress(&state.info);
  return true;
}

}  // namespace

TileResult<DecodedImage> decodeJpeg(std::span<const std::uint8_t> bytes, const std::string& where,
                                    const ImageLimits& limits) {
  thread_local Decompression state;
  prepare(state);
  DecodedImage image;
  const auto failed = [&]() -> TileResult<DecodedImage> {
    jpeg_abort_decompress(&state.info);
    return failure(std::string("the JPEG is damaged (") + static_cast<const char*>(state.message) + ")", where);
  };
  if (!readHeader(state, bytes)) {
    return failed();
  }
  const auto width = static_cast<std::int64_t>(state.info.image_width);
  const auto height = static_cast<std::int64_t>(state.info.image_height);
  if (auto good = checkTileSize(width, height, where, limits); !good) {
    jpeg_abort_decompress(&state.info);
    return tl::make_unexpected(std::move(good.error()));
  }
  if (state.info.num_components == 4) {  // inks: rare, and GDAL knows their variants
    jpeg_abort_decompress(&state.info);
    return decodeByGdal(bytes, where, limits);
  }
  image.tile.width = static_cast<int>(width);
  image.tile.height = static_cast<int>(height);
  image.tile.rgba.resize(static_cast<std::size_t>(width * height * 4));
  if (!readPixels(state, image.tile.rgba.data())) {
    return failed();
  }
  jpeg_abort_decompress(&state.info);
  return image;
}

}  // namespace meridian::globebrowsing
