#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "globebrowsing/layers/chunk_grid.h"
#include "globebrowsing/layers/normal_image.h"
#include "globebrowsing/streaming/tile_data.h"
#include "globebrowsing/streaming/tile_residency.h"
#include "globebrowsing/tiling/tiling.h"

namespace meridian::globebrowsing {

/// One vertex as the GPU gets it. Position in model space, relative to the camera:
/// P = bilinear(corners - camera, place) + offset + height * normal (Lambers & Kolb 2012, section 4).
struct SurfaceVertex {
  std::array<float, 3> offset{};        ///< metres, from the bilinear patch of the corners to the ellipsoid
  float height = 0.0F;                  ///< metres above the ellipsoid
  std::array<float, 3> normal{};        ///< of the ellipsoid
  std::array<std::uint8_t, 4> place{};  ///< column, row (0..32), 1 for a skirt's foot, unused
};
static_assert(sizeof(SurfaceVertex) == 32);

/// The shape of one tile: its composed height tile, and all that is derived from it, once, in double, on a worker.
/// Bounds, picking, heightAt, normals and vertices all come from the same heights, so they cannot disagree.
class ChunkSurface final : public TileData {
 public:
  static constexpr int nodes =
      NormalImage::nodes;          ///< 129 a side, node-registered: the first and last lie on the edges
  static constexpr int apron = 1;  ///< nodes beyond each edge, for normals
  static constexpr int heightSide = nodes + 2 * apron;

  /// `heights`: heightSide x heightSide metres, row by row from the north-west, none of them not-a-number.
  ChunkSurface(const Tiling& tiling, const TileIndex& index, std::vector<float> heights);

  /// On the ellipsoid, model space: north-west, north-east, south-west, south-east.
  [[nodiscard]] const std::array<glm::dvec3, 4>& corners() const { return corners_; }
  [[nodiscard]] const HeightRange& heightRange() const { return range_; }
  /// Half as many columns as rows for a tile that touches a pole and is at its other end at most half as wide as high.
  [[nodiscard]] chunk_grid::Columns columns() const { return columns_; }
  /// Metres by which vertices are raised when the tile is drawn at that step (0..4). Triangles cut under a curved
  /// surface, by nothing at their corners and the most in the middle; raised by half of that they err half as much, to
  /// both sides. The same for all tiles of a level, so that neighbours go on sharing their edges.
  [[nodiscard]] double lift(int step) const { return lifts_[static_cast<std::size_t>(step)]; }
  /// Metres between the surface drawn at that step (0..4) and at every node: the largest, along the normal.
  [[nodiscard]] double error(int step) const { return errors_[static_cast<std::size_t>(step)]; }
  /// Metres between the north and south edges drawn at that step and through every node: the largest, along the surface
  /// and across the edge. (Parallels bend along the surface; meridians do not.)
  [[nodiscard]] double drift(int step) const { return drifts_[static_cast<std::size_t>(step)]; }
  [[nodiscard]] std::span<const SurfaceVertex> vertices() const { return vertices_; }
  [[nodiscard]] const NormalImage& normals() const { return normals_; }
  /// 1 - (narrower over wider of the north and the south edge), 0..1; below 0 when the south edge is the narrower one.
  /// 0 for a root between two poles.
  [[nodiscard]] double taper() const { return taper_; }
  /// All of the tile's ellipsoid normals are within `angle` radians of `axis`.
  struct NormalCone {
    glm::dvec3 axis{0.0, 0.0, 1.0};
    double angle = 0.0;
  };
  [[nodiscard]] const NormalCone& normalCone() const { return cone_; }
  /// Bilinear between the nodes; uv is clamped to the tile.
  [[nodiscard]] double heightAt(const glm::dvec2& uv) const;

  [[nodiscard]] std::size_t bytes() const override;

 private:
  struct Nodes;
  [[nodiscard]] float height(int column, int row) const;
  void setLifts(const Tiling& tiling, const TileIndex& index);
  void makeVertices(const Nodes& all);
  void makeNormals(const Nodes& all);
  [[nodiscard]] double driftAt(const Nodes& all, int step) const;
  void setTaper(const Nodes& all);
  [[nodiscard]] static glm::dvec3 surfaceNormal(const Nodes& all, int column, int row);
  [[nodiscard]] double errorAt(const Nodes& all, int step) const;

  std::vector<float> heights_;
  std::array<glm::dvec3, 4> corners_{};
  HeightRange range_;
  std::array<double, chunk_grid::steps> lifts_{};
  std::array<double, chunk_grid::steps> errors_{};
  std::array<double, chunk_grid::steps> drifts_{};
  std::vector<SurfaceVertex> vertices_;
  NormalImage normals_;
  double taper_ = 0.0;
  chunk_grid::Columns columns_ = chunk_grid::Columns::Full;
  NormalCone cone_;
};

/// The point of the patch that four corners (north-west, north-east, south-west, south-east) span.
[[nodiscard]] glm::dvec3 bilinear(const std::array<glm::dvec3, 4>& corners, const glm::dvec2& uv);

}  // namespace meridian::globebrowsing
