#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "globebrowsing/source/tile_layout.h"
#include "globebrowsing/streaming/tile_data.h"
#include "globebrowsing/tiling/tiling.h"

namespace meridian::globebrowsing {

/// The relief of one tile as colours are made from it: composed height and surface normal at each pixel of a colour
/// tile, border included, north row first.
///
/// Gradients are Horn's (1981), as gdaldem's, but in metres on the ellipsoid: columns stand closer towards the poles.
class ReliefTile final : public TileData {
 public:
  static constexpr int size = colourLayout.size();
  /// East and north component of the unit normal, times 32767. Beyond a pole the frame goes on as it was, so that
  /// normals can be interpolated across it.
  using Normal = std::array<std::int16_t, 2>;

  /// `heights`: metres in reliefLayout, none of them not-a-number.
  ReliefTile(const Tiling& tiling, const TileIndex& index, const std::vector<float>& heights);

  [[nodiscard]] std::span<const float> heights() const { return heights_; }
  [[nodiscard]] std::span<const Normal> normals() const { return normals_; }
  [[nodiscard]] std::size_t bytes() const override;
  /// No other relief tile of this process ever has it, not even one of the same place.
  [[nodiscard]] std::uint64_t id() const { return id_; }

 private:
  std::uint64_t id_;
  std::vector<float> heights_;
  std::vector<Normal> normals_;
};

/// Metres along a column of the tile from one pixel to the next, in its middle: the unit of line widths.
[[nodiscard]] double pixelMetres(const Tiling& tiling, const TileIndex& index);

}  // namespace meridian::globebrowsing
