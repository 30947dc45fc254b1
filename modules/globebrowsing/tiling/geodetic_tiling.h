#pragma once

#include "globebrowsing/tiling/tiling.h"

namespace meridian::globebrowsing {

/// Latitude and longitude as rows and columns (Bladin & Broberg 2016, section 3.1, with thinned rows): root 0 is the
/// western hemisphere, root 1 the eastern, each 180 degrees square. A level has 2^level rows per root. A tile splits
/// into four, but in latitude only (into two) where cos(latitude of its edge nearer the equator) * longitude width is
/// less than half its latitude height, so near the poles a row has fewer columns and no tile pinches.
class GeodeticTiling final : public Tiling {
 public:
  using Tiling::Tiling;

  [[nodiscard]] int rootCount() const override { return 2; }
  [[nodiscard]] Children children(const TileIndex& index) const override;
  [[nodiscard]] std::optional<TileIndex> parent(const TileIndex& index) const override;
  [[nodiscard]] UnitSquareTransform inParent(const TileIndex& index) const override;
  [[nodiscard]] std::optional<Neighbour> neighbour(const TileIndex& index, Edge edge) const override;
  [[nodiscard]] GeodeticPosition geodetic(const TileIndex& index, const glm::dvec2& uv) const override;
  [[nodiscard]] TilePlace locate(double latitude, double longitude, int level) const override;
  [[nodiscard]] bool isSeparable() const override { return true; }

  /// Columns of one root in that row: a power of two, at most 2^level.
  [[nodiscard]] static std::uint32_t columns(int level, std::uint32_t row);
};

}  // namespace meridian::globebrowsing
