#include "smooth_world.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include <gdal_priv.h>

namespace meridian::globebrowsing::test {

namespace {

struct Layout {
  GDALDataType type = GDT_Byte;
  int bands = 1;
  bool nodes = false;
};

void write(const std::filesystem::path& file, int columns, const Layout& layout,
           const std::function<double(const glm::dvec3&, int)>& value) {
  GDALAllRegister();
  const int width = layout.nodes ? columns + 1 : columns;
  const int height = layout.nodes ? columns / 2 + 1 : columns / 2;
  const double pixel = 360.0 / columns;
  const double first = layout.nodes ? 0.0 : 0.5;
  GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
      file.c_str(), width, height, layout.bands, layout.type, nullptr));
  if (!dataset) {
    throw std::runtime_error(file.string() + ": GDAL cannot create it");
  }
  // GDAL's transform is of the pixels' corners, for node-registered rasters too.
  std::array<double, 6> transform{-180.0 + (first - 0.5) * pixel, pixel, 0.0,
                                  90.0 - (first - 0.5) * pixel,   0.0,   -pixel};
  dataset->SetGeoTransform(transform.data());
  if (layout.nodes) {
    dataset->SetMetadataItem("AREA_OR_POINT", "Point");
  }
  OGRSpatialReference crs;
  crs.SetFromUserInput("EPSG:4326");
  dataset->SetSpatialRef(&crs);
  std::vector<double> line(static_cast<std::size_t>(width));
  for (int band = 0; band < layout.bands; ++band) {
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        line[static_cast<std::size_t>(column)] =
            value(normalAt(90.0 - (row + first) * pixel, -180.0 + (column + first) * pixel), band);
      }
      if (dataset->GetRasterBand(band + 1)->RasterIO(GF_Write, 0, row, width, 1, line.data(), width, 1, GDT_Float64, 0,
                                                     0, nullptr) != CE_None) {
        throw std::runtime_error(file.string() + ": GDAL cannot write it");
      }
    }
  }
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

glm::dvec3 SmoothWorld::colour(const glm::dvec3& normal) {
  const double wide = std::sin(2.5 * normal.x + 4.0 * normal.z + 0.4) * std::cos(3.0 * normal.y);
  const double middling = std::sin(17.0 * normal.x) * std::cos(15.0 * normal.y + 0.8) + std::sin(13.0 * normal.z);
  const double narrow = std::sin(40.0 * normal.x) + std::sin(40.0 * normal.y + 1.0) + std::sin(40.0 * normal.z + 2.0);
  return {140.0 + 90.0 * wide, 140.0 + 45.0 * middling, 140.0 + 30.0 * narrow};
}

void SmoothWorld::writeColours(const std::filesystem::path& file) const {
  write(file, columns, {GDT_Byte, 3, false},
        [](const glm::dvec3& normal, int band) { return std::round(colour(normal)[band]); });
}

void SmoothWorld::writeHeights(const std::filesystem::path& file) const {
  write(file, columns, {GDT_Float32, 1, nodeRegistered},
        [this](const glm::dvec3& normal, int) { return height(normal); });
}

}  // namespace meridian::globebrowsing::test
