#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <unistd.h>

#include "support/timed_pyramid.h"

namespace meridian {

/// JPEG tiles over the whole globe, 256 x 256 pixels and all alike, at ADDRESS/LEVEL/COLUMN/ROW.jpg.
struct JpegPyramid {
  static constexpr int tileSize = TimedPyramid::tileSize;
  static constexpr int finest = 6;  ///< level; coarser ones are asked for, too
  static constexpr int columns = 2 << finest;
  static constexpr int rows = 1 << finest;

  /// The bytes of a tile.
  static std::string tile() {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("meridian-tile-" + std::to_string(::getpid()) + ".jpg");
    TimedPyramid::writeTile(file, {90, 120, 60});
    std::ifstream stream(file, std::ios::binary);
    std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    std::filesystem::remove(file);
    return bytes;
  }

  /// The finest level below a folder.
  static void write(const std::filesystem::path& root) {
    const std::filesystem::path first = root / "tile.jpg";
    std::ofstream(first, std::ios::binary) << tile();
    for (int column = 0; column < columns; ++column) {
      const std::filesystem::path folder = root / std::to_string(finest) / std::to_string(column);
      std::filesystem::create_directories(folder);
      for (int row = 0; row < rows; ++row) {
        std::filesystem::create_hard_link(first, folder / (std::to_string(row) + ".jpg"));
      }
    }
  }

  /// Of the finest level's tiles, row by row and again from the beginning.
  static std::string url(const std::string& address, int number) {
    return address + "/" + std::to_string(finest) + "/" + std::to_string(number % columns) + "/" +
           std::to_string(number / columns % rows) + ".jpg";
  }

  /// A <GDAL_WMS>; `settings` are further elements.
  static std::string document(const std::string& address, const std::string& settings = {}) {
    return "<GDAL_WMS><Service name=\"TMS\"><ServerUrl>" + address +
           "/${z}/${x}/${y}.jpg</ServerUrl></Service><DataWindow><UpperLeftX>-180</UpperLeftX><UpperLeftY>90"
           "</UpperLeftY><LowerRightX>180</LowerRightX><LowerRightY>-90</LowerRightY><TileLevel>" +
           std::to_string(finest) +
           "</TileLevel><TileCountX>2</TileCountX><TileCountY>1</TileCountY><YOrigin>top</YOrigin></DataWindow>"
           "<Projection>EPSG:4326</Projection><BlockSizeX>256</BlockSizeX><BlockSizeY>256</BlockSizeY>"
           "<BandsCount>3</BandsCount>" +
           settings + "</GDAL_WMS>";
  }
};

}  // namespace meridian
