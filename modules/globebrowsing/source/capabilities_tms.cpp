#include <algorithm>
#include <cmath>

#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

void collect(const pugi::xml_node& node, std::string_view name, std::vector<pugi::xml_node>& found) {
  for (const pugi::xml_node& entry : node.children()) {
    if (isNamed(entry, name)) {
      found.push_back(entry);
    }
    collect(entry, name, found);
  }
}

std::optional<Extent> readBox(const pugi::xml_node& box) {
  const auto west = number(attribute(box, "minx"));
  const auto south = number(attribute(box, "miny"));
  const auto east = number(attribute(box, "maxx"));
  const auto north = number(attribute(box, "maxy"));
  if (!west || !south || !east || !north || !(*west < *east) || !(*south < *north)) {
    return std::nullopt;
  }
  return Extent{*west, *south, *east, *north};
}

/// The place and size of a TileMap's tiles.
struct TileMapPlace {
  std::string crsName;
  MapCrs crs;
  Extent box{};  ///< in units of the CRS
  double originX = 0.0;
  double originY = 0.0;
  bool countsFromNorth = false;
  int tileWidth = 256;
  int tileHeight = 256;
};

Result<TileMapPlace> readPlace(const XmlDocument& document, const std::string& profile) {
  const pugi::xml_node root = document.root();
  const bool isMercator = profile.ends_with("mercator");
  const bool isGeodetic = profile.ends_with("geodetic");
  TileMapPlace place;
  place.crsName = text(root, "SRS");
  if (place.crsName.empty()) {
    place.crsName = isMercator ? "EPSG:3857" : "EPSG:4326";
  }
  auto crs = MapCrs::of(place.crsName, document.placeOf(root));
  if (!crs) {
    return tl::make_unexpected(std::move(crs.error()));
  }
  place.crs = std::move(*crs);
  const std::optional<Extent> box = readBox(child(root, "BoundingBox"));
  const Extent world = place.crs.fromDegrees({-180.0, -90.0, 180.0, 90.0}).value_or(Extent{0.0, 0.0, 1.0, 1.0});
  place.box = box.value_or(world);
  const pugi::xml_node origin = child(root, "Origin");
  place.originX = number(attribute(origin, "x")).value_or(place.box.west);
  place.originY = number(attribute(origin, "y")).value_or(place.box.south);
  // gdal2tiles writes degrees into the box and the origin of a map in metres.
  const bool hasDegrees = place.crs.isWebMercator() && box &&
                          std::max(std::abs(box->west), std::abs(box->east)) <= 360.0 &&
                          std::max(std::abs(box->south), std::abs(box->north)) <= 90.0;
  if (hasDegrees) {
    place.box = place.crs.fromDegrees(*box).value_or(world);
  }
  if ((isMercator && place.crs.isWebMercator()) || hasDegrees) {
    place.originX = -webMercatorHalfWidth;
    place.originY = -webMercatorHalfWidth;
  } else if (isGeodetic && place.crs.isGeographic()) {
    place.originX = -180.0;
    place.originY = -90.0;
  } else if (std::abs(place.originY - place.box.north) < std::abs(place.originY - place.box.south)) {
    place.countsFromNorth = true;  // what gives an origin in the north counts from there, whatever TMS says
  }
  const pugi::xml_node format = child(root, "TileFormat");
  place.tileWidth = static_cast<int>(std::clamp(integer(attribute(format, "width")).value_or(256), 1LL, 8192LL));
  place.tileHeight = static_cast<int>(std::clamp(integer(attribute(format, "height")).value_or(256), 1LL, 8192LL));
  return place;
}

std::optional<TileMatrix> readMatrix(const XmlDocument& document, const pugi::xml_node& node,
                                     const TileMapPlace& place) {
  const auto pixel = number(attribute(node, "units-per-pixel"));
  if (!pixel || !(*pixel > 1e-12)) {
    return std::nullopt;
  }
  TileMatrix matrix;
  std::string href = attribute(node, "href");
  href = href.empty() ? attribute(node, "order") : href;
  while (href.ends_with('/')) {
    href.pop_back();
  }
  matrix.identifier = resolvedUrl(document.where(), repairedUrl(href));
  matrix.tileWidth = place.tileWidth;
  matrix.tileHeight = place.tileHeight;
  matrix.pixelWidth = *pixel;
  matrix.pixelHeight = *pixel;
  matrix.left = place.originX;
  const double height = matrix.tileHeight * *pixel;
  constexpr double mostRows = 1e12;
  const double rows = std::clamp(std::ceil((place.box.north - place.originY) / height - 1e-6), 1.0, mostRows);
  const auto rowCount = static_cast<std::int64_t>(rows);
  matrix.top = place.countsFromNorth ? place.originY : place.originY + static_cast<double>(rowCount) * height;
  constexpr std::int64_t most = std::int64_t{1} << 40;
  matrix.firstColumn = integer(attribute(node, "mincol")).value_or(0);
  matrix.lastColumn = integer(attribute(node, "maxcol")).value_or(most);
  const std::int64_t firstRow = integer(attribute(node, "minrow")).value_or(0);
  const std::int64_t lastRow = integer(attribute(node, "maxrow")).value_or(most);
  matrix.firstRow = place.countsFromNorth ? firstRow : rowCount - 1 - std::min(lastRow, rowCount - 1);
  matrix.lastRow = place.countsFromNorth ? lastRow : rowCount - 1 - firstRow;
  return matrix;
}

Result<Capabilities> readTileMap(const XmlDocument& document, Capabilities result) {
  const pugi::xml_node root = document.root();
  result.title = text(root, "Title");
  result.abstract = text(root, "Abstract");
  result.attribution = text(root, "Attribution/Title");
  std::vector<pugi::xml_node> sets;
  collect(root, "TileSet", sets);
  const std::string profile = sets.empty() ? std::string() : lowerCase(attribute(sets.front().parent(), "profile"));
  auto place = readPlace(document, profile);
  if (!place) {
    return tl::make_unexpected(std::move(place.error()));
  }
  MatrixSet matrices{profile.empty() ? "tiles" : profile, place->crsName};
  if (!place->countsFromNorth) {
    matrices.southOrigin = place->originY;
  }
  for (const pugi::xml_node& node : sets) {
    if (auto matrix = readMatrix(document, node, *place)) {
      matrices.matrices.push_back(std::move(*matrix));
    } else {
      result.problems.push_back(document.placeOf(node) + ": a TileSet without units-per-pixel");
    }
  }
  CapabilitiesLayer layer;
  layer.title = result.title;
  layer.abstract = result.abstract;
  layer.identifier = result.title.empty() ? "tiles" : result.title;
  layer.extent = extentOfBox(place->crs, place->box);
  const std::string extension = attribute(child(root, "TileFormat"), "extension");
  const std::string mime = attribute(child(root, "TileFormat"), "mime-type");
  layer.formats.push_back(mime.empty() ? extension : mime);
  const std::string row = place->countsFromNorth ? "{TileRow}" : "{TileRowFromSouth}";
  layer.addresses.push_back(
      {layer.formats.front(), "{TileSet}/{TileCol}/" + row + (extension.empty() ? "" : "." + extension)});
  layer.matrixSets.push_back({0});
  if (matrices.matrices.empty()) {
    layer.obstacle = "it has no tile sets";
  } else if (!formatRank(layer.formats.front())) {
    layer.obstacle = "its tiles are '" + layer.formats.front() + "', no images that can be read here";
  }
  result.matrixSets.push_back(std::move(matrices));
  result.layers.push_back(std::move(layer));
  return result;
}

/// A TileMapService names TileMaps, and a Services document names TileMapServices.
Result<Capabilities> readList(const XmlDocument& document, Capabilities result) {
  const pugi::xml_node root = document.root();
  result.title = text(root, "Title");
  result.abstract = text(root, "Abstract");
  std::vector<pugi::xml_node> entries;
  collect(root, isNamed(root, "Services") ? "TileMapService" : "TileMap", entries);
  for (const pugi::xml_node& entry : entries) {
    CapabilitiesLayer layer;
    layer.title = attribute(entry, "title");
    layer.document = resolvedUrl(document.where(), repairedUrl(attribute(entry, "href")));
    layer.obstacle = "it is described by a document of its own, " + layer.document;
    if (const std::string srs = attribute(entry, "srs"); !srs.empty()) {
      layer.crs = CrsNames({srs});
    }
    result.layers.push_back(std::move(layer));
  }
  if (result.layers.empty()) {
    return failure("the service has no layers", document.placeOf(root));
  }
  return result;
}

}  // namespace

Result<Capabilities> readTmsCapabilities(const XmlDocument& document) {
  const pugi::xml_node root = document.root();
  Capabilities result;
  result.kind = CapabilitiesKind::Tms;
  result.version = attribute(root, "version").empty() ? "1.0.0" : attribute(root, "version");
  const bool isList = isNamed(root, "TileMapService") || isNamed(root, "Services");
  return isList ? readList(document, std::move(result)) : readTileMap(document, std::move(result));
}

}  // namespace meridian::globebrowsing
