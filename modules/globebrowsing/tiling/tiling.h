#pragma once

#include <array>
#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "globebrowsing/geodesy/ellipsoid.h"
#include "globebrowsing/tiling/tile_index.h"

namespace meridian::globebrowsing {

/// The edges of a tile's unit square.
enum class Edge : std::uint8_t { West, East, North, South };
inline constexpr std::array<Edge, 4> allEdges{Edge::West, Edge::East, Edge::North, Edge::South};

/// Part of a unit square: other = offset + scale * own, component by component, v may run backwards (negative scale).
struct UnitSquareTransform {
  glm::dvec2 offset{0.0};
  glm::dvec2 scale{1.0};

  bool operator==(const UnitSquareTransform&) const = default;
  [[nodiscard]] glm::dvec2 apply(const glm::dvec2& uv) const { return offset + scale * uv; }
  /// First this, then `outer`.
  [[nodiscard]] UnitSquareTransform then(const UnitSquareTransform& outer) const {
    return {outer.offset + outer.scale * offset, outer.scale * scale};
  }
};

/// The tile beyond an edge: of at most the asking tile's level, its `edge` containing the whole of the asking edge.
struct Neighbour {
  TileIndex index;
  Edge edge = Edge::West;  ///< of the neighbour
  double offset = 0.0;     ///< along the neighbour's edge = offset + scale * along the asking edge
  double scale = 1.0;      ///< negative when the neighbour's edge runs the other way
  [[nodiscard]] bool isReversed() const { return scale < 0.0; }
};

/// The children of a tile: 2, 3 or 4 of them.
struct Children {
  std::array<TileIndex, 4> index{};
  int count = 0;
  [[nodiscard]] const TileIndex* begin() const { return index.data(); }
  [[nodiscard]] const TileIndex* end() const { return index.data() + count; }
};

/// A place in a tile.
struct TilePlace {
  TileIndex index;
  glm::dvec2 uv{0.0};
};

/// How a globe's surface is cut into trees of tiles, and how each tile's unit square lies on the reference ellipsoid:
/// u = 0..1 eastward (west edge to east edge), v = 0..1 southward (north edge to south edge), like rows of a raster.
///
/// Contract (docs/architecture.md, A tile): the points of an edge that two tiles share come out the same to the bit,
/// whichever tile asks. Immutable and safe from any thread. Angles in radians, positions in model space in metres.
class Tiling {
 public:
  explicit Tiling(const Ellipsoid& ellipsoid) : ellipsoid_(ellipsoid) {}
  virtual ~Tiling() = default;

  [[nodiscard]] const Ellipsoid& ellipsoid() const { return ellipsoid_; }
  [[nodiscard]] virtual int rootCount() const = 0;
  [[nodiscard]] virtual Children children(const TileIndex& index) const = 0;
  /// Nothing for a root.
  [[nodiscard]] virtual std::optional<TileIndex> parent(const TileIndex& index) const = 0;
  /// Where the tile's unit square lies in its parent's. The tile must not be a root.
  [[nodiscard]] virtual UnitSquareTransform inParent(const TileIndex& index) const = 0;
  /// Nothing at an edge that is a pole.
  [[nodiscard]] virtual std::optional<Neighbour> neighbour(const TileIndex& index, Edge edge) const = 0;

  /// Geodetic latitude and longitude at uv; uv may leave 0..1 a little (borders and aprons), beyond a pole it goes on
  /// down the other side.
  [[nodiscard]] virtual GeodeticPosition geodetic(const TileIndex& index, const glm::dvec2& uv) const = 0;
  /// The tile of that level that has the place; every place has one at every level.
  [[nodiscard]] virtual TilePlace locate(double latitude, double longitude, int level) const = 0;
  /// Whether uv is separable into longitude(u) and latitude(v), which lets resampling go by rows and columns.
  [[nodiscard]] virtual bool isSeparable() const { return false; }

  /// On the ellipsoid at uv.
  [[nodiscard]] glm::dvec3 position(const TileIndex& index, const glm::dvec2& uv) const {
    return ellipsoid_.cartesian(geodetic(index, uv));
  }

 private:
  Ellipsoid ellipsoid_;
};

/// The tile's unit square in that of its ancestor at `level` (at most the tile's own).
struct AncestorPlace {
  TileIndex index;
  UnitSquareTransform transform;
};
[[nodiscard]] AncestorPlace ancestorAt(const Tiling& tiling, const TileIndex& index, int level);

}  // namespace meridian::globebrowsing
