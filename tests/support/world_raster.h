#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gdal_priv.h>

namespace meridian {

/// A smooth picture of the whole globe: what a server shows can be compared with what the file shows, however each
/// resamples. Level 1 of the pyramid has its pixels.
struct WorldRaster {
  static constexpr int columns = 1024;
  static constexpr int rows = 512;

  static std::uint8_t value(int band, double longitude, double latitude) {
    const double x = std::cos(longitude) * std::cos(latitude);
    const double y = std::sin(longitude) * std::cos(latitude);
    const std::array<double, 3> v{x + y * std::sin(latitude), std::sin(latitude) + x * y, y - x * x};
    return static_cast<std::uint8_t>(std::lround(128.0 + 60.0 * v[static_cast<std::size_t>(band)]));
  }

  /// A GeoTIFF in degrees.
  static void write(const std::filesystem::path& path) {
    GDALAllRegister();
    GDALDatasetUniquePtr dataset(
        GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), columns, rows, 3, GDT_Byte, nullptr));
    std::array<double, 6> transform{-180.0, 360.0 / columns, 0.0, 90.0, 0.0, -180.0 / rows};
    dataset->SetGeoTransform(transform.data());
    OGRSpatialReference crs;
    crs.SetWellKnownGeogCS("WGS84");
    dataset->SetSpatialRef(&crs);
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(columns) * rows);
    for (int band = 0; band < 3; ++band) {
      for (int i = 0; i < columns * rows; ++i) {
        const double longitude = ((i % columns + 0.5) / columns * 2.0 - 1.0) * std::numbers::pi;
        const double latitude = (0.5 - (i / columns + 0.5) / rows) * std::numbers::pi;
        pixels[static_cast<std::size_t>(i)] = value(band, longitude, latitude);
      }
      check(dataset->GetRasterBand(band + 1)->RasterIO(GF_Write, 0, 0, columns, rows, pixels.data(), columns, rows,
                                                       GDT_Byte, 0, 0, nullptr));
    }
  }

  /// FOLDER/LEVEL/COLUMN/ROW.png of the raster, 256 pixels each, rows from the north: levels 0 (2 tiles) and 1 (8).
  static void cut(const std::filesystem::path& raster, const std::filesystem::path& folder) {
    GDALDatasetUniquePtr whole(GDALDataset::Open(raster.c_str()));
    GDALRasterIOExtraArg resampling;
    INIT_RASTERIO_EXTRA_ARG(resampling);
    resampling.eResampleAlg = GRIORA_Average;
    for (int level = 0; level < 2; ++level) {
      const int side = 512 >> level;
      for (int column = 0; column < columns / side; ++column) {
        const std::filesystem::path place = folder / std::to_string(level) / std::to_string(column);
        for (int row = 0; row < rows / side; ++row) {
          std::vector<std::uint8_t> pixels(std::size_t{3} * 256 * 256);
          check(whole->RasterIO(GF_Read, column * side, row * side, side, side, pixels.data(), 256, 256, GDT_Byte, 3,
                                nullptr, 0, 0, 0, &resampling));
          writePng(place / (std::to_string(row) + ".png"), pixels);
        }
      }
    }
  }

  /// The tiles of levels 0 to 2 in EPSG:3857, rows from the north, each written to name(level, column, row).
  static void cutMercator(const std::function<std::filesystem::path(int, int, int)>& name) {
    constexpr int side = 256;
    for (int level = 0; level < 3; ++level) {
      for (int tile = 0; tile < 1 << (2 * level); ++tile) {
        const int column = tile % (1 << level);
        const int row = tile >> level;
        std::vector<std::uint8_t> pixels;
        for (int band = 0; band < 3; ++band) {
          for (int i = 0; i < side * side; ++i) {
            const double x = std::ldexp(column + (i % side + 0.5) / side, -level);
            const double y = std::ldexp(row + (i / side + 0.5) / side, -level);
            pixels.push_back(value(band, (2.0 * x - 1.0) * std::numbers::pi,
                                   std::atan(std::sinh((1.0 - 2.0 * y) * std::numbers::pi))));
          }
        }
        writePng(name(level, column, row), pixels);
      }
    }
  }

  /// The description of such a pyramid at an address.
  static std::string document(const std::string& address) {
    return "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>" + address +
           "/${z}/${x}/${y}.png</ServerUrl></Service><DataWindow><UpperLeftX>-180</UpperLeftX><UpperLeftY>90"
           "</UpperLeftY><LowerRightX>180</LowerRightX><LowerRightY>-90</LowerRightY><TileLevel>1</TileLevel>"
           "<TileCountX>2</TileCountX><TileCountY>1</TileCountY><YOrigin>top</YOrigin></DataWindow>"
           "<Projection>EPSG:4326</Projection><BlockSizeX>256</BlockSizeX><BlockSizeY>256</BlockSizeY>"
           "<BandsCount>3</BandsCount></GDAL_WMS>";
  }

 private:
  /// Three bands of 256 x 256, one after the other.
  static void writePng(const std::filesystem::path& path, std::vector<std::uint8_t>& pixels) {
    GDALAllRegister();
    std::filesystem::create_directories(path.parent_path());
    GDALDatasetUniquePtr tile(
        GetGDALDriverManager()->GetDriverByName("MEM")->Create("", 256, 256, 3, GDT_Byte, nullptr));
    check(tile->RasterIO(GF_Write, 0, 0, 256, 256, pixels.data(), 256, 256, GDT_Byte, 3, nullptr, 0, 0, 0, nullptr));
    GDALDatasetUniquePtr(GetGDALDriverManager()->GetDriverByName("PNG")->CreateCopy(path.c_str(), tile.get(), FALSE,
                                                                                    nullptr, nullptr, nullptr));
  }
  static void check(CPLErr code) {
    if (code != CE_None) {
      throw std::runtime_error(CPLGetLastErrorMsg());
    }
  }
};

}  // namespace meridian
