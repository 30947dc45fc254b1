#include "globebrowsing/source/url_template.h"

#include <algorithm>
#include <cmath>

#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/tile_pyramid.h"
#include "globebrowsing/source/tile_url.h"

namespace meridian::globebrowsing {

namespace {

/// {switch:a,b,c} and {a-c} become {s}, and say what that is.
std::string withServers(std::string address, std::vector<std::string>& servers) {
  for (std::size_t open = address.find('{'); open != std::string::npos; open = address.find('{', open + 1)) {
    const std::size_t close = address.find('}', open);
    if (close == std::string::npos) {
      break;
    }
    const std::string word = address.substr(open + 1, close - open - 1);
    if (lowerCase(word).starts_with("switch:")) {
      servers = split(word.substr(7), ",");
    } else if (word.size() == 3 && word[1] == '-' && word[0] <= word[2] && word[0] >= '0') {
      servers.clear();
      for (char c = word[0]; c <= word[2]; ++c) {
        servers.emplace_back(1, c);
      }
    } else {
      continue;
    }
    address.replace(open, close - open + 1, "{s}");
  }
  return address;
}

std::vector<TileUrl::Piece> box() {
  const TileUrl::Piece comma{UrlPart::Literal, ","};
  return {{UrlPart::West}, comma, {UrlPart::South}, comma, {UrlPart::East}, comma, {UrlPart::North}};
}

TileUrl cutTemplate(const std::string& address, bool countsFromSouth) {
  const UrlPart row = countsFromSouth ? UrlPart::RowFromSouth : UrlPart::Row;
  const UrlPart otherRow = countsFromSouth ? UrlPart::Row : UrlPart::RowFromSouth;
  return TileUrl::cut(address, {{"{z}", {{UrlPart::Matrix}}},
                                {"{zoom}", {{UrlPart::Matrix}}},
                                {"{x}", {{UrlPart::Column}}},
                                {"{y}", {{row}}},
                                {"{-y}", {{otherRow}}},
                                {"{reverseY}", {{otherRow}}},
                                {"{q}", {{UrlPart::QuadKey}}},
                                {"{quadkey}", {{UrlPart::QuadKey}}},
                                {"{s}", {{UrlPart::Server}}},
                                {"{r}", {}},
                                {"{ratio}", {}},
                                {"{bbox}", box()},
                                {"{bbox-epsg-3857}", box()},
                                {"{bbox-epsg-4326}", box()},
                                {"{width}", {{UrlPart::Width}}},
                                {"{height}", {{UrlPart::Height}}}});
}

bool namesTile(const TileUrl& url) {
  const bool hasRow = url.has(UrlPart::Row) || url.has(UrlPart::RowFromSouth);
  return (url.has(UrlPart::Matrix) && url.has(UrlPart::Column) && hasRow) || url.has(UrlPart::QuadKey) ||
         url.has(UrlPart::West);
}

/// "@2x" before the extension: web maps' way of naming tiles for dense screens, of 512 pixels.
bool isForDenseScreens(const std::string& address) {
  const std::string path = lowerCase(withoutQuery(address));
  const std::size_t at = path.rfind("@2x");
  return at != std::string::npos && path.find('/', at) == std::string::npos &&
         (at + 3 == path.size() || path[at + 3] == '.');
}

/// Level 0: one tile, or two beside each other.
struct Top {
  MapCrs crs;
  Extent world;
  int columns = 1;
};

/// Half a side of the squares that maps of the poles are cut from (those of NASA GIBS), in metres.
constexpr double polarHalfWidth = 4194304.0;

Result<Extent> squareOf(const UrlTemplate& description, const std::string& projection, const std::string& where) {
  const bool isPolar = projection == "EPSG:3031" || projection == "EPSG:3413";
  if (!description.square && !isPolar) {
    return failure("nobody says where the tiles of " + projection + " lie", where,
                   "give Tiles.Square = { west, south, east, north } of level 0, in units of the projection");
  }
  const Extent square =
      description.square.value_or(Extent{-polarHalfWidth, -polarHalfWidth, polarHalfWidth, polarHalfWidth});
  const double width = square.east - square.west;
  if (!(width > 0.0) || !(std::abs(square.north - square.south - width) <= 1e-9 * width)) {
    return failure("the square of level 0 is empty, turned around or no square", where,
                   "give Tiles.Square = { west, south, east, north }, all sides of one length");
  }
  return square;
}

Result<Top> topOf(const UrlTemplate& description, const std::string& where) {
  const bool asksDegrees = containsIgnoringCase(description.address, "{bbox-epsg-4326}");
  const bool asksMetres = containsIgnoringCase(description.address, "{bbox-epsg-3857}");
  const std::string projection =
      canonicalCrsName(description.projection.value_or(asksDegrees ? "EPSG:4326" : "EPSG:3857"));
  const bool isDegrees = projection == "EPSG:4326";
  const bool isMercator = projection == "EPSG:3857";
  if ((asksDegrees && !isDegrees) || (asksMetres && !isMercator)) {
    return failure("the address asks for another projection than that of the tiles", where,
                   "write {bbox} into it, or give the projection that its {bbox-epsg-...} names");
  }
  Result<MapCrs> crs = MapCrs::of(isDegrees ? "CRS:84" : projection, where);
  if (!crs) {
    return tl::make_unexpected(std::move(crs.error()));
  }
  if (isDegrees || isMercator) {
    if (description.square) {
      return failure("the square of " + projection + " is known", where, "leave Tiles.Square out");
    }
    const Extent world = *crs->fromDegrees({-180.0, -90.0, 180.0, 90.0});
    return Top{*std::move(crs), world, isDegrees ? 2 : 1};
  }
  return squareOf(description, projection, where).map([&](const Extent& square) {
    return Top{*std::move(crs), square, 1};
  });
}

/// Of the data, in units of the projection.
Result<Extent> extentOf(const UrlTemplate& description, const Top& top, const std::string& where) {
  if (!description.extentDegrees) {
    return top.world;
  }
  const std::optional<Extent> extent = top.crs.fromDegrees(*description.extentDegrees);
  if (!extent) {
    return failure("the extent is no place of the map", where,
                   "give west, south, east and north in degrees, within -180, -90, 180, 90");
  }
  return *extent;
}

}  // namespace

UrlTemplate templateOf(const std::string& address, const std::string& where, const TileSettings& settings) {
  UrlTemplate description;
  description.address = address;
  description.where = where;
  description.projection = settings.projection;
  description.square = settings.square;
  description.countsFromSouth = settings.countsFromSouth.value_or(false);
  description.tileSize = settings.pixelSize.value_or(isForDenseScreens(address) ? 512 : description.tileSize);
  description.firstLevel = settings.firstLevel.value_or(description.firstLevel);
  description.lastLevel = settings.lastLevel.value_or(description.lastLevel);
  description.extentDegrees = settings.extentDegrees;
  return description;
}

bool isUrlTemplate(const std::string& text) {
  return text.find("://") != std::string::npos && text.find('{') != std::string::npos &&
         text.find("${") == std::string::npos && namesTile(cutTemplate(text, false));
}

Result<TileService> serviceOf(const UrlTemplate& description) {
  TileService service;
  service.where = description.where.empty() ? description.address : description.where;
  std::vector<std::string> servers = description.servers;
  TileUrl url = cutTemplate(withServers(repairedUrl(description.address), servers), description.countsFromSouth);
  if (!namesTile(url)) {
    return failure("the address does not say which tile", service.where, "put {z}, {x} and {y} into it, or {q}");
  }
  if (description.firstLevel < 0 || description.lastLevel > 30 || description.firstLevel > description.lastLevel ||
      description.tileSize < 1 || description.tileSize > 8192) {
    return failure("the levels or the size of the tiles make no sense", service.where,
                   "give levels of 0 to 30, and tiles of 1 to 8192 pixels");
  }
  const Result<Top> top = topOf(description, service.where);
  if (!top) {
    return tl::make_unexpected(top.error());
  }
  const Extent& world = top->world;
  service.name = description.name;
  service.crs = top->crs.definition();
  service.attribution = description.attribution;
  service.isSizeGiven = true;
  std::vector<TileMatrix> matrices;
  std::vector<std::int64_t> rowCounts;
  for (int level = description.lastLevel; level >= description.firstLevel; --level) {
    TileMatrix matrix;
    matrix.identifier = std::to_string(level);
    matrix.tileWidth = description.tileSize;
    matrix.tileHeight = description.tileSize;
    matrix.left = world.west;
    matrix.top = world.north;
    matrix.lastRow = (std::int64_t{1} << level) - 1;
    matrix.lastColumn = top->columns * (matrix.lastRow + 1) - 1;
    matrix.pixelWidth = (world.north - world.south) / static_cast<double>(matrix.lastRow + 1) / description.tileSize;
    matrix.pixelHeight = matrix.pixelWidth;
    matrices.push_back(matrix);
  }
  const Result<Extent> extent = extentOf(description, *top, service.where);
  if (!extent) {
    return tl::make_unexpected(extent.error());
  }
  if (auto set = setMatrices(service, std::move(matrices), *extent); !set) {
    return tl::make_unexpected(std::move(set.error()));
  }
  for (const TileMatrix& matrix : service.matrices) {
    rowCounts.push_back(std::llround((world.north - world.south) / (matrix.tileHeight * matrix.pixelHeight)));
  }
  url.setRowCounts(std::move(rowCounts));
  url.setServers(std::move(servers));
  service.url = TileUrl::bind(std::move(url), service.matrices);
  return service;
}

}  // namespace meridian::globebrowsing
