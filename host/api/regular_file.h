#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "host/api/error.h"

namespace meridian {

/// What text that people write may take; for readRegularFile.
inline constexpr std::uintmax_t largestText = std::uintmax_t{16} << 20;

/// Refuses what is no regular file, without opening it: opening a pipe waits for its other end, and a device may never
/// end. `thing` begins the error ("the script"). Errors: there is no such file; a folder; anything else.
[[nodiscard]] Result<void> requireRegularFile(const std::filesystem::path& file, const std::string& thing,
                                              const std::string& remedy);

/// All of a regular file of at most that many bytes. Blocking. Errors also: larger; unreadable.
[[nodiscard]] Result<std::string> readRegularFile(const std::filesystem::path& file, std::uintmax_t mostBytes,
                                                  const std::string& thing, const std::string& remedy);

}  // namespace meridian
