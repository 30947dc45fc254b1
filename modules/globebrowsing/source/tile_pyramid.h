#pragma once

#include <vector>

#include "globebrowsing/source/map_crs.h"
#include "globebrowsing/source/tile_service.h"

namespace meridian::globebrowsing {

/// Narrows the matrix's columns and rows to the tiles that have more than an edge in common with the extent (in units
/// of the CRS). False when none is left.
[[nodiscard]] bool clip(TileMatrix& matrix, const Extent& extent);

/// A pyramid for a service that gives any window of its map: every level halves the pixels of the one above.
struct Pyramid {
  int tileSize = 512;          ///< pixels a side
  Extent extent{};             ///< of the data, in units of the CRS
  double finestPixel = 0.0;    ///< the finest level's pixels are at most this large, unless that is beyond level 30
  double coarsestPixel = 0.0;  ///< levels of larger pixels than this are left out; 0: none is
};
/// Finest first, identifiers "0", "1" ... from the coarsest, clipped to the extent. In degrees the tiles are those of a
/// geodetic globe (180 degrees at level 0), in EPSG:3857 the usual ones; elsewhere the extent's square is level 0.
[[nodiscard]] std::vector<TileMatrix> layOutPyramid(const MapCrs& crs, const Pyramid& pyramid);

/// Takes out matrices without tiles, sorts the finest first and gives the service its extent: what its matrices have
/// and, of that, what lies within `extent`. Errors: nothing is left.
[[nodiscard]] Result<void> setMatrices(TileService& service, std::vector<TileMatrix> matrices, const Extent& extent);

}  // namespace meridian::globebrowsing
