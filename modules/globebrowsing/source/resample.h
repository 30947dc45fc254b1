#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "globebrowsing/source/tile_layout.h"
#include "globebrowsing/tiling/tiling.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

class RasterSource;

/// A tile's colours: size x size pixels of 4 bytes (red, green, blue, alpha; not premultiplied), north row first.
struct ColourPixels {
  int size = 0;
  std::vector<std::uint8_t> rgba{};  ///< empty when the raster does not reach the tile
  bool anyOpaque = false;            ///< some alpha > 0
  bool allOpaque = false;            ///< every alpha = 255
};

/// A tile's heights: size x size samples in metres, north row first; not-a-number where there are no data.
struct HeightPixels {
  int size = 0;
  std::vector<float> metres{};  ///< empty when the raster does not reach the tile
  bool any = false;
  float minimum = 0.0F;  ///< of the samples that are numbers; 0 without any
  float maximum = 0.0F;
};

/// Brings a raster onto a tile (after Westerteiger et al.; docs/architecture.md, Resampling). Coordinates and heights
/// are in double, sums of colours in float.
///
/// The raster's level of detail is that whose pixels are at most as large as the tile's samples; the kernel (colours:
/// triangle; heights: Catmull-Rom cubic, a = -0.5, Keys 1981) widens with what is left, so that nothing aliases.
/// Samples across the antimeridian and the poles continue on the other side. Absent pixels drop out and the weights of
/// the others are renormalised (heights: those of the triangle, where at least half of its weight is present).
///
/// Heights depend on latitude, longitude and the tile's level only, not on the tile: shared nodes of tiles of one level
/// come out the same to the bit, also across the antimeridian; all nodes at a pole are equal.
///
/// No overlap is not an error: the result is empty, at once. Errors: what GDAL or PROJ cannot read or transform;
/// "cancelled" when `stop` was requested. Blocking; call on a worker.
[[nodiscard]] Result<ColourPixels> resampleColours(const RasterSource& source, const Tiling& tiling,
                                                   const TileIndex& index, const TileLayout& layout,
                                                   const std::stop_token& stop);
[[nodiscard]] Result<HeightPixels> resampleHeights(const RasterSource& source, const Tiling& tiling,
                                                   const TileIndex& index, const TileLayout& layout,
                                                   const std::stop_token& stop);

}  // namespace meridian::globebrowsing
