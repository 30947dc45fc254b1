#include "globebrowsing/source/map_crs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include <cpl_conv.h>
#include <ogr_spatialref.h>

#include "globebrowsing/source/gdal_runtime.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

bool isWebMercatorCode(std::string_view code) {
  // Before it had its number, it had many.
  constexpr std::array<std::string_view, 6> codes{"3857", "900913", "3785", "102100", "102113", "3587"};
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

/// The last two parts that say something: authority and code.
std::string fromParts(const std::vector<std::string>& parts) {
  if (parts.size() < 2) {
    return {};
  }
  const std::string& code = parts.back();
  std::string authority;
  for (const std::string& part : parts) {
    const std::string name = lowerCase(part);
    if (name == "epsg" || name == "ogc" || name == "esri" || name == "iau" || name.starts_with("iau_") ||
        name.starts_with("iau2")) {
      authority = part;
    }
  }
  if (equalIgnoringCase(authority, "ogc")) {
    return code == "84" || equalIgnoringCase(code, "CRS84") ? "CRS:84" : "OGC:" + code;
  }
  return authority.empty() ? std::string() : authority + ":" + code;
}

/// PROJ's spellings to try for "AUTHORITY:CODE".
std::vector<std::string> spellings(const std::string& name) {
  const std::size_t colon = name.find(':');
  const std::string authority = lowerCase(name.substr(0, colon));
  const std::string code = colon == std::string::npos ? std::string() : name.substr(colon + 1);
  if (authority == "epsg") {
    return {name, "ESRI:" + code};  // Esri's own numbers are often called EPSG's
  }
  if (authority.starts_with("iau")) {
    return {"IAU_2015:" + code};
  }
  return {name};
}

bool import(OGRSpatialReference& crs, const std::string& name) {
  const GdalMessages messages;
  for (const std::string& spelling : spellings(name)) {
    if (crs.SetFromUserInput(spelling.c_str(), OGRSpatialReference::SET_FROM_USER_INPUT_LIMITATIONS_get()) ==
        OGRERR_NONE) {
      return true;
    }
  }
  return false;
}

/// Polar maps have both axes run north (or south), easting first; then the name tells.
bool hasNorthingFirst(const OGRSpatialReference& crs) {
  OGRAxisOrientation first = OAO_Other;
  OGRAxisOrientation second = OAO_Other;
  const char* name = crs.GetAxis(nullptr, 0, &first);
  crs.GetAxis(nullptr, 1, &second);
  return (first == OAO_North && second == OAO_East) || (name != nullptr && STARTS_WITH_CI(name, "Northing"));
}

}  // namespace

std::string canonicalCrsName(std::string_view name) {
  const std::string text(trimmed(name));
  const std::string lowered = lowerCase(text);
  if (lowered == "crs84" || lowered == "crs:84" || lowered == "ogc:crs84" || lowered == "wgs84(dd)") {
    return "CRS:84";
  }
  std::string result = text;
  if (lowered.starts_with("urn:")) {
    if (const std::string found = fromParts(split(text, ":")); !found.empty()) {
      result = found;
    }
  } else if (lowered.starts_with("http")) {
    if (const std::string found = fromParts(split(replaceAll(text, "epsg.xml", "epsg"), "/#")); !found.empty()) {
      result = found;
    }
  } else if (!lowered.empty() && lowered.find_first_not_of("0123456789") == std::string::npos) {
    result = "EPSG:" + text;
  }
  const std::size_t colon = result.find(':');
  if (colon < 12) {  // npos is greater
    std::string authority = result.substr(0, colon);
    const std::string code = result.substr(colon + 1);
    if (lowerCase(authority) == "epsg" || lowerCase(authority) == "esri") {
      std::transform(authority.begin(), authority.end(), authority.begin(),
                     [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      result = authority + ":" + code;
    }
    if (isWebMercatorCode(code) || (equalIgnoringCase(authority, "osgeo") && code == "41001")) {
      return "EPSG:3857";
    }
  }
  return result;
}

Result<MapCrs> MapCrs::of(std::string_view name, const std::string& where) {
  const std::string canonical = canonicalCrsName(name);
  MapCrs result;
  if (canonical == "CRS:84" || canonical == "CRS:83" || canonical == "CRS:27") {
    result.metresPerUnit_ = 6378137.0 * degree;
    return result;
  }
  OGRSpatialReference crs;
  if (canonical.size() > 16384 || !import(crs, canonical)) {
    return failure("the coordinate reference system '" + canonical.substr(0, 80) + "' is unknown", where,
                   "choose another CRS of the service");
  }
  if (!crs.IsGeographic() && !crs.IsProjected()) {
    return failure("the coordinate reference system '" + canonical.substr(0, 80) + "' is not one of a map", where);
  }
  result.isNorthingFirst_ = hasNorthingFirst(crs);
  if (crs.IsGeographic()) {
    result.metresPerUnit_ = crs.GetSemiMajor() * degree;
    return result;
  }
  result.metresPerUnit_ = crs.GetLinearUnits();
  result.definition_ = canonical;
  if (!canonical.starts_with("EPSG:") || crs.GetAuthorityName(nullptr) == nullptr ||
      !EQUAL(crs.GetAuthorityName(nullptr), "EPSG")) {
    char* wkt = nullptr;
    const std::array<const char*, 2> options{"FORMAT=WKT2_2018", nullptr};
    if (crs.exportToWkt(&wkt, options.data()) == OGRERR_NONE) {
      result.definition_ = wkt;
    }
    CPLFree(wkt);
  }
  return result;
}

bool MapCrs::isWebMercator() const {
  return definition_ == "EPSG:3857";
}

std::optional<Extent> MapCrs::transformed(const Extent& extent, bool isInverse) const {
  OGRSpatialReference crs;
  const GdalMessages messages;
  if (!import(crs, definition_)) {
    return std::nullopt;
  }
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRSpatialReference> geographic(crs.CloneGeogCS());
  if (!geographic) {
    return std::nullopt;
  }
  geographic->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> transformation(
      isInverse ? OGRCreateCoordinateTransformation(&crs, geographic.get())
                : OGRCreateCoordinateTransformation(geographic.get(), &crs));
  Extent result;
  if (!transformation ||
      transformation->TransformBounds(extent.west, extent.south, extent.east, extent.north, &result.west, &result.south,
                                      &result.east, &result.north, 21) == FALSE) {
    return std::nullopt;
  }
  if (!std::isfinite(result.west + result.south + result.east + result.north) ||
      (!isInverse && !(result.east > result.west && result.north > result.south))) {
    return std::nullopt;
  }
  return result;
}

std::optional<Extent> MapCrs::fromDegrees(const Extent& degrees) const {
  if (isGeographic()) {
    return degrees;
  }
  if (isWebMercator()) {  // exact where PROJ samples, and defined to its own edge
    static constexpr double limit = 85.051128779806604;
    const auto northing = [](double latitude) {
      return 6378137.0 * std::asinh(std::tan(std::clamp(latitude, -limit, limit) * degree));
    };
    const double metres = webMercatorHalfWidth / 180.0;
    return Extent{degrees.west * metres, northing(degrees.south), degrees.east * metres, northing(degrees.north)};
  }
  return transformed(degrees, false);
}

std::optional<Extent> MapCrs::toDegrees(const Extent& extent) const {
  if (isGeographic()) {
    return extent;
  }
  if (isWebMercator()) {
    const auto latitude = [](double northing) { return std::atan(std::sinh(northing / 6378137.0)) / degree; };
    const double degrees = 180.0 / webMercatorHalfWidth;
    return Extent{extent.west * degrees, latitude(extent.south), extent.east * degrees, latitude(extent.north)};
  }
  return transformed(extent, true);
}

}  // namespace meridian::globebrowsing
