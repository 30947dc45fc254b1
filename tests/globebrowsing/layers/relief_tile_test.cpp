#include "globebrowsing/layers/relief_tile.h"

#include <cmath>
#include <functional>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "globebrowsing/tiling/geodetic_tiling.h"

namespace meridian::globebrowsing {
namespace {

constexpr int size = ReliefTile::size;
constexpr double degree = 0.017453292519943295;

const GeodeticTiling& earth() {
  static const GeodeticTiling tiling(*Ellipsoid::fromRadii({6378137.0, 6378137.0, 6356752.314245}));
  return tiling;
}

ReliefTile tileOf(const TileIndex& index, const std::function<double(const GeodeticPosition&)>& height) {
  std::vector<float> heights;
  for (int row = 0; row < reliefLayout.size(); ++row) {
    for (int column = 0; column < reliefLayout.size(); ++column) {
      heights.push_back(static_cast<float>(height(earth().geodetic(index, reliefLayout.uv(column, row)))));
    }
  }
  return ReliefTile(earth(), index, heights);
}

glm::dvec2 normalAt(const ReliefTile& tile, int column, int row) {
  const ReliefTile::Normal normal =
      tile.normals()[static_cast<std::size_t>(row) * size + static_cast<std::size_t>(column)];
  return glm::dvec2(normal[0], normal[1]) / 32767.0;
}

/// East and north component of the normal of h(latitude, longitude), by the ellipsoid's radii of curvature.
glm::dvec2 expectedNormal(const GeodeticPosition& place, double perLatitude, double perLongitude) {
  constexpr double a = 6378137.0;
  constexpr double e2 = 1.0 - 6356752.314245 * 6356752.314245 / (a * a);
  const double w = 1.0 - e2 * std::sin(place.latitude) * std::sin(place.latitude);
  const double meridian = a * (1.0 - e2) / (w * std::sqrt(w));
  const double parallel = a / std::sqrt(w) * std::cos(place.latitude);
  const glm::dvec2 gradient(perLongitude / parallel, perLatitude / meridian);
  return -gradient / std::sqrt(1.0 + glm::dot(gradient, gradient));
}

TEST(ReliefTile, NormalsAreInMetresOnTheEllipsoid) {
  const auto height = [](const GeodeticPosition& place) {
    return 2000.0 * std::sin(300.0 * place.latitude) * std::cos(200.0 * place.longitude);
  };
  for (const double latitude : {0.3, 47.0, -72.0, 85.0}) {
    const TileIndex index = earth().locate(latitude * degree, 0.2, 9).index;
    const ReliefTile tile = tileOf(index, height);
    for (int row = 0; row < size; row += 37) {
      for (int column = 0; column < size; column += 41) {
        const GeodeticPosition place = earth().geodetic(index, colourLayout.uv(column, row));
        const double a = 300.0 * place.latitude;
        const double b = 200.0 * place.longitude;
        const glm::dvec2 expected = expectedNormal(place, 2000.0 * 300.0 * std::cos(a) * std::cos(b),
                                                   -2000.0 * 200.0 * std::sin(a) * std::sin(b));
        // Differences over two samples instead of derivatives, heights in float, 15 bits.
        EXPECT_LT(glm::distance(normalAt(tile, column, row), expected), 3e-4)
            << latitude << ' ' << column << ' ' << row;
      }
    }
  }
}

TEST(ReliefTile, NeighboursAgreeAlsoAcrossTheAntimeridian) {
  const auto height = [](const GeodeticPosition& place) {
    return 3000.0 * std::sin(50.0 * place.longitude) * std::cos(60.0 * place.latitude);
  };
  for (const TileIndex index : {earth().locate(0.4, 0.4, 6).index, earth().locate(-0.9, 3.14, 6).index}) {
    const ReliefTile own = tileOf(index, height);
    const ReliefTile east = tileOf(earth().neighbour(index, Edge::East)->index, height);
    const TileIndex southern = earth().neighbour(index, Edge::South)->index;
    ASSERT_EQ(southern.level, index.level);
    const ReliefTile south = tileOf(southern, height);
    for (int i = 0; i < size; i += 3) {
      for (int j = 0; j < 2 * colourLayout.border; ++j) {
        EXPECT_LT(glm::distance(normalAt(own, colourLayout.interior + j, i), normalAt(east, j, i)), 1e-4);
        EXPECT_LT(glm::distance(normalAt(own, i, colourLayout.interior + j), normalAt(south, i, j)), 1e-4);
      }
    }
  }
}

TEST(ReliefTile, APlaneOverAPoleIsOnePlane) {
  // Rising to the east of the prime meridian, seen from the pole: one gradient, whatever the longitude.
  const auto height = [](const GeodeticPosition& place) {
    return 0.2 * 6378137.0 * std::cos(place.latitude) * std::sin(place.longitude);
  };
  const TileIndex index = earth().locate(90.0 * degree, 0.3, 9).index;
  const ReliefTile tile = tileOf(index, height);
  const double expected = 0.2 / std::sqrt(1.04);
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < size; column += 11) {
      const GeodeticPosition place = earth().geodetic(index, colourLayout.uv(column, row));
      // Beyond the pole the frame goes on: east and north are still as they were on this side.
      const bool isBeyond = row < colourLayout.border;
      const double turned = isBeyond ? place.longitude + 3.141592653589793 : place.longitude;
      const glm::dvec2 down = -expected * glm::dvec2(std::cos(turned), -std::sin(turned));
      EXPECT_LT(glm::distance(normalAt(tile, column, row), down), 0.01) << column << ' ' << row;
    }
  }
}

TEST(ReliefTile, FlatIsFlat) {
  const ReliefTile tile = tileOf(TileIndex{1, 0, 0, 0}, [](const GeodeticPosition&) { return 1234.5; });
  for (const ReliefTile::Normal& normal : tile.normals()) {
    ASSERT_EQ(normal, (ReliefTile::Normal{0, 0}));
  }
  EXPECT_EQ(tile.heights().front(), 1234.5F);
  EXPECT_EQ(tile.heights().size(), static_cast<std::size_t>(size) * size);
}

}  // namespace
}  // namespace meridian::globebrowsing
