#pragma once

#include <filesystem>

#include "host/api/error.h"
#include "host/app/frame_writer.h"

namespace meridian::app {

/// Writes a picture as RGB, 8 bits (alpha left out: it holds no coverage). Errors: the file cannot be created; the disk
/// is full.
[[nodiscard]] Result<void> writePng(const std::filesystem::path& file, const Picture& picture);

}  // namespace meridian::app
