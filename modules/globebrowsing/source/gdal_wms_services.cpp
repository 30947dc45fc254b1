#include <array>
#include <utility>

#include "globebrowsing/source/gdal_wms_parts.h"
#include "globebrowsing/source/map_crs.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

using Placeholders = std::vector<TileUrl::Placeholder>;

/// In a query's value; what is escaped already stays so.
constexpr std::string_view keptInValues = "!$'()*+,;:@/?%=";

std::string valueOf(const pugi::xml_node& service, std::string_view name, std::string_view otherwise = {}) {
  const pugi::xml_node node = child(service, name);
  return node ? text(node) : std::string(otherwise);
}

Result<std::string> serverUrl(const XmlDocument& document, const pugi::xml_node& service) {
  std::string url = repairedUrl(text(service, "ServerUrl"));
  if (url.empty()) {
    return failure("the description has no ServerUrl", document.placeOf(service), "add <ServerUrl> to <Service>");
  }
  return url;
}

/// The box in the order that GDAL's BBoxOrder writes: "xyXY" is west, south, east, north.
Result<std::vector<TileUrl::Piece>> box(const std::string& order, std::string_view separator,
                                        const std::string& where) {
  std::vector<TileUrl::Piece> pieces;
  for (const char letter : order.substr(0, 4)) {
    if (!pieces.empty()) {
      pieces.push_back({UrlPart::Literal, std::string(separator)});
    }
    switch (letter) {
      case 'x':
        pieces.push_back({UrlPart::West});
        break;
      case 'y':
        pieces.push_back({UrlPart::South});
        break;
      case 'X':
        pieces.push_back({UrlPart::East});
        break;
      case 'Y':
        pieces.push_back({UrlPart::North});
        break;
      default:
        pieces.clear();
        break;
    }
  }
  if (pieces.size() != 7) {
    return failure("BBoxOrder is '" + order + "'", where, "write xyXY or yxYX");
  }
  return pieces;
}

Result<GdalMiniDriver> readWms(const XmlDocument& document, const pugi::xml_node& service) {
  auto url = serverUrl(document, service);
  if (!url) {
    return tl::make_unexpected(std::move(url.error()));
  }
  const std::string version = valueOf(service, "Version", "1.1.0");
  const std::vector<std::string> parts = split(version, ".");
  const bool isThree = parts.size() >= 2 && integer(parts[0]).value_or(1) * 100 + integer(parts[1]).value_or(0) >= 103;
  std::string crsName = valueOf(service, isThree ? "CRS" : "SRS");
  if (crsName.empty()) {
    crsName = valueOf(service, isThree ? "SRS" : "CRS", "EPSG:4326");
  }
  auto crs = MapCrs::of(crsName, document.placeOf(service));
  if (!crs) {
    return tl::make_unexpected(std::move(crs.error()));
  }
  const std::string order = valueOf(service, "BBoxOrder", isThree && crs->isNorthingFirst() ? "yxYX" : "xyXY");
  auto pieces = box(order, ",", document.placeOf(service));
  if (!pieces) {
    return tl::make_unexpected(std::move(pieces.error()));
  }
  const auto value = [&](std::string_view name, std::string_view otherwise = {}) {
    return percentEncoded(valueOf(service, name, otherwise), keptInValues);
  };
  QueryParameters parameters;
  if (!parameterOf(*url, "service")) {
    parameters.emplace_back("service", "WMS");
  }
  parameters.insert(parameters.end(), {{"request", "GetMap"},
                                       {"version", version},
                                       {"layers", value("Layers")},
                                       {"styles", value("Styles")},
                                       {"format", value("ImageFormat", "image/jpeg")},
                                       {isThree ? "crs" : "srs", percentEncoded(crsName, keptInValues)}});
  if (const std::string transparent = valueOf(service, "Transparent"); !transparent.empty()) {
    parameters.emplace_back("transparent", boolean(transparent).value_or(false) ? "TRUE" : "FALSE");
  }
  parameters.insert(parameters.end(), {{"width", "{width}"}, {"height", "{height}"}, {"bbox", "{bbox}"}});
  GdalMiniDriver driver;
  driver.url = TileUrl::cut(
      withParameters(*url, parameters),
      {{"{width}", {{UrlPart::Width}}}, {"{height}", {{UrlPart::Height}}}, {"{bbox}", std::move(*pieces)}});
  driver.crs = crs->definition();
  driver.asksForWindows = true;
  return driver;
}

Result<GdalMiniDriver> readTms(const XmlDocument& document, const pugi::xml_node& service, bool isTopOrigin) {
  auto url = serverUrl(document, service);
  if (!url) {
    return tl::make_unexpected(std::move(url.error()));
  }
  if (url->find("${") == std::string::npos) {
    *url += std::string(url->back() == '/' ? "" : "/") + "${version}/${layer}/${z}/${x}/${y}.${format}";
  }
  const auto fixed = [&](std::string_view name, std::string_view otherwise) {
    return std::vector<TileUrl::Piece>{{UrlPart::Literal, valueOf(service, name, otherwise)}};
  };
  GdalMiniDriver driver;
  driver.url = TileUrl::cut(*url, {{"${layer}", fixed("Layer", "")},
                                   {"${version}", fixed("Version", "1.0.0")},
                                   {"${format}", fixed("Format", "jpg")},
                                   {"${x}", {{UrlPart::Column}}},
                                   {"${y}", {{isTopOrigin ? UrlPart::Row : UrlPart::RowFromSouth}}},
                                   {"${z}", {{UrlPart::Matrix}}},
                                   {"${xxx}", {{UrlPart::ColumnInThrees}}},
                                   {"${yyy}", {{isTopOrigin ? UrlPart::RowInThrees : UrlPart::RowFromSouthInThrees}}}});
  return driver;
}

Result<GdalMiniDriver> readWorldWind(const XmlDocument& document, const pugi::xml_node& service) {
  auto url = serverUrl(document, service);
  if (!url) {
    return tl::make_unexpected(std::move(url.error()));
  }
  GdalMiniDriver driver;
  driver.url = TileUrl::cut(
      withParameters(
          *url,
          {{"T", percentEncoded(valueOf(service, "Layer"), keptInValues)}, {"L", "{z}"}, {"X", "{x}"}, {"Y", "{y}"}}),
      {{"{z}", {{UrlPart::Matrix}}}, {"{x}", {{UrlPart::Column}}}, {"{y}", {{UrlPart::RowFromSouth}}}});
  return driver;
}

Result<GdalMiniDriver> readTileService(const XmlDocument& document, const pugi::xml_node& service) {
  auto url = serverUrl(document, service);
  if (!url) {
    return tl::make_unexpected(std::move(url.error()));
  }
  GdalMiniDriver driver;
  driver.url =
      TileUrl::cut(withParameters(*url, {{"interface", "map"},
                                         {"version", valueOf(service, "Version", "1")},
                                         {"dataset", percentEncoded(valueOf(service, "Dataset"), keptInValues)},
                                         {"level", "{z}"},
                                         {"x", "{x}"},
                                         {"y", "{y}"}}),
                   {{"{z}", {{UrlPart::Matrix}}}, {"{x}", {{UrlPart::Column}}}, {"{y}", {{UrlPart::Row}}}});
  return driver;
}

Result<GdalMiniDriver> readVirtualEarth(const XmlDocument& document, const pugi::xml_node& service) {
  auto url = serverUrl(document, service);
  if (!url) {
    return tl::make_unexpected(std::move(url.error()));
  }
  GdalMiniDriver driver;
  driver.url = TileUrl::cut(*url, {{"${quadkey}", {{UrlPart::QuadKey}}}, {"${server_num}", {{UrlPart::Server}}}});
  if (!driver.url.has(UrlPart::QuadKey)) {
    return failure("the ServerUrl has no ${quadkey}", document.placeOf(service),
                   "put ${quadkey} where the key belongs");
  }
  driver.url.setServers({"0", "1", "2", "3"});
  driver.crs = "EPSG:3857";
  driver.defaults = {-webMercatorHalfWidth, webMercatorHalfWidth, webMercatorHalfWidth, -webMercatorHalfWidth};
  driver.defaults.blockWidth = 256;
  driver.defaults.blockHeight = 256;
  driver.defaults.level = 21;
  driver.defaultOverviews = 20;
  driver.needsWindow = false;
  return driver;
}

Result<GdalMiniDriver> readArcGis(const XmlDocument& document, const pugi::xml_node& service) {
  auto url = serverUrl(document, service);
  if (!url) {
    return tl::make_unexpected(std::move(url.error()));
  }
  const std::string lowered = lowerCase(*url);
  if (lowered.find("/export?") == std::string::npos && lowered.find("/exportimage?") == std::string::npos) {
    *url += url->ends_with('/') ? "export?" : "/export?";
  }
  const std::string srs = valueOf(service, "SRS", "102100");
  auto crs = MapCrs::of(srs, document.placeOf(service));
  if (!crs) {
    return tl::make_unexpected(std::move(crs.error()));
  }
  const std::string code = srs.substr(lowerCase(srs).starts_with("epsg:") ? 5 : 0);
  QueryParameters parameters{{"f", "image"},
                             {"bbox", "{bbox}"},
                             {"size", "{width}%2C{height}"},
                             {"imageSR", percentEncoded(code)},
                             {"bboxSR", percentEncoded(code)},
                             {"format", percentEncoded(valueOf(service, "ImageFormat", "png"))},
                             {"layers", percentEncoded(valueOf(service, "Layers"))},
                             {"transparent", lowerCase(valueOf(service, "Transparent", "false"))}};
  if (const std::string time = valueOf(service, "TimeRange"); !time.empty()) {
    parameters.emplace_back("time", percentEncoded(time));
  }
  auto pieces = box("xyXY", "%2C", document.placeOf(service));
  GdalMiniDriver driver;
  driver.url = TileUrl::cut(
      withParameters(*url, parameters),
      {{"{width}", {{UrlPart::Width}}}, {"{height}", {{UrlPart::Height}}}, {"{bbox}", std::move(*pieces)}});
  driver.crs = crs->definition();
  driver.asksForWindows = true;
  return driver;
}

}  // namespace

Result<std::optional<GdalMiniDriver>> readMiniDriver(const XmlDocument& document, const pugi::xml_node& service,
                                                     bool isTopOrigin) {
  const std::string name = lowerCase(attribute(service, "name"));
  if (name.empty()) {
    return failure("the description names no service", document.placeOf(service), "write <Service name=\"TMS\">");
  }
  const auto found = [&]() -> Result<GdalMiniDriver> {
    if (name == "wms") {
      return readWms(document, service);
    }
    if (name == "tms") {
      return readTms(document, service, isTopOrigin);
    }
    if (name == "worldwind") {
      return readWorldWind(document, service);
    }
    if (name == "tileservice") {
      return readTileService(document, service);
    }
    if (name == "virtualearth") {
      return readVirtualEarth(document, service);
    }
    return readArcGis(document, service);
  };
  for (const std::string_view known : {"wms", "tms", "worldwind", "tileservice", "virtualearth", "ags"}) {
    if (name == known) {
      auto driver = found();
      if (!driver) {
        return tl::make_unexpected(std::move(driver.error()));
      }
      return std::optional(std::move(*driver));
    }
  }
  return std::optional<GdalMiniDriver>();
}

}  // namespace meridian::globebrowsing
