#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <gdal_priv.h>

#include "host/api/time.h"

namespace meridian {

/// A WMTS of plain files, to be served by any server: a map of the whole globe for each of a row of days, each of a
/// colour of its own with a grain like a photograph's. The address of a tile is
/// days/{Time}/{TileMatrix}/{TileRow}/{TileCol}.jpg, the capabilities are wmts.xml.
struct TimedPyramid {
  static constexpr int tileSize = 256;
  static constexpr int grain = 8;
  /// Of every colour's blue; black is no part of any map.
  static constexpr int blue = 200;
  /// Colours; after these the first comes again.
  static constexpr int colours = 60;

  int days = 60;
  int levels = 3;

  static constexpr const char* layer = "Days";
  static std::array<int, 3> colourOf(int day) {
    return {40 + 20 * (day % colours % 10), 40 + 35 * (day % colours / 10), blue};
  }
  static Time timeOf(double day) {
    return Time::fromUtcInstant(Time::fromUtc("2004-01-01")->utcInstant() +
                                std::chrono::milliseconds(std::llround(day * 86'400'000.0)));
  }
  static std::string nameOf(int day) { return timeOf(day).utc().substr(0, 10); }

  /// The layer of such a service at an address, as an asset names it.
  static std::string filePath(const std::string& address) { return "WMTS:" + address + "/wmts.xml,layer=Days"; }

  void write(const std::filesystem::path& root, const std::string& address) const {
    std::filesystem::create_directories(root / "days");
    for (int day = 0; day < days; ++day) {
      const std::filesystem::path folder = root / "days" / nameOf(day);
      if (day < colours) {
        writeDay(folder, colourOf(day));
      } else {
        std::filesystem::create_directory_symlink(nameOf(day % colours), folder);
      }
    }
    std::ofstream(root / "wmts.xml") << capabilities(address);
  }

  /// A tile of one colour and the grain.
  static void writeTile(const std::filesystem::path& file, const std::array<int, 3>& colour) {
    GDALAllRegister();
    std::vector<std::uint8_t> pixels(std::size_t{3} * tileSize * tileSize);
    std::uint32_t random = 1;
    for (std::size_t i = 0; i < pixels.size() / 3; ++i) {
      random = random * 1664525U + 1013904223U;
      const int bump = static_cast<int>((random >> 16) % (2 * grain + 1)) - grain;
      for (std::size_t band = 0; band < 3; ++band) {
        pixels[band * pixels.size() / 3 + i] = static_cast<std::uint8_t>(std::clamp(colour[band] + bump, 0, 255));
      }
    }
    GDALDatasetUniquePtr tile(
        GetGDALDriverManager()->GetDriverByName("MEM")->Create("", tileSize, tileSize, 3, GDT_Byte, nullptr));
    if (tile->RasterIO(GF_Write, 0, 0, tileSize, tileSize, pixels.data(), tileSize, tileSize, GDT_Byte, 3, nullptr, 0,
                       0, 0, nullptr) != CE_None) {
      throw std::runtime_error(CPLGetLastErrorMsg());
    }
    GDALDatasetUniquePtr(GetGDALDriverManager()->GetDriverByName("JPEG")->CreateCopy(file.c_str(), tile.get(), FALSE,
                                                                                     nullptr, nullptr, nullptr));
  }

 private:
  [[nodiscard]] std::string capabilities(const std::string& address) const {
    std::string matrices;
    for (int level = 0; level < levels; ++level) {
      const std::string n = std::to_string(1 << level);
      // A pixel of level 0 is 180 / 256 degrees, and a scale denominator 0.28 mm a pixel.
      const double scale = 180.0 / tileSize / (1 << level) * 111319.49079327358 / 0.00028;
      matrices += "<TileMatrix><ows:Identifier>" + std::to_string(level) + "</ows:Identifier><ScaleDenominator>" +
                  std::to_string(scale) +
                  "</ScaleDenominator><TopLeftCorner>90 -180</TopLeftCorner><TileWidth>256</TileWidth><TileHeight>256"
                  "</TileHeight><MatrixWidth>" +
                  std::to_string(2 << level) + "</MatrixWidth><MatrixHeight>" + n + "</MatrixHeight></TileMatrix>";
    }
    return "<Capabilities xmlns='http://www.opengis.net/wmts/1.0' xmlns:ows='http://www.opengis.net/ows/1.1' "
           "version='1.0.0'><Contents><Layer><ows:Title>Days</ows:Title><ows:WGS84BoundingBox><ows:LowerCorner>-180 -90"
           "</ows:LowerCorner><ows:UpperCorner>180 90</ows:UpperCorner></ows:WGS84BoundingBox><ows:Identifier>" +
           std::string(layer) +
           "</ows:Identifier><Style isDefault='true'><ows:Identifier>default</ows:Identifier></Style><Format>image/jpeg"
           "</Format><Dimension><ows:Identifier>Time</ows:Identifier><Default>" +
           nameOf(days - 1) + "</Default><Value>" + nameOf(0) + "/" + nameOf(days - 1) + "/P1D</Value></Dimension>" +
           "<TileMatrixSetLink><TileMatrixSet>degrees</TileMatrixSet></TileMatrixSetLink><ResourceURL "
           "format='image/jpeg' resourceType='tile' template='" +
           address +
           "/days/{Time}/{TileMatrix}/{TileRow}/{TileCol}.jpg'/></Layer><TileMatrixSet><ows:Identifier>degrees"
           "</ows:Identifier><ows:SupportedCRS>urn:ogc:def:crs:EPSG::4326</ows:SupportedCRS>" +
           matrices + "</TileMatrixSet></Contents></Capabilities>";
  }

  void writeDay(const std::filesystem::path& folder, const std::array<int, 3>& colour) const {
    // One picture for the day; its tiles are links to it.
    const std::filesystem::path picture = folder / "tile.jpg";
    std::filesystem::create_directories(folder);
    writeTile(picture, colour);
    for (int level = 0; level < levels; ++level) {
      for (int row = 0; row < 1 << level; ++row) {
        const std::filesystem::path place = folder / std::to_string(level) / std::to_string(row);
        std::filesystem::create_directories(place);
        for (int column = 0; column < 2 << level; ++column) {
          std::filesystem::create_hard_link(picture, place / (std::to_string(column) + ".jpg"));
        }
      }
    }
  }
};

/// What a picture of such a globe shows. Of its pixels, rows of RGBA, those are looked at that lie within `radius` of
/// the middle.
struct TimedPicture {
  bool isBlank = false;  ///< something of it is no map
  bool isMixed = false;  ///< two days at once
  int colour = -1;       ///< of TimedPyramid's; -1 where it is none

  static TimedPicture look(const std::vector<std::uint8_t>& rgba, int width, int height, double radius) {
    TimedPicture seen;
    std::array<int, 2> least{255, 255};
    std::array<int, 2> most{0, 0};
    std::array<double, 2> sum{};
    int count = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const int dx = x - width / 2;
        const int dy = y - height / 2;
        if (dx * dx + dy * dy > radius * radius) {
          continue;
        }
        const std::uint8_t* p =
            &rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))];
        seen.isBlank = seen.isBlank || p[2] < TimedPyramid::blue - 50;
        for (std::size_t band = 0; band < 2; ++band) {
          least[band] = std::min<int>(least[band], p[band]);
          most[band] = std::max<int>(most[band], p[band]);
          sum[band] += p[band];
        }
        ++count;
      }
    }
    // JPEG makes a little more of the grain.
    constexpr int mostSpread = 2 * TimedPyramid::grain + 8;
    seen.isMixed = most[0] - least[0] > mostSpread || most[1] - least[1] > mostSpread;
    for (int colour = 0; colour < TimedPyramid::colours; ++colour) {
      const std::array<int, 3> c = TimedPyramid::colourOf(colour);
      if (std::abs(sum[0] / count - c[0]) < 8 && std::abs(sum[1] / count - c[1]) < 8) {
        seen.colour = colour;
      }
    }
    return seen;
  }
};

}  // namespace meridian
