#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"
#include "host/api/module.h"

namespace meridian::assets {

/// `${NAME}` at the beginning of a path stands for a folder, and says what scripts may touch: they read below every
/// token's folder and write below those of SYNC, CACHE and TEMPORARY.
class PathTokens {
 public:
  PathTokens() = default;
  /// ASSETS, SYNC, CACHE, TEMPORARY, DATA, SHADERS, LOGS, and the others of OpenSpace's configuration below DATA, such
  /// as USER (DATA/user), SCRIPTS and GLOBEBROWSING; RECORDINGS is below SYNC.
  explicit PathTokens(const Paths& paths);

  /// `name` with or without "${" and "}"; `folder` is absolute.
  void set(std::string_view name, const std::filesystem::path& folder);
  [[nodiscard]] const std::filesystem::path* find(std::string_view name) const;
  /// Replaces a leading token and removes "." and "..". Errors: an unknown token, one that is not closed.
  [[nodiscard]] Result<std::filesystem::path> expand(std::string_view text) const;

  /// Folders besides the tokens' that may be read: those of assets.
  void allowReading(const std::filesystem::path& folder);
  /// Whether `path`, with its symbolic links resolved, lies below a folder that may be read (written). Errors say where
  /// reading (writing) is allowed.
  [[nodiscard]] Result<std::filesystem::path> readable(const std::filesystem::path& path) const;
  [[nodiscard]] Result<std::filesystem::path> writable(const std::filesystem::path& path) const;

 private:
  std::map<std::string, std::filesystem::path, std::less<>> folders_;
  std::vector<std::filesystem::path> readable_;
};

/// Whether `path` is `folder` or below it. Both absolute and free of links and "..".
[[nodiscard]] bool isBelow(const std::filesystem::path& path, const std::filesystem::path& folder);

}  // namespace meridian::assets
