#include "globebrowsing/layers/chunk_surface.h"

#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "globebrowsing/tiling/geodetic_tiling.h"

namespace meridian::globebrowsing {
namespace {

constexpr int side = ChunkSurface::heightSide;

const GeodeticTiling& earth() {
  static const GeodeticTiling tiling(*Ellipsoid::fromRadii({6378137.0, 6378137.0, 6356752.314245}));
  return tiling;
}

/// A height for every place of the globe, so that neighbouring tiles agree.
float relief(const GeodeticPosition& position) {
  return static_cast<float>(3000.0 * std::sin(40.0 * position.longitude) * std::cos(60.0 * position.latitude));
}

std::vector<float> heightsOf(const TileIndex& index, float (*height)(const GeodeticPosition&)) {
  std::vector<float> out;
  for (int row = -1; row < side - 1; ++row) {
    for (int column = -1; column < side - 1; ++column) {
      out.push_back(height(earth().geodetic(index, {column / 128.0, row / 128.0})));
    }
  }
  return out;
}

glm::dvec3 drawn(const ChunkSurface& surface, const SurfaceVertex& vertex) {
  const auto wide = [](const std::array<float, 3>& v) { return glm::dvec3(v[0], v[1], v[2]); };
  return bilinear(surface.corners(), {vertex.place[0] / 32.0, vertex.place[1] / 32.0}) + wide(vertex.offset) +
         wide(vertex.normal) * static_cast<double>(vertex.height);
}

TEST(ChunkSurface, VerticesLieOnTheDisplacedEllipsoid) {
  for (const TileIndex index : {TileIndex{0, 3, 2, 3}, TileIndex{1, 9, 100, 200}, TileIndex{1, 16, 9000, 20000}}) {
    const ChunkSurface surface(earth(), index, heightsOf(index, relief));
    const double edge = glm::distance(surface.corners()[0], surface.corners()[3]);
    for (const SurfaceVertex& vertex : surface.vertices()) {
      GeodeticPosition place = earth().geodetic(index, {vertex.place[0] / 32.0, vertex.place[1] / 32.0});
      place.height = relief(place);
      // Floats of the offset, which is at most a part of the edge, and of the height.
      EXPECT_LT(glm::distance(drawn(surface, vertex), earth().ellipsoid().cartesian(place)), edge * 1e-7 + 2e-3);
    }
  }
}

TEST(ChunkSurface, ErrorFallsWithDensityAndIsThatOfTheCoarseMesh) {
  const TileIndex index{1, 4, 3, 5};
  const ChunkSurface surface(earth(), index, heightsOf(index, relief));
  for (int step = 1; step < chunk_grid::steps; ++step) {
    EXPECT_LT(surface.error(step), surface.error(step - 1));
  }
  EXPECT_GT(surface.error(0), 100.0);
}

TEST(ChunkSurface, ErrorOfABareSphericalTileIsHalfItsSagitta) {
  const GeodeticTiling sphere(*Ellipsoid::fromRadii(glm::dvec3(1e6)));
  const TileIndex equator{1, 6, 20, 31};
  const ChunkSurface surface(sphere, equator, std::vector<float>(side * side, 0.0F));
  const double step = glm::radians(180.0 / 64.0) / 32.0;
  const double diagonal = step * std::sqrt(2.0);
  const double half = 0.5 * 1e6 * (1.0 - std::cos(diagonal / 2.0));
  EXPECT_NEAR(surface.error(4), half, 1e-3 * half);
  EXPECT_NEAR(surface.lift(4), half, 1e-3 * half);
}

TEST(ChunkSurface, EveryTileOfALevelIsLiftedAlike) {
  const std::vector<float> flat(side * side, 0.0F);
  const ChunkSurface equator(earth(), {0, 5, 3, 15}, flat);
  const ChunkSurface pole(earth(), {1, 5, 2, 0}, flat);
  for (int step = 0; step < chunk_grid::steps; ++step) {
    EXPECT_EQ(equator.lift(step), pole.lift(step));
    // Nowhere more than without being lifted: then a cell would err by its sagitta, to which a meridian contributes
    // half of the equator's.
    EXPECT_LE(pole.error(step), 1.02 * equator.lift(step));
  }
}

TEST(ChunkSurface, OnlyNarrowTilesAtAPoleHaveHalfTheColumns) {
  const std::vector<float> flat(side * side, 0.0F);
  const auto columns = [&](const TileIndex& index) { return ChunkSurface(earth(), index, flat).columns(); };
  EXPECT_EQ(columns({0, 0, 0, 0}), chunk_grid::Columns::Full);
  EXPECT_EQ(columns({0, 2, 0, 0}), chunk_grid::Columns::Full) << "as wide as high";
  EXPECT_EQ(columns({0, 3, 1, 0}), chunk_grid::Columns::HalfToNorthPole);
  EXPECT_EQ(columns({1, 3, 1, 7}), chunk_grid::Columns::HalfToSouthPole);
  EXPECT_EQ(columns({1, 3, 1, 1}), chunk_grid::Columns::Full);
  EXPECT_EQ(columns({1, 7, 1, 0}), chunk_grid::Columns::HalfToNorthPole);
}

glm::dvec3 normalOffset(const ChunkSurface& surface, int column, int row) {
  const NormalImage::Texel& texel = surface.normals().texel(0, column, row);
  return (glm::dvec3(texel[0], texel[1], texel[2]) - 128.0) / 127.0 * surface.normals().scale();
}

TEST(ChunkSurface, NormalsOfAFlatSurfaceAreTheEllipsoids) {
  const ChunkSurface surface(earth(), {1, 5, 7, 0}, std::vector<float>(side * side, 500.0F));
  EXPECT_LT(surface.normals().scale(), 1e-3);
}

TEST(ChunkSurface, NormalsOfASlopeAreItsGradients) {
  // A plane that climbs one in ten to the east, near the equator.
  const TileIndex index{1, 12, 700, 2047};
  const ChunkSurface surface(earth(), index, heightsOf(index, [](const GeodeticPosition& place) {
                               return static_cast<float>(0.1 * 6378137.0 * (place.longitude - 0.5));
                             }));
  const GeodeticPosition middle = earth().geodetic(index, {0.5, 0.5});
  const glm::dvec3 up = earth().ellipsoid().normal(middle.latitude, middle.longitude);
  const glm::dvec3 east(-std::sin(middle.longitude), std::cos(middle.longitude), 0.0);
  const glm::dvec3 expected = glm::normalize(up - 0.1 * east);
  EXPECT_LT(glm::distance(up + normalOffset(surface, 64, 64), expected), 2e-3);
}

TEST(ChunkSurface, ItsNormalsAreWithinItsCone) {
  const TileIndex index{1, 3, 2, 3};
  const ChunkSurface surface(earth(), index, heightsOf(index, relief));
  for (const SurfaceVertex& vertex : surface.vertices()) {
    const glm::dvec3 normal(vertex.normal[0], vertex.normal[1], vertex.normal[2]);
    EXPECT_LE(std::acos(std::min(1.0, glm::dot(normal, surface.normalCone().axis))), surface.normalCone().angle + 1e-6);
  }
}

TEST(ChunkSurface, NeighboursAgreeOnTheirSharedEdgeToTheBit) {
  const TileIndex west{1, 7, 40, 50};
  const Neighbour east = *earth().neighbour(west, Edge::East);
  const ChunkSurface a(earth(), west, heightsOf(west, relief));
  const ChunkSurface b(earth(), east.index, heightsOf(east.index, relief));
  for (int row = 0; row <= 128; ++row) {
    EXPECT_EQ(a.heightAt({1.0, row / 128.0}), b.heightAt({0.0, row / 128.0}));
  }
  EXPECT_EQ(a.corners()[1], b.corners()[0]);
  EXPECT_EQ(a.corners()[3], b.corners()[2]);
}

class ChunkGridDensity : public testing::TestWithParam<std::tuple<int, chunk_grid::Columns>> {};
INSTANTIATE_TEST_SUITE_P(All, ChunkGridDensity,
                         testing::Combine(testing::Range(0, chunk_grid::steps),
                                          testing::ValuesIn(chunk_grid::allColumns)));

TEST_P(ChunkGridDensity, CoversTheTileOnceAndFacesOutwards) {
  const auto [step, columns] = GetParam();
  const std::vector<std::uint16_t> indices = chunk_grid::indices(step, columns, 0xF);
  double area = 0.0;
  for (int i = 0; i < chunk_grid::gridIndexCount(step, columns); i += 3) {
    const auto corner = [&](int n) {
      const chunk_grid::Place p = chunk_grid::place(indices[static_cast<std::size_t>(i + n)]);
      return glm::dvec2(p.column / 32.0, -p.row / 32.0);
    };
    const glm::dvec2 a = corner(1) - corner(0);
    const glm::dvec2 b = corner(2) - corner(0);
    const double twice = a.x * b.y - a.y * b.x;
    EXPECT_GT(twice, 0.0) << "clockwise triangle";
    area += twice / 2.0;
  }
  // At a pole a row of cells is one of triangles: in the unit square they leave out half of it, on the globe nothing.
  const double tips = columns == chunk_grid::Columns::Full ? 0.0 : 0.5 / chunk_grid::segmentsAt(step);
  EXPECT_NEAR(area, 1.0 - tips, 1e-12);
}

TEST(ChunkGrid, SkirtsFaceAwayFromTheTile) {
  const std::vector<std::uint16_t> indices = chunk_grid::indices(0, chunk_grid::Columns::Full, 0xF);
  for (std::size_t i = static_cast<std::size_t>(chunk_grid::gridIndexCount(0, chunk_grid::Columns::Full));
       i < indices.size(); i += 3) {
    const auto corner = [&](std::size_t n) {
      const chunk_grid::Place p = chunk_grid::place(indices[i + n]);
      return glm::dvec3(p.column / 32.0, -p.row / 32.0, p.skirt ? -1.0 : 0.0);
    };
    const glm::dvec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    const glm::dvec3 middle = (corner(0) + corner(1) + corner(2)) / 3.0;
    EXPECT_GT(glm::dot(normal, glm::dvec3(middle.x - 0.5, middle.y + 0.5, 0.0)), 0.0);
  }
}

TEST(ChunkGrid, OnlyTheEdgesAskedForHaveSkirts) {
  for (unsigned edges = 0; edges < chunk_grid::edgeSets; ++edges) {
    const std::vector<std::uint16_t> indices = chunk_grid::indices(1, chunk_grid::Columns::HalfToNorthPole, edges);
    std::array<int, 4> feet{};
    for (const std::uint16_t index : indices) {
      if (index >= chunk_grid::gridVertices) {
        ++feet[static_cast<std::size_t>((index - chunk_grid::gridVertices) / chunk_grid::side)];
      }
    }
    for (unsigned edge = 0; edge < 4; ++edge) {
      EXPECT_EQ(feet[edge] > 0, (edges >> edge & 1U) != 0) << "edges " << edges << ", edge " << edge;
    }
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
