#pragma once

#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include <unistd.h>

#include "globebrowsing/providers/provider_registry.h"
#include "globebrowsing/tiling/geodetic_tiling.h"

namespace meridian::globebrowsing {

using Fields = std::map<std::string, Value, std::less<>>;

inline ProviderRequest requestFor(Fields fields, std::string folder = "/data") {
  return {Table{{}, std::move(fields)}, "mars.asset:4", "Layers.ColorLayers[1]", std::move(folder)};
}

inline GeodeticTiling earthTiling() {
  return GeodeticTiling(*Ellipsoid::fromRadii({6378137.0, 6378137.0, 6356752.314245}));
}

/// A folder of this test's own, empty, gone with it.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() /
              ("meridian-" + name + "-" + std::to_string(getpid()) + "-" + std::to_string(std::rand()))) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace meridian::globebrowsing
