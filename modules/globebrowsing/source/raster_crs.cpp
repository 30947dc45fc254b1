#include "globebrowsing/source/raster_crs.h"

#include <cmath>
#include <cstdlib>
#include <cstring>

#include "globebrowsing/source/gdal_runtime.h"

namespace meridian::globebrowsing {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// The radius of EPSG:3857 and its like on other bodies, else 0. PROJ takes geodetic latitudes for the sphere's.
double sphericalMercatorRadius(const OGRSpatialReference& crs) {
  char* text = nullptr;
  const bool isText = crs.exportToProj4(&text) == OGRERR_NONE;
  const std::string words = isText ? text : "";
  CPLFree(text);
  const auto parameter = [&words](const char* name, double otherwise) {
    const std::size_t at = (" " + words).find(std::string(" +") + name + '=');
    return at == std::string::npos ? otherwise : std::atof(words.c_str() + at + std::strlen(name) + 2);
  };
  const double radius = parameter("R", parameter("a", 0.0));
  const bool isSphere = parameter("R", parameter("b", -1.0)) == radius && words.find("+rf=") == std::string::npos;
  const bool isPlain = parameter("lat_ts", 0.0) == 0.0 && parameter("lon_0", 0.0) == 0.0 &&
                       parameter("x_0", 0.0) == 0.0 && parameter("y_0", 0.0) == 0.0 && parameter("k", 1.0) == 1.0 &&
                       parameter("k_0", 1.0) == 1.0 && words.find("+units=m ") != std::string::npos;
  return words.starts_with("+proj=merc ") && isSphere && isPlain ? radius : 0.0;
}

/// Spherical equidistant cylindrical coordinates are degrees by another scale: nearly all planetary maps are. PROJ's
/// eqc uses the semi-major axis alone as well.
bool toDegreesIfEquirectangular(const OGRSpatialReference& crs, Affine& affine) {
  const char* method = crs.GetAttrValue("PROJECTION");
  if (method == nullptr || !EQUAL(method, SRS_PT_EQUIRECTANGULAR) ||
      crs.GetNormProjParm(SRS_PP_LATITUDE_OF_ORIGIN, 0.0) != 0.0) {
    return false;
  }
  const double metres = crs.GetLinearUnits();
  const double parallel = crs.GetNormProjParm(SRS_PP_STANDARD_PARALLEL_1, 0.0) * degree;
  const double radius = crs.GetSemiMajor();
  const double x = metres / (radius * std::cos(parallel)) / degree;
  const double y = metres / radius / degree;
  const double falseEasting = crs.GetNormProjParm(SRS_PP_FALSE_EASTING, 0.0) / metres;
  const double falseNorthing = crs.GetNormProjParm(SRS_PP_FALSE_NORTHING, 0.0) / metres;
  const double primeMeridian = crs.GetPrimeMeridian() * crs.GetAngularUnits() / degree;
  if (!std::isfinite(x) || !std::isfinite(y)) {
    return false;
  }
  affine[0] = (affine[0] - falseEasting) * x + crs.GetNormProjParm(SRS_PP_CENTRAL_MERIDIAN, 0.0) + primeMeridian;
  affine[3] = (affine[3] - falseNorthing) * y;
  affine[1] *= x;
  affine[2] *= x;
  affine[4] *= y;
  affine[5] *= y;
  return true;
}

bool countsLongitudeWestward(const OGRSpatialReference& geographic) {
  for (int axis = 0; axis < 2; ++axis) {
    OGRAxisOrientation orientation = OAO_Other;
    geographic.GetAxis("GEOGCS", axis, &orientation);
    if (orientation == OAO_West) {
      return true;
    }
  }
  return false;
}

}  // namespace

Result<Crs> readCrs(const OGRSpatialReference* found, Affine& affine, const std::string& where) {
  Crs result;
  if (found == nullptr || found->IsEmpty()) {
    return result;
  }
  if (found->IsLocal() || found->IsGeocentric()) {
    return failure("the raster's CRS is neither geographic nor projected", where, "give the raster a CRS on its globe");
  }
  OGRSpatialReference crs(*found);
  crs.StripVertical();
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  GdalMessages messages;
  const std::unique_ptr<OGRSpatialReference> geographic(crs.CloneGeogCS());
  if (!geographic) {
    return messages.failure("the raster's CRS has no geographic base", where);
  }
  geographic->SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  result.unit = geographic->GetAngularUnits();
  result.primeMeridian = geographic->GetPrimeMeridian() * result.unit;
  result.eastward = countsLongitudeWestward(*geographic) ? -1.0 : 1.0;
  if (crs.IsGeographic()) {
    const double toDegrees = result.unit / degree;
    for (double& value : affine) {
      value *= toDegrees;
    }
    for (int i = 0; i < 3; ++i) {
      affine[static_cast<std::size_t>(i)] *= result.eastward;
    }
    affine[0] += result.primeMeridian / degree;
    return result;
  }
  if (result.eastward > 0 && toDegreesIfEquirectangular(crs, affine)) {
    return result;
  }
  std::array<double, 7> toWgs84{};
  if (crs.GetTOWGS84(toWgs84.data(), 7) == OGRERR_NONE) {
    // Both sides alike, or PROJ would shift datums.
    geographic->SetTOWGS84(toWgs84[0], toWgs84[1], toWgs84[2], toWgs84[3], toWgs84[4], toWgs84[5], toWgs84[6]);
  }
  std::unique_ptr<OGRCoordinateTransformation> transformation(
      OGRCreateCoordinateTransformation(geographic.get(), &crs));
  if (!transformation || messages.hasError()) {
    return messages.failure("PROJ rejects the raster's CRS", where, "correct the CRS, for example with gdal_edit.py");
  }
  result.isGeographic = false;
  if (result.eastward > 0 && result.primeMeridian == 0.0) {
    result.mercatorRadius = sphericalMercatorRadius(crs);
  }
  result.projection = std::make_shared<const Projection>(std::move(transformation));
  return result;
}

Result<OGRSpatialReference> parseCrs(const std::string& text, const std::string& where) {
  initializeGdal();
  const GdalMessages messages;
  OGRSpatialReference crs;
  if (!text.empty() && crs.SetFromUserInput(text.c_str()) != OGRERR_NONE) {
    return messages.failure("PROJ does not know the CRS '" + text + "'", where, "name it as EPSG:CODE or give its WKT");
  }
  return crs;
}

}  // namespace meridian::globebrowsing
