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

Result<bool> isGeodeticOf(const UrlTemplate& description, const std::string& where) {
  const bool asksDegrees = containsIgnoringCase(description.address, "{bbox-epsg-4326}");
  const bool asksMetres = containsIgnoringCase(description.address, "{bbox-epsg-3857}");
  const bool isGeodetic = description.isGeodetic.value_or(asksDegrees);
  if (isGeodetic ? asksMetres : asksDegrees) {
    return failure("the address asks for another projection than that of the tiles", where,
                   "write {bbox} into it, or give the projection that its {bbox-epsg-...} names");
  }
  return isGeodetic;
}

}  // namespace

UrlTemplate templateOf(const std::string& address, const std::string& where, const TileSettings& settings) {
  UrlTemplate description;
  description.address = address;
  description.where = where;
  description.isGeodetic = settings.isGeodetic;
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
  const Result<bool> isGeodetic = isGeodeticOf(description, service.where);
  if (!isGeodetic) {
    return tl::make_unexpected(isGeodetic.error());
  }
  const MapCrs crs = *MapCrs::of(*isGeodetic ? "CRS:84" : "EPSG:3857", service.where);  // both are known
  const Extent world = *crs.fromDegrees({-180.0, -90.0, 180.0, 90.0});
  service.name = description.name;
  service.crs = crs.definition();
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
    matrix.lastColumn = (*isGeodetic ? 2 : 1) * (matrix.lastRow + 1) - 1;
    matrix.pixelWidth = (world.north - world.south) / static_cast<double>(matrix.lastRow + 1) / description.tileSize;
    matrix.pixelHeight = matrix.pixelWidth;
    matrices.push_back(matrix);
  }
  const auto extent = crs.fromDegrees(description.extentDegrees.value_or(Extent{-180.0, -90.0, 180.0, 90.0}));
  if (!extent) {
    return failure("the extent is no place of the map", service.where,
                   "give west, south, east and north in degrees, within -180, -90, 180, 90");
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
