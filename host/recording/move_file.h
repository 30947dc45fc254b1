#pragma once

#include <filesystem>

#include "host/api/error.h"

namespace meridian::recording {

/// Moves a file, to another file system if need be. `from` goes only when all of it is there, and what was at `to`
/// stays as it was otherwise. Errors: it cannot be put there; they say where it still is.
[[nodiscard]] Result<void> moveFile(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace meridian::recording
