#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace meridian::globebrowsing {

/// One level of a tile pyramid, as WMTS means it (OGC 07-057r7, section 6.1): tiles of equal size from a corner. Rows
/// count from the north here, whatever the service says.
struct TileMatrix {
  std::string identifier;  ///< the service's name for it, for addresses and messages
  int tileWidth = 256;     ///< pixels
  int tileHeight = 256;    ///< pixels
  double left = 0.0;       ///< of the outer corner of tile (0, 0), in units of the CRS, easting (longitude) first
  double top = 0.0;
  double pixelWidth = 0.0;  ///< units of the CRS; positive
  double pixelHeight = 0.0;
  // What the service has, both ends included.
  std::int64_t firstColumn = 0;
  std::int64_t lastColumn = 0;
  std::int64_t firstRow = 0;
  std::int64_t lastRow = 0;
};

/// A tile of a service.
struct TileAddress {
  std::size_t matrix = 0;   ///< its place in TileService::matrices
  std::int64_t column = 0;  ///< eastward
  std::int64_t row = 0;     ///< southward

  auto operator<=>(const TileAddress&) const = default;
};

/// How the pixels of a service's tiles become colours or metres.
enum class TileEncoding : std::uint8_t {
  Image,       ///< colours as they are; heights: band 1 by scale and offset
  MapboxRgb,   ///< -10000 + (R * 65536 + G * 256 + B) * 0.1 metres
  Terrarium,   ///< R * 256 + G + B / 256 - 32768 metres
  PackedFloat  ///< RGBA bytes are those of a big-endian float, in metres (MMGIS)
};

/// A service that gives tiles by address: WMS, WMTS, TMS, XYZ, ArcGIS and GDAL's descriptions of them all end in this.
/// A WMS without tiles of its own is asked for those of a pyramid that we lay out.
struct TileService {
  std::string where;  ///< where it was described, for errors: an asset's place, a file, a URL
  std::string name;   ///< for people
  /// What PROJ understands ("EPSG:3857", WKT); empty: longitude and latitude in degrees on the globe's own body.
  std::string crs;
  std::vector<TileMatrix> matrices;  ///< finest first
  /// The extent of the data in the units of the CRS; tiles that do not meet it are never asked for.
  double west = 0.0;
  double south = 0.0;
  double east = 0.0;
  double north = 0.0;
  /// The address of a tile. Safe from any thread.
  std::function<std::string(const TileAddress&)> url;
  /// Of a tile as stored values, for heights, where `url` gives a picture made from them; empty: `url`.
  std::function<std::string(const TileAddress&)> heightUrl{};
  std::vector<std::string> headers{};   ///< to be sent along
  std::vector<int> emptyStatuses{404};  ///< that mean "nothing there"
  bool isExceptionEmpty = false;        ///< an error document with status 200 also means "nothing there"
  TileEncoding encoding = TileEncoding::Image;
  int bands = 0;                         ///< expected in a decoded tile; 0: whatever comes
  std::optional<double> noData{};        ///< of every band
  bool isNoDataTransparent = false;      ///< a pixel whose bands are all noData gets alpha 0
  std::optional<double> heightScale{};   ///< metres for one unit of a stored height
  std::optional<double> heightOffset{};  ///< metres
  std::string attribution{};
  /// The tiles' size is what the layer's Tiles.PixelSize says, or a guess: nothing else tells it (URL templates).
  bool isSizeGiven = false;
};

}  // namespace meridian::globebrowsing
