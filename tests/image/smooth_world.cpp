#include "smooth_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <gdal_priv.h>

namespace meridian::globebrowsing::test {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// Where a raster's values are, in degrees.
struct Grid {
  int columns = 0;
  int rows = 0;
  double pixel = 0.0;
  double west = 0.0;   ///< of the first value
  double north = 0.0;  ///< likewise
};

struct Kind {
  GDALDataType type = GDT_Byte;
  int bands = 1;
  bool nodes = false;
};

void write(const std::filesystem::path& file, const Grid& grid, const Kind& kind,
           const std::function<double(const glm::dvec3&, int)>& value) {
  GDALAllRegister();
  GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), grid.columns, grid.rows, kind.bands, kind.type, nullptr));
  if (!dataset) {
    throw std::runtime_error(file.string() + ": GDAL cannot create it");
  }
  // GDAL's transform is of the pixels' corners, for node-registered rasters too.
  std::array<double, 6> transform{grid.west - 0.5 * grid.pixel,  grid.pixel, 0.0,
                                  grid.north + 0.5 * grid.pixel, 0.0,        -grid.pixel};
  dataset->SetGeoTransform(transform.data());
  if (kind.nodes) {
    dataset->SetMetadataItem("AREA_OR_POINT", "Point");
  }
  OGRSpatialReference crs;
  crs.SetFromUserInput("EPSG:4326");
  dataset->SetSpatialRef(&crs);
  std::vector<double> line(static_cast<std::size_t>(grid.columns));
  for (int band = 0; band < kind.bands; ++band) {
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        line[static_cast<std::size_t>(column)] =
            value(normalAt(grid.north - row * grid.pixel, grid.west + column * grid.pixel), band);
      }
      if (dataset->GetRasterBand(band + 1)->RasterIO(GF_Write, 0, row, grid.columns, 1, line.data(), grid.columns, 1,
                                                     GDT_Float64, 0, 0, nullptr) != CE_None) {
        throw std::runtime_error(file.string() + ": GDAL cannot write it");
      }
    }
  }
}

Grid globalGrid(int columns, bool nodes) {
  const double pixel = 360.0 / columns;
  return nodes ? Grid{columns + 1, columns / 2 + 1, pixel, -180.0, 90.0}
               : Grid{columns, columns / 2, pixel, -180.0 + 0.5 * pixel, 90.0 - 0.5 * pixel};
}

/// Added to every channel: waves that end smoothly at the spot's edges.
double inSpot(const Spot& spot, const glm::dvec3& normal) {
  const double latitude = std::asin(std::clamp(normal.z, -1.0, 1.0)) / degree;
  const double longitude = std::atan2(normal.y, normal.x) / degree;
  const double u = (longitude - spot.longitude) / spot.half;
  const double v = (latitude - spot.latitude) / spot.half;
  if (!(std::abs(u) < 1.0 && std::abs(v) < 1.0)) {
    return 0.0;
  }
  const double window = (1.0 - u * u) * (1.0 - v * v);
  const double turns = 2.0 * std::numbers::pi * spot.waves;
  return 20.0 * window * window * std::sin(turns * u) * std::cos(turns * v);
}

}  // namespace

double SmoothWorld::height(const glm::dvec3& normal) const {
  const double k = waves;
  return relief * (0.4 * std::sin(k * normal.x + 0.3) * std::cos(k * normal.y) + 0.35 * std::sin(k * normal.z + 1.1) +
                   0.25 * std::cos(0.7 * k * (normal.x + normal.y - normal.z)));
}

Relief SmoothWorld::surface() const {
  // A metre along the surface turns the normal by at most r_max / r_min^2, and the terms' gradients add up to 1.2 k.
  const double least = std::min({radii.x, radii.y, radii.z}) - relief;
  const double most = std::max({radii.x, radii.y, radii.z});
  return {radii, relief, 1.2 * relief * waves * most / (least * least),
          [this](const glm::dvec3& normal) { return height(normal); }};
}

glm::dvec3 SmoothWorld::colour(const glm::dvec3& normal) const {
  const double wide = std::sin(2.5 * normal.x + 4.0 * normal.z + 0.4) * std::cos(3.0 * normal.y);
  const double middling = std::sin(17.0 * normal.x) * std::cos(15.0 * normal.y + 0.8) + std::sin(13.0 * normal.z);
  const double narrow = std::sin(40.0 * normal.x) + std::sin(40.0 * normal.y + 1.0) + std::sin(40.0 * normal.z + 2.0);
  const double fine = spot.half > 0.0 ? inSpot(spot, normal) : 0.0;
  return {140.0 + 90.0 * wide + fine, 140.0 + 45.0 * middling + fine, 140.0 + 30.0 * narrow + fine};
}

void SmoothWorld::writeColours(const std::filesystem::path& file) const {
  write(file, globalGrid(columns, false), {GDT_Byte, 3, false},
        [this](const glm::dvec3& normal, int band) { return std::round(colour(normal)[band]); });
}

void SmoothWorld::writeSpot(const std::filesystem::path& file) const {
  const double pixel = 2.0 * spot.half / columns;
  const double inset = spot.half - 0.5 * pixel;
  write(file, {columns, columns, pixel, spot.longitude - inset, spot.latitude + inset}, {GDT_Byte, 3, false},
        [this](const glm::dvec3& normal, int band) { return std::round(colour(normal)[band]); });
}

void SmoothWorld::writeHeights(const std::filesystem::path& file) const {
  write(file, globalGrid(columns, nodeRegistered), {GDT_Float32, 1, nodeRegistered},
        [this](const glm::dvec3& normal, int) { return height(normal); });
}

}  // namespace meridian::globebrowsing::test
