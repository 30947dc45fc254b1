#pragma once

#include <filesystem>
#include <optional>

#include "host/api/error.h"
#include "host/api/module.h"

namespace meridian::app {

/// A fresh folder that goes with everything in it when this does.
class TemporaryFolder {
 public:
  /// Below the system's folder for such things. Errors: it cannot be made.
  [[nodiscard]] static Result<TemporaryFolder> create();
  TemporaryFolder(TemporaryFolder&& other) noexcept;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit TemporaryFolder(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;  ///< empty once moved from
};

/// Where data and shaders are: ../share/meridian of the executable when that is an install tree, else the source tree
/// this was built from. Errors: neither is there.
struct DataFolders {
  std::filesystem::path data;
  std::filesystem::path shaders;
};
[[nodiscard]] Result<DataFolders> findDataFolders(const std::filesystem::path& executable);

/// $XDG_CACHE_HOME/meridian, else ~/.cache/meridian, created; nothing where neither can be written.
[[nodiscard]] std::optional<std::filesystem::path> findCacheFolder();

/// All of this process. The cache falls back to `temporary`, with a warning; prepared data of one that can only be read
/// are seen there. `assets` stands for ${ASSETS} and is made absolute. Errors as for findDataFolders.
[[nodiscard]] Result<Paths> findPaths(const std::filesystem::path& temporary);

}  // namespace meridian::app
