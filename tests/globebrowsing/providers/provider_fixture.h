#pragma once

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include "globebrowsing/providers/provider_registry.h"
#include "globebrowsing/providers/tile_steps.h"
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

inline Value tableOf(Fields fields) {
  return Table{{}, std::move(fields)};
}
inline Value listOf(std::vector<Value> items) {
  return Table{std::move(items), {}};
}

using Colour = std::array<int, 4>;

/// An image of one colour, 64 x 32, binary PPM; without a georeference it covers the globe.
inline std::string writeImage(const std::string& path, const std::array<int, 3>& colour) {
  std::ofstream file(path, std::ios::binary);
  file << "P6\n64 32\n255\n";
  for (int i = 0; i < 64 * 32; ++i) {
    for (const int channel : colour) {
      file.put(static_cast<char>(channel));
    }
  }
  return path;
}

inline Colour pixelAt(const ColourPixels& pixels, int column, int row) {
  const std::uint8_t* p = &pixels.rgba[4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(pixels.size) +
                                            static_cast<std::size_t>(column))];
  return {p[0], p[1], p[2], p[3]};
}

/// Of the tile's middle; transparent where there is nothing.
inline Colour middleOf(const TileProvider& provider, const TileIndex& index) {
  const Result<ColourPixels> pixels = provider.colours(earthTiling(), index, {});
  EXPECT_TRUE(pixels) << pixels.error().message();
  return !pixels || pixels->rgba.empty() ? Colour{} : pixelAt(*pixels, pixels->size / 2 + 7, pixels->size / 2 + 7);
}

/// What an open provider with steps shows then.
inline Colour middleAt(const TileProvider& provider, const char* time, const TileIndex& index = {}) {
  const Result<std::shared_ptr<TileProvider>> step = provider.steps()->make(*Time::fromUtc(time));
  EXPECT_TRUE(step) << step.error().message();
  const Result<void> opened = (*step)->open();
  EXPECT_TRUE(opened) << opened.error().message();
  return middleOf(**step, index);
}

inline Time timeOf(const char* text) {
  return *Time::fromUtc(text);
}

}  // namespace meridian::globebrowsing
