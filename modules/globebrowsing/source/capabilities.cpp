#include "globebrowsing/source/capabilities.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/document_file.h"
#include "globebrowsing/source/service_exception.h"
#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/time_dimension.h"

namespace meridian::globebrowsing {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr std::size_t mostBytes = std::size_t{64} << 20;

using Reader = Result<Capabilities> (*)(const XmlDocument&);

Reader readerOf(const pugi::xml_node& root) {
  const auto is = [&](std::string_view name) { return isNamed(root, name); };
  if (is("WMT_MS_Capabilities") || is("WMS_Capabilities")) {
    return readWmsCapabilities;
  }
  if (is("WMS_Tile_Service")) {
    return readTiledWmsCapabilities;
  }
  if (is("TileMap") || is("TileMapService") || is("Services") || is("TileMapResource")) {
    return readTmsCapabilities;
  }
  if (is("TileMatrixSets") || (is("Capabilities") && child(root, "Contents"))) {
    return readWmtsCapabilities;
  }
  // Some servers call theirs by another name; what is inside does not lie.
  if (child(root, "Capability")) {
    return readWmsCapabilities;
  }
  if (child(root, "Contents/Layer") || child(root, "Contents/TileMatrixSet")) {
    return readWmtsCapabilities;
  }
  return nullptr;
}

/// What lies in a file has no address itself: relative ones in it lead nowhere.
void refuseFileAddresses(Capabilities& capabilities) {
  const bool areSetsAddresses = capabilities.kind == CapabilitiesKind::Tms;
  bool hasSets = true;
  for (MatrixSet& set : capabilities.matrixSets) {
    if (areSetsAddresses) {
      std::erase_if(set.matrices, [](const TileMatrix& matrix) { return !isWebAddress(matrix.identifier); });
      hasSets = hasSets && !set.matrices.empty();
    }
  }
  for (CapabilitiesLayer& layer : capabilities.layers) {
    if (!layer.obstacle.empty()) {
      continue;
    }
    std::erase_if(layer.addresses, [&](const AddressTemplate& address) {
      return areSetsAddresses ? !hasSets : !isWebAddress(address.address);
    });
    if (layer.matrixSets.empty() ? !isWebAddress(capabilities.mapAddress) : layer.addresses.empty()) {
      layer.obstacle =
          "its document is a file in which addresses are relative: the document's own address is to be given";
    }
  }
}

}  // namespace

std::string_view kindName(CapabilitiesKind kind) {
  constexpr std::array<std::string_view, 5> names{"WMS", "WMTS", "TMS", "TiledWMS", "ArcGIS"};
  return names[static_cast<std::size_t>(kind)];
}

bool LayerDimension::isTime() const {
  return equalIgnoringCase(name, "time");
}

const LayerDimension* CapabilitiesLayer::timeDimension() const {
  const auto found =
      std::find_if(dimensions.begin(), dimensions.end(), [](const LayerDimension& d) { return d.isTime(); });
  return found == dimensions.end() ? nullptr : &*found;
}

const CapabilitiesLayer* Capabilities::find(std::string_view name) const {
  for (const bool byTitle : {false, true}) {
    const auto found = std::find_if(layers.begin(), layers.end(), [&](const CapabilitiesLayer& layer) {
      return !name.empty() && (byTitle ? layer.title : layer.identifier) == name;
    });
    if (found != layers.end()) {
      return &*found;
    }
  }
  return nullptr;
}

Result<Capabilities> parseCapabilities(std::span<const std::uint8_t> bytes, const std::string& url) {
  const std::string_view content(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t begin = content.starts_with("\xEF\xBB\xBF") ? 3 : 0;
  const std::size_t first = content.find_first_not_of(" \t\r\n", begin);
  Result<Capabilities> capabilities;
  if (first != std::string_view::npos && (content[first] == '{' || content[first] == '[')) {
    if (bytes.size() > mostBytes) {
      return failure("the document is larger than 64 MiB", url);
    }
    const nlohmann::json json = nlohmann::json::parse(content.substr(first), nullptr, false);
    if (json.is_discarded()) {
      return failure("this is no JSON", url, "check that the address gives the document");
    }
    if (const auto said = exceptionText(bytes)) {
      return failure("the service says: " + *said, url);
    }
    capabilities = readArcGisCapabilities(json, url);
  } else {
    auto document = XmlDocument::parse(bytes, url);
    if (!document) {
      return tl::make_unexpected(std::move(document.error()));
    }
    const Reader reader = readerOf(document->root());
    if (reader == nullptr) {
      const std::string name(localName(document->root()));
      if (containsIgnoringCase(name, "Exception") || equalIgnoringCase(name, "html")) {
        return failure("the service says: " + exceptionText(bytes).value_or("nothing"), url,
                       "check the address and its parameters");
      }
      return failure("a <" + name + "> describes no map service that is known here", url,
                     "give the capabilities of a WMS, WMTS, TMS, TiledWMS or ArcGIS service");
    }
    capabilities = reader(*document);
  }
  if (capabilities) {
    capabilities->url = url;
    for (CapabilitiesLayer& layer : capabilities->layers) {
      sortFormats(layer.formats);
    }
    if (!isWebAddress(url)) {
      refuseFileAddresses(*capabilities);
    }
  }
  return capabilities;
}

Result<TileService> serviceOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                              const LayerChoices& choices) {
  if (!layer.obstacle.empty()) {
    return failure("the layer '" + layer.title + "' cannot be shown: " + layer.obstacle, capabilities.url);
  }
  return layer.matrixSets.empty() ? mapsOf(capabilities, layer, choices) : tilesOf(capabilities, layer, choices);
}

bool isWmsThree(const std::string& version) {
  const std::vector<std::string> parts = split(version, ".");
  return parts.size() >= 2 && integer(parts[0]).value_or(1) * 100 + integer(parts[1]).value_or(0) >= 103;
}

std::optional<int> formatRank(std::string_view format) {
  const std::string name = lowerCase(format);
  const auto has = [&](std::string_view part) { return name.find(part) != std::string::npos; };
  if (has("pbf") || has("protobuf") || has("svg") || has("mvt") || has("geojson") || has("utfgrid") || has("pdf") ||
      has("kml")) {
    return std::nullopt;
  }
  if (has("vnd.jpeg-png") || has("mixed")) {
    return 2;
  }
  if (has("png")) {
    const bool isReduced = has("png8") || has("8bit") || has("8-bit") || has("256");
    return isReduced ? 1 : 0;
  }
  if (has("jpeg") || has("jpg")) {
    return 3;
  }
  if (has("webp")) {
    return 4;
  }
  if (has("lerc")) {
    return 5;
  }
  if (has("tif")) {
    return 6;
  }
  if (has("gif")) {
    return 7;
  }
  return has("bmp") ? std::optional(8) : std::nullopt;
}

bool formatHasAlpha(std::string_view format) {
  const int rank = formatRank(format).value_or(3);
  return rank <= 2 || rank == 4 || rank == 7;
}

void sortFormats(std::vector<std::string>& formats) {
  std::stable_sort(formats.begin(), formats.end(), [](const std::string& a, const std::string& b) {
    return formatRank(a).value_or(99) < formatRank(b).value_or(99);
  });
}

std::optional<Extent> extentFromDegrees(Extent degrees) {
  auto& [west, south, east, north] = degrees;
  if (!std::isfinite(west) || !std::isfinite(south) || !std::isfinite(east) || !std::isfinite(north)) {
    return std::nullopt;
  }
  const auto beyondPole = [](double a, double b) { return std::max(std::abs(a), std::abs(b)) > 90.5; };
  if (beyondPole(south, north) && !beyondPole(west, east)) {
    std::swap(west, south);
    std::swap(east, north);
  }
  if (south > north) {
    std::swap(south, north);
  }
  if (west > east && west <= 360.0 && east >= -360.0) {
    east += 360.0;
  }
  south = std::max(south, -90.0);
  north = std::min(north, 90.0);
  if (!(west < east) || !(south < north) || std::abs(west) > 1080.0) {
    return std::nullopt;
  }
  east = std::min(east, west + 360.0);
  return Extent{west * degree, south * degree, east * degree, north * degree};
}

Extent toDegrees(const Extent& radians) {
  return {radians.west / degree, radians.south / degree, radians.east / degree, radians.north / degree};
}

std::optional<Extent> extentOfBox(const MapCrs& crs, const Extent& box) {
  const std::optional<Extent> degrees = crs.toDegrees(box);
  return degrees ? extentFromDegrees(*degrees) : std::nullopt;
}

Result<DimensionValue> dimensionValue(const LayerDimension& dimension, const LayerChoices& choices,
                                      const std::string& where) {
  if (dimension.isTime()) {
    if (!choices.time.empty()) {
      return DimensionValue{choices.time, false};
    }
    if (!dimension.defaultValue.empty()) {
      return DimensionValue{dimension.defaultValue, true};
    }
    const TimeDimension times = TimeDimension::parse(dimension.values, {}, Time::now());
    return DimensionValue{times.isEmpty() ? std::string() : times.text(*times.last()), false};
  }
  const std::vector<std::string> values = split(dimension.values, ",");
  for (const auto& [name, value] : choices.dimensions) {
    if (equalIgnoringCase(name, dimension.name)) {
      const bool hasRange = dimension.values.find('/') != std::string::npos || values.empty();
      if (!hasRange && !dimension.isNearestValue && std::find(values.begin(), values.end(), value) == values.end()) {
        return failure("the dimension '" + dimension.name + "' has no value '" + value + "'", where,
                       "choose one of: " + dimension.values.substr(0, 200));
      }
      return DimensionValue{value, false};
    }
  }
  if (!dimension.defaultValue.empty()) {
    return DimensionValue{dimension.defaultValue, true};
  }
  const std::string first = values.empty() ? std::string() : values.front();
  return DimensionValue{first.substr(0, first.find('/')), false};
}

std::vector<TileUrl::Placeholder> windowPlaceholders() {
  return {{"{West}", {{UrlPart::West}}},   {"{South}", {{UrlPart::South}}}, {"{East}", {{UrlPart::East}}},
          {"{North}", {{UrlPart::North}}}, {"{Width}", {{UrlPart::Width}}}, {"{Height}", {{UrlPart::Height}}}};
}

std::string joined(const std::vector<std::string>& parts, std::string_view separator) {
  std::string result;
  for (const std::string& part : parts) {
    if (!part.empty()) {
      result += (result.empty() ? std::string() : std::string(separator)) + part;
    }
  }
  return result;
}

}  // namespace meridian::globebrowsing
