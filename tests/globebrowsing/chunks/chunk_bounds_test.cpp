#include "globebrowsing/chunks/chunk_bounds.h"

#include <cmath>
#include <limits>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "globebrowsing/chunks/culling.h"
#include "globebrowsing/geodesy/ray.h"
#include "globebrowsing/tiling/geodetic_tiling.h"
#include "test_views.h"

namespace meridian::globebrowsing {
namespace {

const glm::dvec3 bodies[] = {{6378137.0, 6378137.0, 6356752.314245},
                             {13000.0, 11400.0, 9100.0},
                             {286300.0, 278600.0, 223200.0},
                             {1161e3, 852e3, 513e3},
                             {900e3, 900e3, 1100e3}};
/// Far flatter and longer than any that is known.
const glm::dvec3 extremeBodies[] = {{1e6, 1e6, 1e5}, {1e6, 1e6, 1e4}, {1e6, 1e4, 1e4},
                                    {1e4, 1e4, 1e6}, {1e6, 3e5, 5e4}, {2e4, 1e6, 1e6}};

TileIndex randomTile(std::mt19937& random, int deepest) {
  const int level = static_cast<int>(random() % static_cast<unsigned>(deepest + 1));
  TileIndex index;
  index.root = static_cast<std::uint8_t>(random() % 2);
  index.level = static_cast<std::uint8_t>(level);
  index.y = static_cast<std::uint32_t>(random() % (1U << level));
  index.x = static_cast<std::uint32_t>(random() % GeodeticTiling::columns(level, index.y));
  return index;
}

glm::dvec3 randomPoint(std::mt19937& random, const Tiling& tiling, const TileIndex& index, const HeightRange& heights) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  GeodeticPosition place = tiling.geodetic(index, {unit(random), unit(random)});
  const double part = random() % 3 == 0 ? (random() % 2 == 0 ? 0.0 : 1.0) : unit(random);
  place.height = heights.minimum + part * (heights.maximum - heights.minimum);
  return tiling.ellipsoid().cartesian(place);
}

HeightRange randomRange(std::mt19937& random, double leastRadius) {
  std::uniform_real_distribution<double> unit(-0.05 * leastRadius, 0.05 * leastRadius);
  const double a = unit(random);
  const double b = random() % 4 == 0 ? a : unit(random);
  return {std::min(a, b), std::max(a, b)};
}

/// The same places, not told to be rows and columns: exercises the measured margin.
class OpaqueTiling final : public Tiling {
 public:
  explicit OpaqueTiling(const Ellipsoid& ellipsoid) : Tiling(ellipsoid), inner_(ellipsoid) {}
  [[nodiscard]] int rootCount() const override { return inner_.rootCount(); }
  [[nodiscard]] Children children(const TileIndex& index) const override { return inner_.children(index); }
  [[nodiscard]] std::optional<TileIndex> parent(const TileIndex& index) const override { return inner_.parent(index); }
  [[nodiscard]] UnitSquareTransform inParent(const TileIndex& index) const override { return inner_.inParent(index); }
  [[nodiscard]] std::optional<Neighbour> neighbour(const TileIndex& index, Edge edge) const override {
    return inner_.neighbour(index, edge);
  }
  [[nodiscard]] GeodeticPosition geodetic(const TileIndex& index, const glm::dvec2& uv) const override {
    return inner_.geodetic(index, uv);
  }
  [[nodiscard]] TilePlace locate(double latitude, double longitude, int level) const override {
    return inner_.locate(latitude, longitude, level);
  }

 private:
  GeodeticTiling inner_;
};

void expectContained(const Tiling& tiling, std::mt19937& random) {
  const double least = tiling.ellipsoid().minimumRadius();
  const TileIndex index = randomTile(random, 20);
  const HeightRange heights = randomRange(random, least);
  const ChunkBounds bounds = chunkBounds(tiling, index, heights);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 point = randomPoint(random, tiling, index, heights);
    ASSERT_EQ(bounds.box.distance(point), 0.0) << toString(index);
    const glm::dvec3 scaled = point / tiling.ellipsoid().radii();
    ASSERT_LE(glm::length(scaled), bounds.cap.greatestRadius);
    const double angle =
        std::atan2(glm::length(glm::cross(scaled, bounds.cap.direction)), glm::dot(scaled, bounds.cap.direction));
    ASSERT_LE(angle, bounds.cap.angle) << toString(index);
  }
}

TEST(ChunkBoundsTest, HoldEveryPointOfTheTile) {
  std::mt19937 random(1);
  for (const glm::dvec3& radii : bodies) {
    const GeodeticTiling tiling(*Ellipsoid::fromRadii(radii));
    const OpaqueTiling opaque(tiling.ellipsoid());
    for (int i = 0; i < 1500; ++i) {
      expectContained(tiling, random);
      if (i % 5 == 0) {
        expectContained(opaque, random);
      }
    }
  }
}

TEST(ChunkBoundsTest, HoldEveryPointOfFlattenedBodies) {
  std::mt19937 random(11);
  for (const glm::dvec3& radii : extremeBodies) {
    const GeodeticTiling tiling(*Ellipsoid::fromRadii(radii));
    for (int i = 0; i < 1500; ++i) {
      expectContained(tiling, random);
    }
  }
}

/// A box much larger than its tile is near from everywhere, and makes the tile split for nothing.
TEST(ChunkBoundsTest, AreNotMuchLargerThanTheTileOnFlattenedBodies) {
  std::mt19937 random(12);
  for (const glm::dvec3& radii : extremeBodies) {
    const GeodeticTiling tiling(*Ellipsoid::fromRadii(radii));
    int wide = 0;
    int tiles = 0;
    for (int i = 0; i < 4000; ++i) {
      const TileIndex index = randomTile(random, 14);
      if (index.level < 7) {
        continue;
      }
      const ChunkBounds bounds = chunkBounds(tiling, index, {0.0, 0.0});
      ++tiles;
      wide += bounds.box.half.x > 1.5 * bounds.edgeLength ? 1 : 0;
      ASSERT_LT(bounds.box.half.x, 3.0 * tiling.ellipsoid().maximumRadius()) << toString(index);
    }
    EXPECT_LT(wide, tiles / 10) << radii.x << ' ' << radii.y << ' ' << radii.z;
  }
}

TEST(ChunkBoundsTest, AreTight) {
  const GeodeticTiling tiling(testEarth());
  std::mt19937 random(2);
  for (int i = 0; i < 500; ++i) {
    TileIndex index = randomTile(random, 18);
    if (index.level < 4) {
      continue;
    }
    const ChunkBounds bounds = chunkBounds(tiling, index, {0.0, 0.0});
    double width = 0.0;
    for (const Edge edge : allEdges) {
      const bool row = edge == Edge::North || edge == Edge::South;
      const double fixed = edge == Edge::East || edge == Edge::South ? 1.0 : 0.0;
      width =
          std::max(width, glm::length(tiling.position(index, row ? glm::dvec2(1.0, fixed) : glm::dvec2(fixed, 1.0)) -
                                      tiling.position(index, row ? glm::dvec2(0.0, fixed) : glm::dvec2(fixed, 0.0))));
    }
    const double longest = 2.0 * std::max(bounds.box.half.x, bounds.box.half.y);
    EXPECT_LT(longest, 1.15 * width + 1e-6) << toString(index);
    // The thickness is what the Earth bends over the tile, and not much more.
    // Beside a pole it bends sideways too, and the margin is the same all round.
    const bool polar = std::abs(tiling.geodetic(index, {0.5, 0.5}).latitude) > 1.3;
    EXPECT_LT(2.0 * bounds.box.half.z, 0.4 * width * width / 6378137.0 + (polar ? 0.005 * width : 1e-6))
        << toString(index);
    EXPECT_NEAR(bounds.edgeLength / width, 1.0, 0.05);
  }
}

TEST(ChunkBoundsTest, PutRangesInOrder) {
  const GeodeticTiling tiling(testEarth());
  const TileIndex index{0, 5, 3, 9};
  const ChunkBounds expected = chunkBounds(tiling, index, {-100.0, 200.0});
  EXPECT_EQ(chunkBounds(tiling, index, {200.0, -100.0}).box.half, expected.box.half);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(chunkBounds(tiling, index, {nan, nan}).box.half, chunkBounds(tiling, index, {0.0, 0.0}).box.half);
}

TEST(OrientedBoxTest, DistanceIsToTheNearestPoint) {
  OrientedBox box;
  box.centre = {10.0, 0.0, 0.0};
  box.half = {1.0, 2.0, 3.0};
  EXPECT_EQ(box.distance({10.5, 1.0, -2.0}), 0.0);
  EXPECT_DOUBLE_EQ(box.distance({14.0, 0.0, 0.0}), 3.0);
  EXPECT_DOUBLE_EQ(box.distance({14.0, 6.0, 0.0}), 5.0);
}

TEST(FrustumTest, NeverCullsWhatShows) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const GeodeticTiling tiling(testEarth());
  int shown = 0;
  int culled = 0;
  for (int i = 0; i < 4000; ++i) {
    const double altitude = std::pow(10.0, 3.5 * unit(random) + 4.0);
    const GeodeticPosition place{1.5 * unit(random), 3.1 * unit(random), altitude};
    const SelectionView view = viewAbove(tiling.ellipsoid(), place, 3.0 * unit(random), 1.5 * std::abs(unit(random)));
    const int level = static_cast<int>(random() % 18);
    const double spread = std::min(1.5, 2.0 * altitude / 6.4e6);
    const TileIndex index =
        tiling.locate(place.latitude + spread * unit(random), place.longitude + spread * unit(random), level).index;
    const HeightRange heights{-100.0, 3000.0};
    const bool touches = Frustum(view.clipFromModel).touches(chunkBounds(tiling, index, heights).box);
    culled += touches ? 0 : 1;
    for (int j = 0; j < 30; ++j) {
      if (shows(view, randomPoint(random, tiling, index, heights))) {
        ++shown;
        ASSERT_TRUE(touches) << toString(index);
      }
    }
  }
  EXPECT_GT(shown, 1000);
  EXPECT_GT(culled, 500);
}

TEST(FrustumTest, HoldsEverythingWithoutPlanes) {
  OrientedBox box;
  box.half = glm::dvec3(1.0);
  EXPECT_TRUE(Frustum(glm::dmat4(0.0)).touches(box));
  EXPECT_TRUE(Frustum().touches(box));
}

TEST(FrustumTest, TouchesABoxAroundTheCamera) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 position = 7e6 * glm::normalize(glm::dvec3(unit(random), unit(random), unit(random)));
    const SelectionView view = testView(position, {unit(random), unit(random), unit(random)});
    OrientedBox box;
    box.half = glm::dvec3(100.0);
    box.centre = position + 99.0 * glm::dvec3(unit(random), unit(random), unit(random));
    EXPECT_TRUE(Frustum(view.clipFromModel).touches(box));
  }
}

/// Whether the ellipsoid scaled by `scale` leaves the segment from camera to point free.
bool sees(const glm::dvec3& camera, const glm::dvec3& point, const glm::dvec3& occluder) {
  const std::optional<double> hit = nearestHit(camera, point - camera, occluder);
  return !hit || *hit >= 1.0 - 1e-9;
}

TEST(HorizonTest, NeverHidesAPointThatIsSeen) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const glm::dvec3& radii : bodies) {
    const GeodeticTiling tiling(*Ellipsoid::fromRadii(radii));
    const double least = tiling.ellipsoid().minimumRadius();
    int seen = 0;
    int hiddenTiles = 0;
    for (int i = 0; i < 3000; ++i) {
      const double lowest = -0.05 * least * std::abs(unit(random));
      HeightRange heights = randomRange(random, least);
      heights.minimum = std::max(heights.minimum, lowest);
      heights.maximum = std::max(heights.maximum, heights.minimum);
      // Cameras from just above the occluder, below the reference ellipsoid too, to far away.
      const double height = lowest + least * std::pow(10.0, 3.0 * unit(random) - 2.0);
      const glm::dvec3 camera = tiling.ellipsoid().cartesian({1.57 * unit(random), 3.14 * unit(random), height});
      const Horizon horizon(radii, lowest, camera);
      const double scale = Horizon::occluderScale(radii, lowest);
      const TileIndex index = randomTile(random, 10);
      const bool hidden = horizon.hides(Horizon::capOf(chunkBounds(tiling, index, heights).cap, scale));
      hiddenTiles += hidden ? 1 : 0;
      for (int j = 0; j < 20; ++j) {
        if (sees(camera, randomPoint(random, tiling, index, heights), radii * scale)) {
          ++seen;
          ASSERT_FALSE(hidden) << toString(index) << " of " << radii.x;
        }
      }
    }
    EXPECT_GT(seen, 5000);
    EXPECT_GT(hiddenTiles, 500);
  }
}

TEST(HorizonTest, HidesMostOfWhatIsHidden) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const GeodeticTiling tiling(testEarth());
  int behind = 0;
  int hidden = 0;
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 camera = tiling.ellipsoid().cartesian({1.57 * unit(random), 3.14 * unit(random), 1e6});
    TileIndex index = randomTile(random, 6);
    if (index.level < 5) {
      continue;
    }
    bool visible = false;
    for (int j = 0; j < 40; ++j) {
      visible = visible ||
                sees(camera, randomPoint(random, tiling, index, {0.0, 0.0}), tiling.ellipsoid().radii() * (1.0 - 1e-9));
    }
    if (!visible) {
      ++behind;
      hidden += Horizon(tiling.ellipsoid().radii(), 0.0, camera)
                        .hides(Horizon::capOf(chunkBounds(tiling, index, {0.0, 0.0}).cap, 1.0))
                    ? 1
                    : 0;
    }
  }
  EXPECT_GT(behind, 200);
  EXPECT_GT(hidden, behind * 9 / 10);
}

TEST(HorizonTest, HidesNothingFromInsideTheOccluder) {
  const GeodeticTiling tiling(testEarth());
  const glm::dvec3 radii = tiling.ellipsoid().radii();
  const HorizonCap cap = Horizon::capOf(chunkBounds(tiling, {0, 6, 3, 20}, {0.0, 0.0}).cap, 1.0);
  EXPECT_TRUE(Horizon(radii, 0.0, {1e7, 0.0, 0.0}).hides(cap) || Horizon(radii, 0.0, {-1e7, 0.0, 0.0}).hides(cap) ||
              Horizon(radii, 0.0, {0.0, 1e7, 0.0}).hides(cap));
  EXPECT_FALSE(Horizon(radii, 0.0, {6e6, 0.0, 0.0}).hides(cap));
  EXPECT_FALSE(Horizon(radii, 0.0, {0.0, 0.0, 0.0}).hides(cap));
  EXPECT_FALSE(Horizon(radii, -7e6, {1e7, 0.0, 0.0}).hides(cap)) << "no occluder is left";
}

}  // namespace
}  // namespace meridian::globebrowsing
