#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "host/api/error.h"
#include "host/api/renderable.h"
#include "host/app/application.h"
#include "host/assets/profile.h"

namespace meridian::app {

/// What `--validate` finds out.
struct AssetCheck {
  /// A node's renderable, if it has anything to count.
  struct Part {
    std::string node;
    Renderable::Contents contents;
  };
  std::vector<std::filesystem::path> loaded;
  std::vector<Error> unavailable;  ///< of assets whose data were not synchronised
  std::size_t good = 0;            ///< loaded or not available
  std::size_t failed = 0;
  std::vector<Part> parts;

  /// Logs each asset, each globe and each of its layers, with why it is not usable.
  void report() const;
  /// "assets N ok M failed; globes G; layers L usable U"
  [[nodiscard]] std::string line() const;
};

/// Loads all assets in files, in profiles and below folders, together; one that fails so is tried alone, in a scene of
/// its own. Every error goes to the log. A file or folder that is not
/// there, and a profile that has errors, count as one that failed.
[[nodiscard]] AssetCheck checkAssets(Application& application, const std::vector<std::string>& filesAndFolders);

/// What was loaded to be shown.
struct LoadedAssets {
  struct LoadedProfile {
    std::string file;
    assets::Profile profile;
  };
  std::size_t loaded = 0;
  std::size_t failed = 0;
  std::vector<LoadedProfile> profiles;  ///< yet to be started: startProfile
};

/// Loads these root assets, and those of profiles; every error goes to the log, and the rest is loaded.
[[nodiscard]] LoadedAssets loadAssets(Application& application, const std::vector<std::string>& files);

}  // namespace meridian::app
