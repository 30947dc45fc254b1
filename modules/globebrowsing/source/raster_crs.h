#pragma once

#include <array>
#include <memory>
#include <numbers>
#include <string>

#include <ogr_spatialref.h>

#include "globebrowsing/source/raster_georeference.h"

namespace meridian::globebrowsing {

/// GDAL's geotransform: x = a0 + a1 column + a2 row, y = a3 + a4 column + a5 row.
using Affine = std::array<double, 6>;

/// What placing pixels needs of a coordinate reference system.
struct Crs {
  bool isGeographic = true;                ///< degrees, east and north positive, after what `affine` was changed by
  double unit = std::numbers::pi / 180.0;  ///< radians in a unit of the geographic coordinates
  double primeMeridian = 0.0;              ///< radians
  double eastward = 1.0;                   ///< -1 where the CRS counts longitude westward
  std::shared_ptr<const Projection> projection{};  ///< null when geographic
  double mercatorRadius =
      0.0;  ///< metres: of a spherical Mercator map that starts at longitude 0, beside its projection
};

/// Null or empty: degrees. Changes `affine` from units of the CRS to degrees where that is a matter of scale. Errors: a
/// CRS that is neither geographic nor projected, or that PROJ rejects.
[[nodiscard]] Result<Crs> readCrs(const OGRSpatialReference* found, Affine& affine, const std::string& where);
/// Of "EPSG:3857", WKT and the like; empty text gives an empty CRS. Errors: PROJ does not know it.
[[nodiscard]] Result<OGRSpatialReference> parseCrs(const std::string& text, const std::string& where);

}  // namespace meridian::globebrowsing
