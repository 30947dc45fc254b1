#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "host/api/error.h"

namespace meridian::globebrowsing {

/// West, south, east, north: in radians or in the units of a CRS, as the place says.
struct Extent {
  double west = 0.0;
  double south = 0.0;
  double east = 0.0;
  double north = 0.0;
};

/// As if northing and easting had been written the other way round.
[[nodiscard]] constexpr Extent axesExchanged(const Extent& extent) {
  return {extent.south, extent.west, extent.north, extent.east};
}

/// A coordinate reference system as map services name it: "EPSG:4326", "urn:ogc:def:crs:EPSG::3857", "CRS:84",
/// "http://www.opengis.net/def/crs/EPSG/0/3031", Esri's numbers, IAU codes, WKT.
class MapCrs {
 public:
  /// Errors: a name that PROJ does not know, or a CRS that is neither geographic nor projected. Reads no files and asks
  /// no servers; safe from any thread.
  [[nodiscard]] static Result<MapCrs> of(std::string_view name, const std::string& where);

  /// For TileService::crs: empty where the units are degrees of longitude and latitude.
  [[nodiscard]] const std::string& definition() const { return definition_; }
  [[nodiscard]] bool isGeographic() const { return definition_.empty(); }
  /// EPSG:3857 by any of its names.
  [[nodiscard]] bool isWebMercator() const;
  /// The authority's first axis runs north: latitude or northing comes first in WMS 1.3.0 and WMTS.
  [[nodiscard]] bool isNorthingFirst() const { return isNorthingFirst_; }
  /// Metres of one unit; of a degree, along the equator of the CRS's body.
  [[nodiscard]] double metresPerUnit() const { return metresPerUnit_; }

  /// The extent in units of this CRS around an extent in degrees, and the other way round. Nothing where the CRS has no
  /// such place.
  [[nodiscard]] std::optional<Extent> fromDegrees(const Extent& degrees) const;
  [[nodiscard]] std::optional<Extent> toDegrees(const Extent& extent) const;

 private:
  [[nodiscard]] std::optional<Extent> transformed(const Extent& extent, bool isInverse) const;

  std::string definition_;
  bool isNorthingFirst_ = false;
  double metresPerUnit_ = 1.0;
};

/// "EPSG:4326" of whichever spelling; names that are not understood come back as they are.
[[nodiscard]] std::string canonicalCrsName(std::string_view name);

/// Half the width of EPSG:3857's square, in metres: 6378137 pi.
inline constexpr double webMercatorHalfWidth = 20037508.342789244;

}  // namespace meridian::globebrowsing
