#include "globebrowsing/surface/height_query.h"

#include <map>

#include "../module/globe_fixture.h"
#include "globebrowsing/surface/chunked_surface.h"
#include "globebrowsing/tiling/geodetic_tiling.h"

namespace meridian::globebrowsing {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// Metres, smooth, and below zero on half the globe; angles in degrees.
double relief(double longitude, double latitude) {
  return 6000.0 * std::sin(3.0 * longitude * degree) * std::cos(latitude * degree) + 20.0 * latitude;
}

class HeightQueryTest : public GlobeTest {
 protected:
  void SetUp() override {
    GlobeTest::SetUp();
    if (!graphics_) {
      return;
    }
    const std::string file = raster(
        "relief.tif", [](int, double longitude, double latitude) { return relief(longitude, latitude); }, 1,
        GDT_Float32, 2048);
    globe_ = &addGlobe({{"HeightLayers", listOf({fileLayer("H", file)})}});
    look(20.0 * degree, 30.0 * degree, 7.5e6);
    ASSERT_TRUE(settle());
  }
  RenderableGlobe* globe_ = nullptr;
};

TEST_F(HeightQueryTest, HeightAtFollowsTheRasterWhereTheCameraLooks) {
  for (double latitude = 10.0; latitude <= 30.0; latitude += 1.7) {
    for (double longitude = 20.0; longitude <= 40.0; longitude += 1.3) {
      // The tiles there have a node a third of a degree at most: relief bends by 6000 m (3 * 0.35 degree)^2 / 8.
      EXPECT_NEAR(globe_->heightAt(latitude * degree, longitude * degree), relief(longitude, latitude), 1.0)
          << latitude << ", " << longitude;
    }
  }
}

TEST_F(HeightQueryTest, HeightAtAnswersEverywhere) {
  for (const double latitude : {-90.0, -45.0, 0.0, 89.9, 90.0}) {
    for (const double longitude : {-180.0, -90.0, 0.0, 179.99, 180.0, 540.0}) {
      const double wrapped = std::remainder(longitude, 360.0);
      EXPECT_NEAR(globe_->heightAt(latitude * degree, longitude * degree), relief(wrapped, latitude), 200.0)
          << latitude << ", " << longitude;
    }
  }
}

TEST_F(HeightQueryTest, PickFindsTheSurfaceAlongTheRay) {
  for (double latitude = 12.0; latitude <= 28.0; latitude += 4.0) {
    for (double longitude = 22.0; longitude <= 38.0; longitude += 4.0) {
      const glm::dvec3 target = globe_->cartesian({latitude * degree, longitude * degree, relief(longitude, latitude)});
      for (const double direction : {1.0, 1e-3, 1e6}) {
        const auto hit = globe_->pick(view_.cameraPosition, direction * (target - view_.cameraPosition));
        ASSERT_TRUE(hit) << latitude << ", " << longitude;
        EXPECT_LT(glm::length(*hit - target), 3.0);
        const GeodeticPosition place = globe_->geodetic(*hit);
        EXPECT_NEAR(place.height, globe_->heightAt(place.latitude, place.longitude), 0.1);
      }
    }
  }
}

TEST_F(HeightQueryTest, PickMissesWhatIsBesideOrBehind) {
  const glm::dvec3 eye = view_.cameraPosition;
  EXPECT_FALSE(globe_->pick(eye, eye)) << "away from the globe";
  const glm::dvec3 aside = glm::cross(eye, glm::dvec3(0, 0, 1));
  EXPECT_FALSE(globe_->pick(eye, aside));
  EXPECT_TRUE(globe_->pick(eye, -eye));
  EXPECT_TRUE(globe_->pick(1e5 * eye, -eye)) << "from far away";
}

TEST_F(HeightQueryTest, PickFromBelowTheSurfaceIsWhereItStarts) {
  const glm::dvec3 inside = 0.9 * radius * glm::normalize(view_.cameraPosition);
  const auto hit = globe_->pick(inside, inside);
  ASSERT_TRUE(hit);
  EXPECT_LT(glm::length(*hit - inside), 1.0);
}

TEST_F(HeightQueryTest, SurfacesOfNeighboursAgreeOnTheirSharedNodes) {
  auto& surface = dynamic_cast<ChunkedSurface&>(*globe_->surface());
  const SurfaceStore& store = surface.tiles().surfaces();
  const GeodeticTiling tiling(*Ellipsoid::fromRadii(globe_->radii()));
  int compared = 0;
  for (const SelectedChunk& chunk : surface.selected()) {
    const auto neighbour = tiling.neighbour(chunk.index, Edge::East);
    const ChunkSurface* west = store.find(chunk.index);
    const ChunkSurface* east = neighbour ? store.find(neighbour->index) : nullptr;
    if (east == nullptr || neighbour->index.level != chunk.index.level) {
      continue;
    }
    for (int node = 0; node < ChunkSurface::nodes; ++node) {
      const double v = node / double{ChunkSurface::nodes - 1};
      ASSERT_EQ(west->heightAt({1.0, v}), east->heightAt({0.0, v})) << node;
      ++compared;
    }
  }
  EXPECT_GT(compared, 0);
}

// Else a tile that its own heights cull, but not those of an ancestor, is wanted again as soon as it is gone: in a full
// pool such tiles took turns, and the view was never complete.
TEST_F(HeightQueryTest, HeightsOfEvictedTilesStayKnown) {
  setModuleProperty("TexturePoolSize", 64);
  ASSERT_TRUE(settle());
  const auto& tiles = dynamic_cast<ChunkedSurface&>(*globe_->surface()).tiles();
  std::map<TileIndex, SurfaceStore::KnownRange> before;
  for (const SelectedChunk& chunk : dynamic_cast<ChunkedSurface&>(*globe_->surface()).selected()) {
    before[chunk.index] = tiles.surfaces().nearestRange(chunk.index);
  }
  for (double longitude = 60.0; longitude < 340.0; longitude += 20.0) {
    look(-50.0 * degree, longitude * degree, 6.9e6);
    ASSERT_TRUE(settle());
  }
  int evicted = 0;
  for (const auto& [index, known] : before) {
    const SurfaceStore::KnownRange now = tiles.surfaces().nearestRange(index);
    EXPECT_EQ(now.level, index.level);
    EXPECT_EQ(now.stamp, known.stamp);
    EXPECT_EQ(now.range.minimum, known.range.minimum);
    EXPECT_EQ(now.range.maximum, known.range.maximum);
    evicted += tiles.surfaces().find(index) == nullptr ? 1 : 0;
  }
  EXPECT_GT(evicted, 0);
}

TEST_F(HeightQueryTest, HeightsOfBeforeAreForgottenWhereNothingDrawsThem) {
  Layer& layer = *globe_->layers().group(LayerGroupId::HeightLayers).find("H");
  look(20.0 * degree, 30.0 * degree, 4e7);  // what was drawn near lies about, finer than what is drawn now
  ASSERT_TRUE(settle());
  layer.multiplier.put(0.5);
  ASSERT_TRUE(settle());
  for (double longitude = 20.0; longitude <= 40.0; longitude += 5.0) {
    const double expected = 0.5 * relief(longitude, 20.0);
    EXPECT_NEAR(globe_->heightAt(20.0 * degree, longitude * degree), expected, 100.0) << longitude;
    const glm::dvec3 down = -globe_->normal(20.0 * degree, longitude * degree);
    const auto hit = globe_->pick(globe_->cartesian({20.0 * degree, longitude * degree, 1e5}), down);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(globe_->geodetic(*hit).height, expected, 100.0) << longitude;
  }
}

TEST_F(HeightQueryTest, WhatIsDrawnIsStoodOnWhileHeightsChange) {
  Layer& layer = *globe_->layers().group(LayerGroupId::HeightLayers).find("H");
  const double before = globe_->heightAt(20.0 * degree, 30.0 * degree);
  layer.multiplier.put(0.5);
  ASSERT_TRUE(settle([&] {
    const double now = globe_->heightAt(20.0 * degree, 30.0 * degree);
    EXPECT_TRUE(std::abs(now - before) < 1e-3 || std::abs(now - 0.5 * before) < 1.0) << now;
  }));
  EXPECT_NEAR(globe_->heightAt(20.0 * degree, 30.0 * degree), 0.5 * before, 1.0);
}

/// A plain with a mountain beyond its horizon.
class HorizonTest : public GlobeTest {
 protected:
  static constexpr double mountain = 24.5;  ///< degrees of longitude, on the equator
  static double plainWithMountain(double longitude, double latitude) {
    // Smooth: what interpolates must not dig a moat, below which the horizon would lie further away.
    const double away = std::hypot(longitude - mountain, latitude);
    return 60000.0 * std::exp(-4.0 * away * away);
  }
  /// From a plane over the plain, towards the mountain.
  void lookAlong() {
    const double longitude = 17.5 * degree;  // its horizon is 1.4 degrees away
    const glm::dvec3 up(std::cos(longitude), std::sin(longitude), 0.0);
    const glm::dvec3 east(-std::sin(longitude), std::cos(longitude), 0.0);
    look(0.0, longitude, radius + 2000.0);
    view_.cameraFromModel = glm::lookAt(view_.cameraPosition, view_.cameraPosition + east, up);
  }
  static bool isSelected(RenderableGlobe& globe) {
    const GeodeticTiling tiling(*Ellipsoid::fromRadii(globe.radii()));
    for (const SelectedChunk& chunk : dynamic_cast<ChunkedSurface&>(*globe.surface()).selected()) {
      if (tiling.locate(0.0, mountain * degree, chunk.index.level).index == chunk.index) {
        return true;
      }
    }
    return false;
  }
};

TEST_F(HorizonTest, AMountainRisesThatWasFlatWhenItWasCulled) {
  const std::string file = raster(
      "mountain.tif", [](int, double longitude, double latitude) { return plainWithMountain(longitude, latitude); }, 1,
      GDT_Float32, 2048);
  RenderableGlobe& globe = addGlobe({{"HeightLayers", listOf({fileLayer("H", file)})}});
  Layer& layer = *globe.layers().group(LayerGroupId::HeightLayers).find("H");
  lookAlong();
  ASSERT_TRUE(settle());
  EXPECT_TRUE(isSelected(globe));
  layer.multiplier.put(0.0);
  ASSERT_TRUE(settle());
  EXPECT_FALSE(isSelected(globe));
  // So that tiles of all sizes that a selection may ask about are there, and flat.
  for (const double distance : {7e6, 6.7e6, 6.5e6, 6.45e6, 6.42e6}) {
    look(0.0, mountain * degree, distance);
    ASSERT_TRUE(settle());
  }
  lookAlong();
  ASSERT_TRUE(settle());
  EXPECT_FALSE(isSelected(globe));
  layer.multiplier.put(1.0);
  ASSERT_TRUE(settle());
  EXPECT_TRUE(isSelected(globe));
}

TEST_F(HeightQueryTest, SkirtsReachBelowEveryGapAndViewsSeeOnlyTheirChunks) {
  auto& surface = dynamic_cast<ChunkedSurface&>(*globe_->surface());
  ASSERT_FALSE(surface.selected().empty());
  for (const SelectedChunk& chunk : surface.selected()) {
    EXPECT_GE(chunk.skirt, 0.0);
    EXPECT_TRUE(std::isfinite(chunk.skirt));
    EXPECT_NE(surface.tiles().surfaces().find(chunk.index), nullptr) << "selected without a surface";
    EXPECT_EQ(chunk.views, 1U);
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
