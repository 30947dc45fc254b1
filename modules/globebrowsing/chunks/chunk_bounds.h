#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "globebrowsing/streaming/tile_residency.h"
#include "globebrowsing/tiling/tiling.h"

namespace meridian::globebrowsing {

/// A box with any orientation. Model space, metres.
struct OrientedBox {
  glm::dvec3 centre{0.0};
  std::array<glm::dvec3, 3> axes{glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(0.0, 0.0, 1.0)};
  glm::dvec3 half{0.0};  ///< half lengths along the axes, which are unit and orthogonal

  /// 0 inside.
  [[nodiscard]] double distance(const glm::dvec3& position) const;
  [[nodiscard]] bool contains(const glm::dvec3& position) const { return distance(position) == 0.0; }
};

/// A cone and a ball around the ellipsoid's centre that together hold a tile's surface in scaled space (x/a, y/b, z/c):
/// what horizon culling asks of it.
struct ScaledCap {
  glm::dvec3 direction{0.0, 0.0, 1.0};  ///< unit
  double angle = 0.0;                   ///< radians, from the direction; pi when it is too wide to be of use
  double greatestRadius = 1.0;
};

/// What a tile's surface lies in, while its heights stay in a range.
struct ChunkBounds {
  OrientedBox box;
  ScaledCap cap;
  double edgeLength = 0.0;  ///< metres on the ellipsoid: the longest of the tile's four edges
  double area = 0.0;        ///< square metres on the ellipsoid, to a few percent
  glm::dvec3 normal{0.0};   ///< of the ellipsoid in the tile's middle
  /// The tile's middle, corners and middles of edges at the middle of the height range, and the ellipsoid's normals
  /// there: where the chunk tree looks at how large an error appears.
  std::array<glm::dvec3, 9> points{};
  std::array<glm::dvec3, 9> normals{};
};

/// Both bounds hold every point of the tile whose height is within the range. For a separable tiling that is proved: a
/// grid of points is taken, and the margin bounds how far the surface bends between them (its second derivatives by
/// latitude and longitude, over 8). For others the bend is measured between the points and doubled.
///
/// A range that is not finite or upside down is put in order.
[[nodiscard]] ChunkBounds chunkBounds(const Tiling& tiling, const TileIndex& index, const HeightRange& heights);

}  // namespace meridian::globebrowsing
