#include "globebrowsing/providers/tiles_table.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "globebrowsing/providers/inner_providers.h"
#include "globebrowsing/source/url_template.h"

namespace meridian::globebrowsing {

namespace {

const std::vector<std::string>& encodingNames() {
  static const std::vector<std::string> names{"Image", "MapboxRgb", "Terrarium", "PackedFloat"};
  return names;
}

std::optional<int> integerAt(const Value& table, std::string_view key) {
  const std::optional<double> number = valueAt(table, key).number();
  return number ? std::optional(static_cast<int>(*number)) : std::nullopt;
}

Result<std::optional<Extent>> extentOf(const Value& table, const std::string& where) {
  const std::optional<std::vector<double>> sides = valueAt(table, "Extent").numbers(4);
  if (!sides) {
    return std::nullopt;
  }
  const Extent extent{(*sides)[0], (*sides)[1], (*sides)[2], (*sides)[3]};
  if (!(extent.west < extent.east) || !(extent.south < extent.north) || extent.south < -90.0 || extent.north > 90.0) {
    return failure("Tiles.Extent is empty, turned around or off the map", where + ".Extent",
                   "give west, south, east, north in degrees, east greater than west, north greater than south; one "
                   "over the antimeridian needs a layer on each side");
  }
  return extent;
}

Result<TileSettings> readKeys(const Value& table, const std::string& where) {
  TileSettings settings;
  if (const std::string* name = valueAt(table, "Encoding").string()) {
    const std::vector<std::string>& names = encodingNames();
    settings.encoding = static_cast<TileEncoding>(std::find(names.begin(), names.end(), *name) - names.begin());
  }
  settings.pixelSize = integerAt(table, "PixelSize");
  settings.firstLevel = integerAt(table, "FirstLevel");
  settings.lastLevel = integerAt(table, "LastLevel");
  settings.countsFromSouth = valueAt(table, "RowsFromSouth").boolean();
  if (const std::string* projection = valueAt(table, "Projection").string()) {
    settings.projection = *projection;
  }
  if (const std::optional<std::vector<double>> sides = valueAt(table, "Square").numbers(4)) {
    settings.square = Extent{(*sides)[0], (*sides)[1], (*sides)[2], (*sides)[3]};
  }
  const int first = settings.firstLevel.value_or(UrlTemplate{}.firstLevel);
  const int last = settings.lastLevel.value_or(UrlTemplate{}.lastLevel);
  if (first > last) {
    return failure(fmt::format("FirstLevel is {}, and LastLevel {}", first, last), where + ".FirstLevel",
                   "give levels from the coarsest to the finest");
  }
  auto extent = extentOf(table, where);
  if (!extent) {
    return tl::make_unexpected(std::move(extent.error()));
  }
  settings.extentDegrees = *extent;
  return settings;
}

void collectUnknown(const Value& value, const std::string& path, std::string_view where,
                    std::vector<UnknownTilesKey>& found) {
  const Table* table = value.table();
  if (table == nullptr) {
    return;
  }
  for (std::size_t i = 0; i < table->list.size(); ++i) {
    collectUnknown(table->list[i], fmt::format("{}[{}]", path, i + 1), where, found);
  }
  for (const auto& [key, item] : table->fields) {
    const std::string below = path.empty() ? key : fmt::format("{}.{}", path, key);
    collectUnknown(item, below, where, found);
    if (key == "Tiles") {
      for (UnknownKey& unknown : unknownKeys(item, {&tilesSchema()}, {})) {
        found.push_back({std::move(unknown), fmt::format("{}{}{}", where, where.empty() ? "" : ": ", below)});
      }
    }
  }
}

}  // namespace

const Schema& tilesSchema() {
  using Type = Schema::Type;
  static const Schema fields(
      {{"Encoding",
        Type::String,
        "how the tiles' colours are heights in metres; Image: the first band is the height",
        false,
        {},
        {},
        encodingNames()},
       {"PixelSize", Type::Integer, "pixels along a tile of a URL template", false, 1.0, 8192.0},
       {"FirstLevel", Type::Integer, "the coarsest level of a URL template", false, 0.0, 30.0},
       {"LastLevel", Type::Integer, "the finest level of a URL template", false, 0.0, 30.0},
       {"RowsFromSouth", Type::Boolean, "whether {y} of a URL template counts from the south"},
       {"Projection", Type::String, "of a URL template: EPSG:3857, EPSG:4326, or one whose Square is given"},
       {"Square", Type::Vector4, "west, south, east and north edge of level 0, in units of the projection"},
       {"Extent", Type::Vector4, "west, south, east and north edge of a URL template's data, in degrees", false, -180.0,
        180.0}});
  return fields;
}

Result<TileSettings> readTiles(const ProviderRequest& request) {
  const Value& table = valueAt(request.table, "Tiles");
  if (table.isNil()) {
    return TileSettings{};
  }
  const std::string path = request.path.empty() ? "Tiles" : request.path + ".Tiles";
  if (Result<void> valid = tilesSchema().validate(table, request.where, path); !valid) {
    return tl::make_unexpected(std::move(valid.error()));
  }
  if (!valueAt(request.table, "ExtentDegrees").isNil()) {
    return failure("ExtentDegrees is of rasters, and Tiles of map services", placeOf(request, "ExtentDegrees"),
                   "leave one of them out; the extent of a URL template is Tiles.Extent");
  }
  return readKeys(table, placeOf(request, "Tiles"));
}

Result<void> checkTiles(const TileSettings& settings, const std::string& filePath, const std::string& where) {
  const std::string key(settings.keyOfTemplates());
  if (key.empty() || isUrlTemplate(filePath)) {
    return {};
  }
  return failure("Tiles." + key + " is of addresses with {z}, {x} and {y}, and FilePath is none", where + "." + key,
                 "leave it out: any other FilePath says itself where its tiles lie");
}

std::vector<UnknownTilesKey> unknownTilesKeys(const ProviderRequest& request) {
  std::vector<UnknownTilesKey> found;
  collectUnknown(request.table, request.path, request.where, found);
  return found;
}

}  // namespace meridian::globebrowsing
