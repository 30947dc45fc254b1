#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "host/api/error.h"

namespace meridian::graphics {

/// Words kept in a picture (PNG tEXt, iTXt where they are not ASCII): UTF-8 by keys of 1 to 79 ASCII characters, such
/// as "Software".
using ImageMetadata = std::map<std::string, std::string>;

/// RGBA, 8 bits each, rows from top to bottom without gaps.
struct Image {
  glm::ivec2 size{0};
  std::vector<std::uint8_t> pixels;
  ImageMetadata metadata;
};

struct PngOptions {
  bool alpha = false;   ///< without it the picture is opaque RGB
  int compression = 2;  ///< zlib's level, 0 to 9
  ImageMetadata metadata{};
};

/// Writes a PNG beside `file` and renames it, so that nobody sees half of one. `pixels` as in Image. Needs no OpenGL
/// and may be called from any thread. Errors: sizes that do not fit, a folder that is not there or cannot be written.
[[nodiscard]] Result<void> writePng(const std::filesystem::path& file, std::span<const std::uint8_t> pixels,
                                    glm::ivec2 size, const PngOptions& options = {});

/// Reads any PNG as RGBA. Errors: no such file, not a PNG, damaged, or larger than 16384 pixels along a side.
[[nodiscard]] Result<Image> readPng(const std::filesystem::path& file);

}  // namespace meridian::graphics
