#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "../streaming/streamer_fixture.h"
#include "globebrowsing/gpu/composite_owners.h"
#include "globebrowsing/layers/layer_manager.h"
#include "globebrowsing/tiling/geodetic_tiling.h"
#include "host/api/statistics.h"

namespace meridian::globebrowsing {

/// What goes on before anything is composed: layers with data, steps in time, raw tiles. No OpenGL.
class CompositesTest : public testing::Test {
 protected:
  using Fields = std::map<std::string, Value, std::less<>>;

  void SetUp() override {
    folder_ =
        std::filesystem::path(MERIDIAN_TEST_FOLDER) / testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Layer& add(Fields fields, const std::string& group = "ColorLayers") {
    fields.insert({"Enabled", true});
    const auto added = layers_.addLayer(group, {Table{{}, std::move(fields)}, "test", "Layer", folder_.string()});
    EXPECT_TRUE(added) << (added ? "" : added.error().message());
    return **added;
  }
  /// A grey picture of the whole globe, twice as wide as high.
  std::string picture(const std::string& name, int height) const {
    std::ofstream file(folder_ / name, std::ios::binary);
    file << "P5\n" << 2 * height << ' ' << height << "\n255\n";
    file << std::string(std::size_t{2} * static_cast<std::size_t>(height) * static_cast<std::size_t>(height), 'g');
    return name;
  }
  /// A layer with a picture for each of the first days of 2004, of these heights.
  Layer& addDaily(const std::vector<int>& heights, Fields more = {}) {
    for (std::size_t i = 0; i < heights.size(); ++i) {
      static_cast<void>(picture("d2004-01-0" + std::to_string(i + 1) + ".pgm", heights[i]));
    }
    more.insert({{"Identifier", "Daily"},
                 {"Type", "TemporalTileProvider"},
                 {"Mode", "Folder"},
                 {"Folder", Table{{}, {{"Folder", "."}, {"Format", "d%Y-%m-%d"}}}}});
    return add(std::move(more));
  }
  static Time at(double days) { return *Time::fromUtc("2004-01-01") + days * secondsADay; }

  [[nodiscard]] CompositeGenerations& base() { return generations_[static_cast<std::size_t>(CompositeKind::Base)]; }
  /// A frame in which all data that were asked for have come.
  void frame(double days = 0.0) {
    for (int n = 0; n < 3; ++n) {
      layers_.update(at(days));
      workers_.drain();
    }
    layers_.update(at(days));
    for (const CompositeKind kind : allCompositeKinds) {
      generations_[static_cast<std::size_t>(kind)].update(kind, layers_, reliefStream_);
    }
    base().follow(mixes_, mayBegin_);
  }
  /// The day, from 0, that a generation shows its first layer at (its first step has no begin); -1 for none.
  static double dayOf(const CompositeGenerations::Generation& generation) {
    return generation.steps.empty() || generation.steps.front() == nullptr
               ? -1.0
               : std::round((generation.steps.front()->when().instant - at(0.0)) / secondsADay);
  }

  static constexpr double secondsADay = 86400.0;
  std::filesystem::path folder_;
  std::shared_ptr<const Tiling> tiling_ =
      std::make_shared<GeodeticTiling>(*Ellipsoid::fromRadii({6378137.0, 6378137.0, 6356752.314245}));
  Statistics statistics_;
  WorkerPool workers_{1};
  TileStreamer streamer_{workers_, statistics_, takingAll};
  LayerManager layers_{{&workers_, &streamer_}};
  CompositeOwners::Generations generations_;
  std::uint32_t reliefStream_ = 1;
  bool mixes_ = false;
  CompositeGenerations::Leave mayBegin_;
};

}  // namespace meridian::globebrowsing
