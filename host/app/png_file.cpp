#include "host/app/png_file.h"

#include <cstdio>
#include <memory>

#include <fmt/format.h>
#include <png.h>

namespace meridian::app {
namespace {

std::vector<std::uint8_t> withoutAlpha(const std::vector<std::uint8_t>& rgba) {
  std::vector<std::uint8_t> rgb(rgba.size() / 4 * 3);
  for (std::size_t pixel = 0; pixel < rgba.size() / 4; ++pixel) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      rgb[3 * pixel + channel] = rgba[4 * pixel + channel];
    }
  }
  return rgb;
}

}  // namespace

Result<void> writePng(const std::filesystem::path& file, const Picture& picture) {
  const std::vector<std::uint8_t> rgb = withoutAlpha(picture.rgba);
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.size.x);
  image.height = static_cast<png_uint_32>(picture.size.y);
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;
  if (png_image_write_to_file(&image, file.c_str(), 0, rgb.data(), 0, nullptr) == 0) {
    return failure(fmt::format("the picture cannot be written: {}", image.message), file.string(),
                   "check that the folder can be written and the disk has space left");
  }
  return {};
}

}  // namespace meridian::app
