#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "globebrowsing/source/calendar.h"
#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

using Json = nlohmann::json;

// A key of another kind than expected is as good as none: services of many ages write these documents.
const Json& at(const Json& object, const char* key) {
  static const Json none;
  if (!object.is_object()) {
    return none;
  }
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

std::string stringAt(const Json& object, const char* key) {
  const Json& value = at(object, key);
  return value.is_string() ? std::string(trimmed(value.get<std::string>())) : std::string();
}

std::optional<double> numberAt(const Json& object, const char* key) {
  const Json& value = at(object, key);
  if (value.is_string()) {
    const auto read = number(value.get<std::string>());
    return read && std::abs(*read) <= 1e18 ? read : std::nullopt;
  }
  constexpr double most = 1e18;  // what is larger is no count, and no coordinate either
  if (!value.is_number() || !(std::abs(value.get<double>()) <= most)) {
    return std::nullopt;
  }
  return value.get<double>();
}

int sizeAt(const Json& object, const char* key, int otherwise) {
  return static_cast<int>(std::clamp(numberAt(object, key).value_or(otherwise), 0.0, 65536.0));
}

std::string crsNameAt(const Json& object) {
  const Json& reference = at(object, "spatialReference");
  for (const char* key : {"latestWkid", "wkid"}) {
    if (const auto code = numberAt(reference, key); code && *code > 0) {
      return std::to_string(static_cast<long long>(*code));
    }
  }
  return stringAt(reference, "wkt");
}

std::optional<Extent> boxOf(const Json& extent) {
  const auto west = numberAt(extent, "xmin");
  const auto south = numberAt(extent, "ymin");
  const auto east = numberAt(extent, "xmax");
  const auto north = numberAt(extent, "ymax");
  if (!west || !south || !east || !north || !(*west < *east) || !(*south < *north)) {
    return std::nullopt;
  }
  return Extent{*west, *south, *east, *north};
}

/// Esri counts milliseconds from 1970; WMS's way of writing an interval is as good for it.
void readTime(const Json& document, CapabilitiesLayer& layer) {
  const Json& info = at(document, "timeInfo");
  const Json& range = at(info, "timeExtent");
  if (!range.is_array() || range.size() < 2 || !range[0].is_number() || !range[1].is_number()) {
    return;
  }
  const CalendarStyle style{6, 3, false, true, 'T'};
  const auto instant = [&](const Json& value) {
    constexpr double most = 2e14;  // 6000 years
    return writeInstant(static_cast<CalendarMilliseconds>(std::clamp(value.get<double>(), -most, most)), style);
  };
  std::string period;
  const auto every = numberAt(info, "defaultTimeInterval");
  const std::string unit = stringAt(info, "defaultTimeIntervalUnits");
  if (every && *every >= 1.0) {
    const std::string count = std::to_string(static_cast<long long>(*every));
    for (const auto& [name, before, after] : {std::tuple{"Years", "P", "Y"},
                                              {"Months", "P", "M"},
                                              {"Weeks", "P", "W"},
                                              {"Days", "P", "D"},
                                              {"Hours", "PT", "H"},
                                              {"Minutes", "PT", "M"},
                                              {"Seconds", "PT", "S"}}) {
      if (unit.ends_with(name)) {
        period = "/" + std::string(before) + count + after;
      }
    }
  }
  layer.dimensions.push_back({"time", instant(range[0]) + "/" + instant(range[1]) + period});
}

void readPlace(const Json& document, CapabilitiesLayer& layer, const std::string& url) {
  const Json& full = at(document, at(document, "fullExtent").is_object() ? "fullExtent" : "extent");
  const std::string name = crsNameAt(full).empty() ? crsNameAt(document) : crsNameAt(full);
  const auto box = boxOf(full);
  const auto crs = MapCrs::of(name, url);
  if (!crs || !box) {
    return;
  }
  layer.boundingBoxes.emplace_back(name, *box);
  layer.extent = extentOfBox(*crs, *box);
}

/// Levels that hold tiles: by number where the service says so, else by scale.
bool holdsTiles(const Json& document, const Json& lod) {
  const auto level = numberAt(lod, "level");
  const auto scale = numberAt(lod, "scale");
  const auto first = numberAt(document, "minLOD");
  const auto last = numberAt(document, "maxLOD");
  if (level && ((first && *level < *first) || (last && *level > *last))) {
    return false;
  }
  const auto coarsest = numberAt(document, "minScale");
  const auto finest = numberAt(document, "maxScale");
  return !scale || !((coarsest && *coarsest > 0 && *scale > *coarsest * 1.001) ||
                     (finest && *finest > 0 && *scale < *finest * 0.999));
}

Capabilities readCache(const Json& document, Capabilities result, CapabilitiesLayer layer, const std::string& base) {
  const Json& info = at(document, "tileInfo");
  MatrixSet set{"tiles", crsNameAt(info).empty() ? crsNameAt(document) : crsNameAt(info)};
  const auto crs = MapCrs::of(set.crs, result.url);
  set.problem = crs ? std::string() : crs.error().what;
  const Json& lods = at(info, "lods");
  for (const Json& lod : lods.is_array() ? lods : Json::array()) {
    const auto level = numberAt(lod, "level");
    const auto resolution = numberAt(lod, "resolution");
    if (!level || !resolution || *resolution <= 0 || !holdsTiles(document, lod)) {
      continue;
    }
    TileMatrix matrix;
    matrix.identifier = std::to_string(static_cast<long long>(*level));
    matrix.tileWidth = std::clamp(sizeAt(info, "cols", 256), 1, 8192);
    matrix.tileHeight = std::clamp(sizeAt(info, "rows", 256), 1, 8192);
    matrix.left = numberAt(at(info, "origin"), "x").value_or(-180.0);
    matrix.top = numberAt(at(info, "origin"), "y").value_or(90.0);
    matrix.pixelWidth = *resolution;
    matrix.pixelHeight = *resolution;
    constexpr std::int64_t most = std::int64_t{1} << 40;
    matrix.lastColumn = most;
    matrix.lastRow = most;
    set.matrices.push_back(matrix);
  }
  const std::string format = stringAt(info, "format").empty() ? "MIXED" : stringAt(info, "format");
  layer.formats = {format};
  layer.addresses = {{format, base + "/tile/{TileMatrix}/{TileRow}/{TileCol}"}};
  layer.matrixSets = {{0}};
  if (!set.problem.empty()) {
    layer.obstacle = set.problem;
  } else if (set.matrices.empty()) {
    layer.obstacle = "it has no levels";
  } else if (!formatRank(format)) {
    layer.obstacle = "its tiles are '" + format + "', no images that can be read here";
  } else if (!layer.extent) {
    layer.obstacle = "it does not say where its tiles end";
  }
  result.matrixSets.push_back(std::move(set));
  result.layers.push_back(std::move(layer));
  return result;
}

/// Image services say what their pixels are; those of more than 8 bits are made into pictures only when asked for one.
void readValues(const Json& document, CapabilitiesLayer& layer) {
  constexpr std::array<std::string_view, 7> wide{"S8", "U16", "S16", "U32", "S32", "F32", "F64"};
  layer.hasValues = std::find(wide.begin(), wide.end(), stringAt(document, "pixelType")) != wide.end();
  layer.valueBands = sizeAt(document, "bandCount", 0);
  layer.noData = numberAt(document, "noDataValue");
}

Capabilities readMaps(const Json& document, Capabilities result, const CapabilitiesLayer& whole, bool isImage,
                      const std::string& base) {
  result.mapAddress = base + (isImage ? "/exportImage" : "/export");
  result.maximumWidth = sizeAt(document, "maxImageWidth", 0);
  result.maximumHeight = sizeAt(document, "maxImageHeight", 0);
  CapabilitiesLayer all = whole;
  for (const auto& [name, box] : whole.boundingBoxes) {
    all.crs = all.crs.with({name});
  }
  if (whole.extent) {
    all.crs = all.crs.with({"EPSG:4326", "EPSG:3857"});  // it projects, as asked
  }
  all.formats = {"png32", "jpgpng", "jpg", "png"};
  if (isImage) {
    readValues(document, all);
  }
  const std::string operations = stringAt(document, "capabilities");
  if (stringAt(document, "type").ends_with("Layer")) {
    all.obstacle = "it is a layer of a service, whose own address is to be given";
  } else if (!operations.empty() && !containsIgnoringCase(operations, "Map") &&
             !containsIgnoringCase(operations, "Image")) {
    all.obstacle = "it gives no maps but '" + operations + "'";
  } else if (all.crs.isEmpty()) {
    all.obstacle = "it does not say where its maps are";
  }
  result.layers.push_back(all);
  const Json& layers = at(document, "layers");
  for (const Json& entry : layers.is_array() ? layers : Json::array()) {
    const auto number = numberAt(entry, "id");
    if (isImage || !number) {
      continue;
    }
    CapabilitiesLayer layer = all;
    layer.identifier = std::to_string(static_cast<long long>(*number));
    layer.title = stringAt(entry, "name");
    layer.path = {all.title};
    result.layers.push_back(std::move(layer));
  }
  return result;
}

Result<Capabilities> readList(const Json& document, Capabilities result) {
  const std::string base = withoutQuery(result.url);
  const std::size_t root = lowerCase(base).find("/rest/services");
  const std::string services = root == std::string::npos ? base : base.substr(0, root + 14);
  const auto add = [&](const std::string& title, const std::string& address) {
    CapabilitiesLayer layer;
    layer.title = title;
    layer.document = address + "?f=json";
    layer.obstacle = "it is described by a document of its own, " + layer.document;
    result.layers.push_back(std::move(layer));
  };
  for (const Json& folder : at(document, "folders").is_array() ? at(document, "folders") : Json::array()) {
    if (folder.is_string()) {
      add(folder.get<std::string>(), services + "/" + percentEncoded(folder.get<std::string>(), "/"));
    }
  }
  for (const Json& service : at(document, "services").is_array() ? at(document, "services") : Json::array()) {
    const std::string type = stringAt(service, "type");
    if (type == "MapServer" || type == "ImageServer") {
      const std::string name = stringAt(service, "name");
      add(name, fmt::format("{}/{}/{}", services, percentEncoded(name, "/"), type));
    }
  }
  if (result.layers.empty()) {
    return failure("the list names no map or image service", result.url);
  }
  return result;
}

}  // namespace

Result<Capabilities> readArcGisCapabilities(const Json& document, const std::string& url) {
  Capabilities result;
  result.kind = CapabilitiesKind::ArcGis;
  result.url = url;
  if (const auto version = numberAt(document, "currentVersion")) {
    result.version = decimal(*version);
  }
  if (at(document, "services").is_array() || at(document, "folders").is_array()) {
    return readList(document, std::move(result));
  }
  const bool hasCache = at(document, "tileInfo").is_object();
  if (!hasCache && !at(document, "fullExtent").is_object() && !at(document, "extent").is_object()) {
    return failure("this JSON describes no ArcGIS map or image service", url, "ask the service for ?f=json");
  }
  std::string base = withoutQuery(url);
  while (base.ends_with('/')) {
    base.pop_back();
  }
  const bool isImage = !stringAt(document, "pixelType").empty() || !stringAt(document, "serviceDataType").empty() ||
                       lowerCase(base).ends_with("/imageserver");
  result.title = stringAt(document, "mapName");
  for (const std::string& other : {stringAt(document, "name"), stringAt(at(document, "documentInfo"), "Title")}) {
    result.title = result.title.empty() ? other : result.title;
  }
  result.abstract = stringAt(document, "description").empty() ? stringAt(document, "serviceDescription")
                                                              : stringAt(document, "description");
  result.attribution = stringAt(document, "copyrightText");
  CapabilitiesLayer whole;
  whole.identifier = "0:image";
  whole.title = result.title.empty() ? "map" : result.title;
  whole.abstract = result.abstract;
  whole.attribution = result.attribution;
  readPlace(document, whole, url);
  readTime(document, whole);
  if (hasCache) {
    return readCache(document, std::move(result), std::move(whole), base);
  }
  return readMaps(document, std::move(result), whole, isImage, base);
}

}  // namespace meridian::globebrowsing
