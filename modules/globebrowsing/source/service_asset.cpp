#include "globebrowsing/source/service_asset.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

std::string escapedXml(const std::string& text) {
  return replaceAll(replaceAll(replaceAll(text, "&", "&amp;"), "<", "&lt;"), ">", "&gt;");
}

/// Letters, digits and underscores: what a node of the property tree may be called.
std::string identifierOf(const std::string& name) {
  std::string identifier;
  for (const char c : name) {
    identifier += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return identifier.empty() ? "Layer" : identifier;
}

/// A matrix's name; of one that is named by an address (TMS) its last part.
std::string levelOf(const TileMatrix& matrix) {
  return matrix.identifier.substr(matrix.identifier.rfind('/') + 1);
}

/// The numbers of a tile in an address replaced by GDAL's words, when exactly that is what its address is made of:
/// found by asking for two tiles that have no number in common.
std::optional<std::string> numbersAsWords(const TileService& service, std::size_t matrix, std::int64_t column,
                                          std::int64_t row, std::int64_t writtenRow) {
  std::string address = service.url({matrix, column, row});
  const std::string level = levelOf(service.matrices[matrix]);
  // Numbers that stand alone between separators only.
  const auto word = [&](const std::string& number, const std::string& name) {
    for (std::size_t at = address.rfind(number); at != std::string::npos && at > 0;
         at = address.rfind(number, at - 1)) {
      const auto isDigit = [&](std::size_t i) {
        return i < address.size() && std::isalnum(static_cast<unsigned char>(address[i])) != 0;
      };
      if (!isDigit(at - 1) && !isDigit(at + number.size())) {
        address.replace(at, number.size(), name);
        return true;
      }
    }
    return false;
  };
  if (word(std::to_string(column), "${x}") && word(std::to_string(writtenRow), "${y}") && word(level, "${z}")) {
    return address;
  }
  return std::nullopt;
}

struct Window {
  double right = 0.0;
  double bottom = 0.0;
  bool isTopOrigin = true;  ///< rows count from the north
};

/// The address that holds for tiles all over the finest level, in GDAL's words; rows count from the south where
/// their number is given. Nothing: there is no such address.
std::optional<std::string> commonAddress(const TileService& service, std::optional<std::int64_t> rowCount) {
  const TileMatrix& finest = service.matrices.front();
  std::optional<std::string> address;
  for (std::int64_t step = 0; step < 40; ++step) {
    const std::int64_t column = finest.firstColumn + step * (finest.lastColumn - finest.firstColumn) / 40;
    const std::int64_t row = finest.lastRow - step * (finest.lastRow - finest.firstRow) / 120;
    const std::int64_t written = rowCount ? *rowCount - 1 - row : row;
    if (column == written || std::to_string(column) == levelOf(finest) || std::to_string(written) == levelOf(finest)) {
      continue;  // which number is which cannot be seen
    }
    const std::optional<std::string> found = numbersAsWords(service, 0, column, row, written);
    if (!found || (address && *address != *found)) {
      return std::nullopt;
    }
    address = found;
  }
  return address;
}

/// The levels are 0, 1 ... n, each half of the one before, from one corner.
bool isRegular(const TileService& service) {
  const std::size_t count = service.matrices.size();
  const TileMatrix& coarsest = service.matrices.back();
  for (std::size_t i = 0; i < count; ++i) {
    const TileMatrix& matrix = service.matrices[i];
    const double scale = std::ldexp(1.0, static_cast<int>(count - 1 - i));
    const double corner = 1e-6 * coarsest.pixelWidth * coarsest.tileWidth;
    if (levelOf(matrix) != std::to_string(count - 1 - i) || matrix.tileWidth != coarsest.tileWidth ||
        matrix.tileHeight != coarsest.tileHeight ||
        std::abs(matrix.pixelWidth * scale / coarsest.pixelWidth - 1) > 1e-6 ||
        std::abs(matrix.pixelHeight * scale / coarsest.pixelHeight - 1) > 1e-6 ||
        std::abs(matrix.left - coarsest.left) > corner || std::abs(matrix.top - coarsest.top) > corner) {
      return false;
    }
  }
  return true;
}

std::string document(const TileService& service, const std::string& element, const Window& window,
                     const std::string& level) {
  const TileMatrix& finest = service.matrices.front();
  std::string codes;
  for (const int status : service.emptyStatuses) {
    codes += (codes.empty() ? "" : ",") + std::to_string(status);
  }
  return fmt::format(
      "<GDAL_WMS>\n  {}\n  <DataWindow>\n    <UpperLeftX>{}</UpperLeftX><UpperLeftY>{}</UpperLeftY>\n"
      "    <LowerRightX>{}</LowerRightX><LowerRightY>{}</LowerRightY>\n    {}\n    <YOrigin>{}</YOrigin>\n"
      "  </DataWindow>\n  <Projection>{}</Projection>\n  <BlockSizeX>{}</BlockSizeX><BlockSizeY>{}</BlockSizeY>\n"
      "  <BandsCount>{}</BandsCount>\n  <ZeroBlockHttpCodes>{}</ZeroBlockHttpCodes>\n</GDAL_WMS>",
      element, decimal(finest.left), decimal(finest.top), decimal(window.right), decimal(window.bottom), level,
      window.isTopOrigin ? "top" : "bottom", service.crs.empty() ? "EPSG:4326" : escapedXml(service.crs),
      finest.tileWidth, finest.tileHeight, service.bands > 0 ? service.bands : 4, codes);
}

/// A WMS: its parameters are elements, and the rest of its address stays.
Result<std::string> documentOfMaps(const Capabilities& capabilities, const TileService& service, bool followsTime) {
  const std::string address = service.url({0, service.matrices[0].firstColumn, service.matrices[0].firstRow});
  const auto parameter = [&](std::string_view name) { return parameterOf(address, name).value_or(""); };
  const bool isNew = isWmsThree(capabilities.version);
  std::string server(withoutQuery(address) + "?");
  for (const std::string& part : split(address.substr(std::min(address.find('?') + 1, address.size())), "&")) {
    const std::string name = part.substr(0, part.find('='));
    // The value is that of the day on which this is written.
    const bool isOwn = isGetMapParameter(name) || (followsTime && lowerCase(name) == "time");
    server += isOwn ? std::string() : part + "&";
  }
  const std::string crs = parameter(isNew ? "crs" : "srs");
  const auto known = MapCrs::of(replaceAll(crs, "%3A", ":"), capabilities.url);
  const bool isTurned = isNew && known && known->isNorthingFirst();
  std::string element = "<Service name=\"WMS\">\n";
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, std::string>>{{"Version", capabilities.version},
                                                        {"ServerUrl", server},
                                                        {isNew ? "CRS" : "SRS", crs},
                                                        {"BBoxOrder", isTurned ? "yxYX" : "xyXY"},
                                                        {"ImageFormat", parameter("format")},
                                                        {"Layers", parameter("layers")},
                                                        {"Styles", parameter("styles")},
                                                        {"Transparent", parameter("transparent")}}) {
    if (!value.empty()) {
      element += fmt::format("    <{0}>{1}</{0}>\n", name, escapedXml(value));
    }
  }
  // Whole tiles of the coarsest level, so that both programs lay out the same pyramid.
  const TileMatrix& coarsest = service.matrices.back();
  const auto levels = static_cast<int>(service.matrices.size()) - 1;
  const std::int64_t columns = coarsest.lastColumn - coarsest.firstColumn + 1;
  const std::int64_t rows = coarsest.lastRow - coarsest.firstRow + 1;
  TileService moved = service;
  TileMatrix& finest = moved.matrices.front();
  finest.left = coarsest.left + static_cast<double>(coarsest.firstColumn) * coarsest.tileWidth * coarsest.pixelWidth;
  finest.top = coarsest.top - static_cast<double>(coarsest.firstRow) * coarsest.tileHeight * coarsest.pixelHeight;
  const Window window{finest.left + static_cast<double>(columns) * coarsest.tileWidth * coarsest.pixelWidth,
                      finest.top - static_cast<double>(rows) * coarsest.tileHeight * coarsest.pixelHeight};
  // GDAL counts pixels in 31 bits.
  int kept = levels;
  while (kept > 0 &&
         std::ldexp(static_cast<double>(std::max(columns, rows) * coarsest.tileWidth), kept) > 2147483647.0) {
    --kept;
  }
  const auto size = [&](std::int64_t tiles, int tile) { return (tiles * tile) << kept; };
  element += "  </Service>";
  if (followsTime) {
    element += "\n  <GetCapabilitiesUrl>" + escapedXml(capabilities.url) + "</GetCapabilitiesUrl>";
  }
  return document(moved, element, window,
                  fmt::format("<SizeX>{}</SizeX><SizeY>{}</SizeY>", size(columns, coarsest.tileWidth),
                              size(rows, coarsest.tileHeight)));
}

std::string wmtsPath(const Capabilities& capabilities, const CapabilitiesLayer& layer, const LayerChoices& choices) {
  std::string path = "WMTS:" + capabilities.url + ",layer=\"" + layer.identifier + "\"";
  for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{
           {"style", choices.style}, {"tilematrixset", choices.matrixSet}, {"time", choices.time}}) {
    path += value.empty() ? std::string() : fmt::format(",{}=\"{}\"", name, value);
  }
  return path;
}

std::string descriptionOf(const CapabilitiesLayer& layer) {
  return layer.attribution.empty() ? layer.abstract : joined({layer.abstract, layer.attribution}, " -- ");
}

}  // namespace

Result<std::string> gdalWmsOf(const TileService& service) {
  const auto cannot = [&](const std::string& why) {
    return failure("the tiles of '" + service.name + "' cannot be described to GDAL: " + why, service.where);
  };
  if (service.matrices.empty() || !isRegular(service)) {
    return cannot("their levels are not 0, 1, 2 and so on, each half of the one before");
  }
  const std::int64_t rowCount = (service.matrices.back().lastRow + 1) << (service.matrices.size() - 1);
  std::optional<std::string> address = commonAddress(service, std::nullopt);
  const bool isTop = address.has_value();
  address = address ? address : commonAddress(service, rowCount);
  if (!address) {
    return cannot("their addresses are not made of level, column and row");
  }
  const TileMatrix& coarsest = service.matrices.back();
  const std::int64_t columns = coarsest.lastColumn + 1;
  const std::int64_t rows = coarsest.lastRow + 1;
  const Window window{coarsest.left + static_cast<double>(columns) * coarsest.tileWidth * coarsest.pixelWidth,
                      coarsest.top - static_cast<double>(rows) * coarsest.tileHeight * coarsest.pixelHeight, isTop};
  return document(service, "<Service name=\"TMS\"><ServerUrl>" + escapedXml(*address) + "</ServerUrl></Service>",
                  window,
                  fmt::format("<TileLevel>{}</TileLevel><TileCountX>{}</TileCountX><TileCountY>{}</TileCountY>",
                              service.matrices.size() - 1, columns, rows));
}

std::string layersAsset(const std::string& globe, std::span<const PlacedLayer> layers) {
  std::string tables;
  std::string added;
  std::string deleted;
  std::string exported;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const std::string name = layers.size() == 1 ? "layer" : fmt::format("layer{}", i + 1);
    const std::string arguments =
        fmt::format("({}, {}, {})", Value(globe).toLua(), Value(layers[i].group).toLua(), name);
    tables += fmt::format("local {} = {}\n\n", name, layers[i].table.toLua());
    added += "  openspace.globebrowsing.addLayer" + arguments + '\n';
    deleted.insert(0, "  openspace.globebrowsing.deleteLayer" + arguments + '\n');
    exported += fmt::format("asset.export(\"{}\", {})\n", name, name);
  }
  return fmt::format("{}asset.onInitialize(function()\n{}end)\n\nasset.onDeinitialize(function()\n{}end)\n\n{}", tables,
                     added, deleted, exported);
}

Result<LayerAsset> assetOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                           const LayerChoices& choices, const AssetPlace& place) {
  auto service = serviceOf(capabilities, layer, choices);
  if (!service) {
    return tl::make_unexpected(std::move(service.error()));
  }
  const bool isWmts = capabilities.kind == CapabilitiesKind::Wmts;
  const bool followsTime = layer.timeDimension() != nullptr && choices.time.empty();
  Result<std::string> path = std::string();
  if (layer.matrixSets.empty() && capabilities.kind == CapabilitiesKind::Wms) {
    path = documentOfMaps(capabilities, *service, followsTime);
  } else if (!isWmts || !followsTime) {
    path = gdalWmsOf(*service);
  }
  if (isWmts && (!path || path->empty())) {
    path = wmtsPath(capabilities, layer, choices);
  }
  if (!path) {
    return tl::make_unexpected(std::move(path.error()));
  }
  Table table;
  table.fields["Identifier"] = identifierOf(layer.identifier.empty() ? layer.title : layer.identifier);
  table.fields["Name"] = layer.title;
  table.fields["Description"] = descriptionOf(layer);
  if (!service->attribution.empty()) {
    table.fields["Attribution"] = service->attribution;
  }
  table.fields["FilePath"] = *path;
  table.fields["Enabled"] = true;
  LayerAsset asset;
  asset.table = Value(std::move(table));
  const PlacedLayer placed{asset.table, place.group};
  asset.text = layersAsset(place.globe, {&placed, 1});
  return asset;
}

}  // namespace meridian::globebrowsing
