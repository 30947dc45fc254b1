#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include <gdal_priv.h>
#include <gdal_utils.h>
#include <gtest/gtest.h>

#include "globebrowsing/source/raster_source.h"
#include "globebrowsing/tiling/geodetic_tiling.h"
#include "support/shared_data.h"

namespace meridian::globebrowsing::test {

inline constexpr double degree = std::numbers::pi / 180.0;

inline GeodeticTiling earth() {
  return GeodeticTiling(*Ellipsoid::fromRadii({6378137.0, 6378137.0, 6356752.314245}));
}

/// GDAL's own view of a file; its messages are of no interest here.
inline GDALDatasetUniquePtr openWithGdal(const std::string& path) {
  GDALAllRegister();
  return GDALDatasetUniquePtr(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
}

inline std::shared_ptr<RasterSource> open(const RasterDescription& description) {
  auto source = RasterSource::open(description);
  EXPECT_TRUE(source) << (source ? "" : source.error().message());
  return source ? *source : nullptr;
}

/// What a made raster is like.
struct Made {
  int width = 0;
  int height = 0;
  std::array<double, 6> transform{};
  GDALDataType type = GDT_Float64;
  int bands = 1;
  std::string crs{"EPSG:4326"};  ///< empty: none
  std::vector<std::string> options{};
};

/// A GeoTIFF in memory, removed with the object. Values come from value(band from 0, column, row).
class MadeRaster {
 public:
  MadeRaster(const Made& made, const std::function<double(int, int, int)>& value,
             const std::function<void(GDALDataset&)>& finish = {}) {
    GDALAllRegister();
    static int number = 0;
    path_ = "/vsimem/made" + std::to_string(++number) + ".tif";
    char** options = nullptr;
    for (const std::string& option : made.options) {
      options = CSLAddString(options, option.c_str());
    }
    GDALDatasetUniquePtr dataset(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(
        path_.c_str(), made.width, made.height, made.bands, made.type, options));
    CSLDestroy(options);
    if (made.transform != std::array<double, 6>{}) {
      std::array<double, 6> transform = made.transform;
      dataset->SetGeoTransform(transform.data());
    }
    if (!made.crs.empty()) {
      OGRSpatialReference crs;
      crs.SetFromUserInput(made.crs.c_str());
      dataset->SetSpatialRef(&crs);
    }
    std::vector<double> line(static_cast<std::size_t>(made.width));
    for (int band = 0; band < made.bands; ++band) {
      for (int row = 0; row < made.height; ++row) {
        for (int column = 0; column < made.width; ++column) {
          line[static_cast<std::size_t>(column)] = value(band, column, row);
        }
        EXPECT_EQ(CE_None, dataset->GetRasterBand(band + 1)->RasterIO(GF_Write, 0, row, made.width, 1, line.data(),
                                                                      made.width, 1, GDT_Float64, 0, 0, nullptr));
      }
    }
    if (finish) {
      finish(*dataset);
    }
  }
  ~MadeRaster() { VSIUnlink(path_.c_str()); }
  MadeRaster(const MadeRaster&) = delete;
  MadeRaster& operator=(const MadeRaster&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Geotransform of pixels of that size from the upper left corner on, in degrees.
inline std::array<double, 6> northUp(double west, double north, double pixel) {
  return {west, pixel, 0, north, 0, -pixel};
}

inline HeightPixels heights(const RasterSource& source, const Tiling& tiling, const TileIndex& index,
                            const TileLayout& layout = heightLayout) {
  auto pixels = resampleHeights(source, tiling, index, layout, {});
  EXPECT_TRUE(pixels) << (pixels ? "" : pixels.error().message());
  return pixels ? *pixels : HeightPixels{};
}

inline ColourPixels colours(const RasterSource& source, const Tiling& tiling, const TileIndex& index,
                            const TileLayout& layout = colourLayout) {
  auto pixels = resampleColours(source, tiling, index, layout, {});
  EXPECT_TRUE(pixels) << (pixels ? "" : pixels.error().message());
  return pixels ? *pixels : ColourPixels{};
}

/// The tile of that level that has the place, in degrees.
inline TileIndex tileAt(const Tiling& tiling, double latitude, double longitude, int level) {
  return tiling.locate(latitude * degree, longitude * degree, level).index;
}

/// What gdalwarp makes of band `band` on the tile's samples, without the border; the kernel's name as in its -r option.
inline std::vector<double> gdalwarp(const std::string& path, const Tiling& tiling, const TileIndex& index,
                                    const TileLayout& layout, const std::string& kernel, int band = 1) {
  GDALDatasetUniquePtr source = openWithGdal(path);
  const GeodeticPosition upper = tiling.geodetic(index, {0, 0});
  const GeodeticPosition lower = tiling.geodetic(index, {1, 1});
  const int n = layout.interior;
  const double outside = layout.registration == Registration::NodeRegistered ? 0.5 / (n - 1) : 0.0;
  const double width = (lower.longitude - upper.longitude) / degree;
  const double height = (upper.latitude - lower.latitude) / degree;
  std::unique_ptr<OGRSpatialReference> geographic(source->GetSpatialRef()->CloneGeogCS());
  char* wkt = nullptr;
  geographic->exportToWkt(&wkt);
  const auto text = [](double value) {
    std::array<char, 40> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "%.17g", value);
    return std::string(buffer.data());
  };
  const std::vector<std::string> words{"-of",
                                       "MEM",
                                       "-ot",
                                       "Float64",
                                       "-et",
                                       "0",
                                       "-r",
                                       kernel,
                                       "-t_srs",
                                       wkt,
                                       "-ovr",
                                       "NONE",
                                       "-dstnodata",
                                       "nan",
                                       "-te",
                                       text(upper.longitude / degree - outside * width),
                                       text(lower.latitude / degree - outside * height),
                                       text(lower.longitude / degree + outside * width),
                                       text(upper.latitude / degree + outside * height),
                                       "-ts",
                                       std::to_string(n),
                                       std::to_string(n)};
  CPLFree(wkt);
  char** arguments = nullptr;
  for (const std::string& word : words) {
    arguments = CSLAddString(arguments, word.c_str());
  }
  GDALWarpAppOptions* options = GDALWarpAppOptionsNew(arguments, nullptr);
  CSLDestroy(arguments);
  GDALDatasetH handle = source.get();
  GDALDatasetUniquePtr warped(GDALDataset::FromHandle(GDALWarp("", nullptr, 1, &handle, options, nullptr)));
  GDALWarpAppOptionsFree(options);
  std::vector<double> values(static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
  EXPECT_NE(warped, nullptr);
  if (warped) {
    EXPECT_EQ(CE_None, warped->GetRasterBand(band)->RasterIO(GF_Read, 0, 0, n, n, values.data(), n, n, GDT_Float64, 0,
                                                             0, nullptr));
  }
  return values;
}

/// Of sample (column, row) without the border.
inline std::size_t at(const TileLayout& layout, int column, int row) {
  return static_cast<std::size_t>(row + layout.border) * static_cast<std::size_t>(layout.size()) +
         static_cast<std::size_t>(column + layout.border);
}

using ::meridian::test::sharedData;

inline const std::string etopo5 = "/usr/share/ferret-vis/data/etopo5.cdf";
inline const std::string blueMarble = "/usr/share/marble/data/maps/earth/bluemarble/bluemarble.jpg";

}  // namespace meridian::globebrowsing::test

/// Leaves a test out, loudly, when its real data are not on this machine.
#define MERIDIAN_NEEDS(path)                                                                         \
  if (!std::filesystem::exists(path)) {                                                              \
    GTEST_SKIP() << "NOT TESTED: no " << (path) << "; install the Debian packages of data/README.md" \
                 << " or set MERIDIAN_SHARED_DATA";                                                  \
  }
