#include "globebrowsing/tiling/geodetic_tiling.h"

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

constexpr double pi = std::numbers::pi;

const Ellipsoid& earth() {
  static const Ellipsoid ellipsoid = *Ellipsoid::fromRadii({6378137.0, 6378137.0, 6356752.314245});
  return ellipsoid;
}

const GeodeticTiling& tiling() {
  static const GeodeticTiling geodetic(earth());
  return geodetic;
}

TileIndex tile(int root, int level, std::uint32_t x, std::uint32_t y) {
  return {static_cast<std::uint8_t>(root), static_cast<std::uint8_t>(level), x, y};
}

/// Every tile of levels 0..7, then random deep ones, many of them by the poles and the antimeridian.
const std::vector<TileIndex>& tiles() {
  static const std::vector<TileIndex> all = [] {
    std::vector<TileIndex> list;
    for (int level = 0; level <= 7; ++level) {
      for (std::uint32_t row = 0; row < 1U << level; ++row) {
        for (std::uint32_t column = 0; column < GeodeticTiling::columns(level, row); ++column) {
          list.push_back(tile(0, level, column, row));
          list.push_back(tile(1, level, column, row));
        }
      }
    }
    std::mt19937 random(11);
    const auto draw = [&random] { return static_cast<std::uint32_t>(random()); };
    for (int level = 8; level <= maximumLevel; ++level) {
      const std::uint32_t rows = 1U << level;
      for (int i = 0; i < 200; ++i) {
        std::uint32_t row = draw() % rows;
        if (i % 4 == 1) {
          row = draw() % 40 % rows;
        } else if (i % 4 == 2) {
          row = rows - 1 - draw() % 40 % rows;
        } else if (i % 4 == 3) {
          row = std::min(rows - 1, rows >> (draw() % static_cast<unsigned>(level)));
        }
        const std::uint32_t columns = GeodeticTiling::columns(level, row);
        const std::uint32_t column = i % 5 == 0 ? 0 : (i % 5 == 1 ? columns - 1 : draw() % columns);
        list.push_back(tile(i % 2, level, column, row));
      }
    }
    return list;
  }();
  return all;
}

TEST(GeodeticTilingTest, RowsThinOutTowardsThePoles) {
  struct Row {
    int level;
    std::uint32_t row;
    std::uint32_t columns;
  };
  // By hand from the rule: a tile splits in latitude only when cos(latitude of its edge nearer the equator) * its
  // longitude width is below half its latitude height. At level 3 that is 67.5 degrees: 0.383 * 22.5 < 11.25.
  const Row rows[] = {{0, 0, 1}, {1, 0, 2}, {1, 1, 2},  {2, 0, 4},  {2, 1, 4},   {3, 0, 8},  {3, 1, 8},
                      {3, 7, 8}, {4, 0, 8}, {4, 1, 8},  {4, 2, 16}, {4, 13, 16}, {4, 14, 8}, {4, 15, 8},
                      {5, 0, 8}, {5, 1, 8}, {5, 2, 16}, {5, 3, 16}, {5, 4, 32},  {5, 31, 8}};
  for (const Row& row : rows) {
    EXPECT_EQ(GeodeticTiling::columns(row.level, row.row), row.columns) << row.level << ' ' << row.row;
  }
}

TEST(GeodeticTilingTest, SplitsAsTheRuleSays) {
  for (const TileIndex& index : tiles()) {
    if (index.level == maximumLevel) {
      continue;
    }
    const GeodeticPosition first = tiling().geodetic(index, {0.0, 0.0});
    const GeodeticPosition last = tiling().geodetic(index, {1.0, 1.0});
    const bool overEquator = first.latitude > 0.0 && last.latitude < 0.0;
    const double nearer = overEquator ? 0.0 : std::min(std::abs(first.latitude), std::abs(last.latitude));
    const double width = pi / GeodeticTiling::columns(index.level, index.y);
    const double height = std::ldexp(pi, -index.level);
    const bool latitudeOnly = std::cos(nearer) * width < 0.5 * height;
    ASSERT_EQ(tiling().children(index).count, latitudeOnly ? 2 : 4) << toString(index);
  }
}

TEST(GeodeticTilingTest, TilesNeitherPinchNorStretch) {
  for (const TileIndex& index : tiles()) {
    const GeodeticPosition first = tiling().geodetic(index, {0.0, 0.0});
    const GeodeticPosition last = tiling().geodetic(index, {1.0, 1.0});
    const bool overEquator = first.latitude > 0.0 && last.latitude < 0.0;
    const double nearer = overEquator ? 0.0 : std::min(std::abs(first.latitude), std::abs(last.latitude));
    const double width = std::cos(nearer) * pi / GeodeticTiling::columns(index.level, index.y);
    const double ratio = width / std::ldexp(pi, -index.level);
    ASSERT_LE(ratio, 4.0) << toString(index);
    ASSERT_GE(ratio, 0.2) << toString(index);
  }
}

TEST(GeodeticTilingTest, ChildrenCoverTheirParentAndKnowIt) {
  for (const TileIndex& index : tiles()) {
    if (index.level == maximumLevel) {
      continue;
    }
    double area = 0.0;
    for (const TileIndex& child : tiling().children(index)) {
      ASSERT_EQ(child.level, index.level + 1);
      ASSERT_LT(child.x, GeodeticTiling::columns(child.level, child.y));
      ASSERT_EQ(tiling().parent(child), index) << toString(child);
      const UnitSquareTransform within = tiling().inParent(child);
      area += within.scale.x * within.scale.y;
      for (const glm::dvec2 uv : {glm::dvec2(0.0, 0.0), glm::dvec2(1.0, 1.0), glm::dvec2(0.25, 0.75)}) {
        ASSERT_EQ(tiling().position(child, uv), tiling().position(index, within.apply(uv))) << toString(child);
      }
    }
    ASSERT_EQ(area, 1.0);
  }
  EXPECT_FALSE(tiling().parent(tile(0, 0, 0, 0)).has_value());
}

TEST(GeodeticTilingTest, AncestorsComposeTheTransforms) {
  for (const TileIndex& index : tiles()) {
    for (int level = 0; level <= index.level; level += 3) {
      const AncestorPlace place = ancestorAt(tiling(), index, level);
      ASSERT_EQ(place.index.level, level);
      ASSERT_EQ(tiling().position(index, {0.5, 0.25}),
                tiling().position(place.index, place.transform.apply({0.5, 0.25})))
          << toString(index) << ' ' << level;
    }
  }
}

/// The point along an edge, 0..1 from its west or north end.
glm::dvec2 onEdge(Edge edge, double along) {
  switch (edge) {
    case Edge::West:
      return {0.0, along};
    case Edge::East:
      return {1.0, along};
    case Edge::North:
      return {along, 0.0};
    case Edge::South:
      break;
  }
  return {along, 1.0};
}

TEST(GeodeticTilingTest, NeighboursShareTheirEdgesToTheBit) {
  for (const TileIndex& index : tiles()) {
    for (const Edge edge : allEdges) {
      const std::optional<Neighbour> neighbour = tiling().neighbour(index, edge);
      const bool atPole =
          (edge == Edge::North && index.y == 0) || (edge == Edge::South && index.y == (1U << index.level) - 1);
      ASSERT_EQ(neighbour.has_value(), !atPole) << toString(index);
      if (!neighbour) {
        continue;
      }
      ASSERT_LE(neighbour->index.level, index.level);
      ASSERT_LT(neighbour->index.x, GeodeticTiling::columns(neighbour->index.level, neighbour->index.y));
      ASSERT_GE(neighbour->offset, 0.0);
      ASSERT_LE(neighbour->offset + neighbour->scale, 1.0);
      ASSERT_FALSE(neighbour->isReversed());
      for (int node = 0; node <= 128; node += 16) {
        const double along = node / 128.0;
        const glm::dvec3 ours = tiling().position(index, onEdge(edge, along));
        const glm::dvec3 theirs =
            tiling().position(neighbour->index, onEdge(neighbour->edge, neighbour->offset + neighbour->scale * along));
        ASSERT_EQ(ours, theirs) << toString(index) << " and " << toString(neighbour->index) << " at " << along;
      }
    }
  }
}

TEST(GeodeticTilingTest, NeighbourOfTheNeighbourIsTheTileOrItsAncestor) {
  for (const TileIndex& index : tiles()) {
    for (const Edge edge : allEdges) {
      const std::optional<Neighbour> there = tiling().neighbour(index, edge);
      if (!there) {
        continue;
      }
      const std::optional<Neighbour> back = tiling().neighbour(there->index, there->edge);
      ASSERT_TRUE(back.has_value());
      if (there->scale == 1.0 && there->index.level == index.level) {
        ASSERT_EQ(back->index, index);
        ASSERT_EQ(back->edge, edge);
      }
      ASSERT_LE(back->index.level, index.level);
    }
  }
}

TEST(GeodeticTilingTest, NeighboursGoRoundTheGlobe) {
  for (const auto& [level, row] : {std::pair<int, std::uint32_t>{0, 0}, {3, 2}, {6, 0}, {6, 40}, {7, 127}}) {
    TileIndex index = tile(0, level, 0, row);
    std::set<TileIndex> seen;
    const std::uint32_t around = 2 * GeodeticTiling::columns(level, row);
    for (std::uint32_t i = 0; i < around; ++i) {
      ASSERT_TRUE(seen.insert(index).second);
      index = tiling().neighbour(index, Edge::East)->index;
    }
    EXPECT_EQ(index, tile(0, level, 0, row));
  }
}

TEST(GeodeticTilingTest, LocateFindsWhatGeodeticSays) {
  for (const TileIndex& index : tiles()) {
    for (const glm::dvec2 uv : {glm::dvec2(0.5, 0.5), glm::dvec2(0.3, 0.9), glm::dvec2(0.01, 0.02)}) {
      const GeodeticPosition place = tiling().geodetic(index, uv);
      const TilePlace found = tiling().locate(place.latitude, place.longitude, index.level);
      // Half a unit of pi's last digit, in tiles.
      const double tolerance = std::ldexp(1.0, index.level - 49);
      if (found.index == index) {
        ASSERT_NEAR(found.uv.x, uv.x, tolerance);
        ASSERT_NEAR(found.uv.y, uv.y, tolerance);
      } else {
        FAIL() << toString(index) << " was found as " << toString(found.index);
      }
    }
  }
}

TEST(GeodeticTilingTest, EveryPlaceHasATileAtEveryLevel) {
  const double latitudes[] = {-pi / 2.0, -1e-300, 0.0, 1e-9, 1.0, pi / 2.0, 7.0, -7.0, std::nan("")};
  const double longitudes[] = {-pi, -1e-300, -1e-17, 0.0, 1.0, pi, 3.0 * pi, -100.0, std::nan(""), 1e300};
  for (int level = 0; level <= maximumLevel; ++level) {
    for (const double latitude : latitudes) {
      for (const double longitude : longitudes) {
        const TilePlace place = tiling().locate(latitude, longitude, level);
        ASSERT_LT(place.index.root, 2);
        ASSERT_LT(place.index.y, 1U << level);
        ASSERT_LT(place.index.x, GeodeticTiling::columns(level, place.index.y));
        ASSERT_TRUE(place.uv.x >= 0.0 && place.uv.x <= 1.0);
        ASSERT_TRUE(place.uv.y >= 0.0 && place.uv.y <= 1.0);
      }
    }
  }
}

TEST(GeodeticTilingTest, BordersGoOnOverTheAntimeridianAndThePoles) {
  struct Case {
    const char* what;
    TileIndex index;
    glm::dvec2 uv;
    double latitudeDegrees;
    double longitudeDegrees;
  };
  const Case cases[] = {
      {"root 0's middle", tile(0, 0, 0, 0), {0.5, 0.5}, 0.0, -90.0},
      {"root 1's middle", tile(1, 0, 0, 0), {0.5, 0.5}, 0.0, 90.0},
      {"north-west corner", tile(0, 0, 0, 0), {0.0, 0.0}, 90.0, -180.0},
      {"south-east corner", tile(1, 0, 0, 0), {1.0, 1.0}, -90.0, 180.0},
      {"west of the antimeridian", tile(0, 0, 0, 0), {-0.125, 0.5}, 0.0, 157.5},
      {"east of the antimeridian", tile(1, 0, 0, 0), {1.125, 0.5}, 0.0, -157.5},
      {"over the north pole", tile(1, 0, 0, 0), {0.5, -0.125}, 67.5, -90.0},
      {"over the south pole", tile(0, 0, 0, 0), {0.5, 1.125}, -67.5, 90.0},
      {"over both", tile(1, 1, 1, 0), {1.5, -0.25}, 67.5, 45.0},
  };
  for (const Case& item : cases) {
    const GeodeticPosition place = tiling().geodetic(item.index, item.uv);
    EXPECT_NEAR(place.latitude * 180.0 / pi, item.latitudeDegrees, 1e-12) << item.what;
    EXPECT_NEAR(place.longitude * 180.0 / pi, item.longitudeDegrees, 1e-12) << item.what;
  }
}

TEST(GeodeticTilingTest, BordersMeetTheNeighboursInside) {
  for (const TileIndex& index : tiles()) {
    const std::optional<Neighbour> east = tiling().neighbour(index, Edge::East);
    ASSERT_EQ(tiling().position(index, {1.0625, 0.5}), tiling().position(east->index, {0.0625, 0.5}));
    const std::optional<Neighbour> west = tiling().neighbour(index, Edge::West);
    ASSERT_EQ(tiling().position(index, {-0.0625, 0.5}), tiling().position(west->index, {0.9375, 0.5}));
  }
}

TEST(TileIndexTest, HashesSpreadNeighbouringTiles) {
  std::set<std::size_t> hashes;
  std::set<TileIndex> different(tiles().begin(), tiles().end());
  for (const TileIndex& index : different) {
    hashes.insert(std::hash<TileIndex>()(index));
  }
  EXPECT_EQ(hashes.size(), different.size());
}

}  // namespace
}  // namespace meridian::globebrowsing
