#include <algorithm>
#include <cmath>
#include <numbers>

#include "globebrowsing/source/resample_parts.h"

namespace meridian::globebrowsing {

namespace {

constexpr double pi = std::numbers::pi;

/// South, north, and the longitudes about `middle`, that a tile does not reach beyond.
struct Bounds {
  double south = 0.0;
  double north = 0.0;
  double middle = 0.0;
  double halfWidth = 0.0;
};

Bounds boundsOf(const Tiling& tiling, const TileIndex& index) {
  constexpr int cells = 8;
  const double middle = tiling.geodetic(index, {0.5, 0.5}).longitude;
  Bounds bounds{pi / 2, -pi / 2, middle, 0.0};
  for (int v = 0; v <= cells; ++v) {
    for (int u = 0; u <= cells; ++u) {
      const GeodeticPosition place = tiling.geodetic(index, {u / double{cells}, v / double{cells}});
      bounds.south = std::min(bounds.south, place.latitude);
      bounds.north = std::max(bounds.north, place.latitude);
      if (std::abs(place.latitude) < pi / 2 - 1e-12) {  // a pole is at every longitude
        bounds.halfWidth = std::max(bounds.halfWidth, std::abs(std::remainder(place.longitude - middle, 2.0 * pi)));
      }
    }
  }
  if (tiling.isSeparable()) {
    return bounds;
  }
  // Between the points that were looked at, an edge bulges by less than a quarter of a cell.
  const double margin = (bounds.north - bounds.south) / cells / 4;
  bounds.south -= margin;
  bounds.north += margin;
  const double polar = std::max(std::abs(bounds.south), std::abs(bounds.north));
  bounds.halfWidth = polar + 2 * margin >= pi / 2 ? pi : std::min(bounds.halfWidth * (1 + 0.5 / cells), pi);
  return bounds;
}

}  // namespace

bool reaches(const RasterGeoreference& georeference, const Tiling& tiling, const TileIndex& index) {
  const Bounds tile = boundsOf(tiling, index);
  if (tile.south > georeference.north() || tile.north < georeference.south()) {
    return false;
  }
  const double halfWidth = (georeference.east() - georeference.west()) / 2;
  const double apart = std::abs(std::remainder(tile.middle - (georeference.west() + halfWidth), 2.0 * pi));
  return georeference.coversAllLongitudes() || apart <= halfWidth + tile.halfWidth;
}

}  // namespace meridian::globebrowsing
