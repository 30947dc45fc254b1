#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "host/api/error.h"
#include "host/app/application.h"

namespace meridian::app {

/// What `--validate` ends with.
struct AssetCheck {
  std::size_t good = 0;
  std::size_t failed = 0;
  SceneCounts counts;

  /// "assets N ok M failed; globes G; layers L usable U"
  [[nodiscard]] std::string line() const;
};

/// Loads all assets in files and below folders; every error goes to the log. A file or folder that is not there counts
/// as one that failed.
[[nodiscard]] AssetCheck checkAssets(Application& application, const std::vector<std::string>& filesAndFolders);

/// Loads these root assets; every error goes to the log. How many of them failed.
[[nodiscard]] std::size_t loadAssets(Application& application, const std::vector<std::string>& files);

}  // namespace meridian::app
