#include <algorithm>
#include <array>
#include <cmath>

#include "globebrowsing/source/calendar.h"
#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/service_text.h"
#include "globebrowsing/source/tile_pyramid.h"
#include "globebrowsing/source/tile_url.h"

namespace meridian::globebrowsing {

namespace {

/// Where a service does not say how fine its maps are: that of the best imagery of the Earth.
constexpr double finestPixelMetres = 0.25;
constexpr int tileSize = 512;

struct MapPlace {
  std::string name;  ///< of the CRS, as the service has it
  MapCrs crs;
  Extent extent{};  ///< in its units
};

/// The extent by the layer's BoundingBox in that CRS, else from its geographic one.
std::optional<Extent> extentIn(const CapabilitiesLayer& layer, const std::string& name, const MapCrs& crs,
                               bool isAxisOrdered) {
  std::optional<Extent> geographic;
  if (layer.extent) {
    geographic = crs.fromDegrees(toDegrees(*layer.extent));
  }
  if (crs.isGeographic() || crs.isWebMercator()) {
    const Extent world = *crs.fromDegrees({-180.0, -90.0, 180.0, 90.0});
    return geographic ? geographic : world;
  }
  for (const auto& [boxCrs, box] : layer.boundingBoxes) {
    if (boxCrs == name || canonicalCrsName(boxCrs) == canonicalCrsName(name)) {
      const bool isTurned = isAxisOrdered && crs.isNorthingFirst();
      const Extent upright = isTurned ? axesExchanged(box) : box;
      if (upright.west < upright.east && upright.south < upright.north) {
        return upright;
      }
    }
  }
  return geographic;
}

Result<MapPlace> choosePlace(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                             const LayerChoices& choices) {
  const CrsNames offered = layer.crs.isEmpty() ? CrsNames({"EPSG:4326"}) : layer.crs;
  constexpr std::size_t mostTries = 50;
  std::vector<std::string> names;
  if (choices.crs.empty()) {
    names = offered.names(mostTries);
  } else if (offered.contains(choices.crs)) {
    names = {choices.crs};
  } else {
    names = offered.names();
    const std::string wanted = canonicalCrsName(choices.crs);
    std::erase_if(names, [&](const std::string& name) { return canonicalCrsName(name) != wanted; });
  }
  if (names.empty()) {
    return failure("the layer '" + layer.title + "' cannot be had in the CRS '" + choices.crs + "'", capabilities.url,
                   "choose one of: " + joined(offered.names(mostTries), ", ").substr(0, 300));
  }
  const bool isAxisOrdered = capabilities.kind == CapabilitiesKind::Wms && isWmsThree(capabilities.version);
  std::optional<Error> last;
  for (const std::string& name : names) {
    auto crs = MapCrs::of(name, capabilities.url);
    if (!crs) {
      last = std::move(crs.error());
      continue;
    }
    if (const auto extent = extentIn(layer, name, *crs, isAxisOrdered)) {
      return MapPlace{name, std::move(*crs), *extent};
    }
  }
  return failure("the layer '" + layer.title + "' can be had in no CRS that is known here", capabilities.url,
                 last ? last->what : "choose another layer");
}

Result<std::string> chooseFormat(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                 const LayerChoices& choices) {
  if (!choices.format.empty()) {
    for (const std::string& format : layer.formats) {
      if (equalIgnoringCase(format, choices.format)) {
        return format;
      }
    }
    if (!layer.formats.empty()) {
      return failure("the layer '" + layer.title + "' has no format '" + choices.format + "'", capabilities.url,
                     "choose one of: " + joined(layer.formats, ", "));
    }
    return choices.format;
  }
  if (layer.isOpaque) {  // JPEG is smaller, and nothing would be transparent
    for (const std::string& format : layer.formats) {
      if (formatRank(format) == 3) {
        return format;
      }
    }
  }
  return layer.formats.empty() ? std::string("image/png") : layer.formats.front();
}

Result<QueryParameters> mapParameters(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                      const LayerChoices& choices, const MapPlace& place) {
  const bool isNew = isWmsThree(capabilities.version);
  auto format = chooseFormat(capabilities, layer, choices);
  if (!format) {
    return tl::make_unexpected(std::move(format.error()));
  }
  if (!choices.style.empty() && std::none_of(layer.styles.begin(), layer.styles.end(), [&](const LayerStyle& style) {
        return style.identifier == choices.style;
      })) {
    return failure("the layer '" + layer.title + "' has no style '" + choices.style + "'", capabilities.url);
  }
  QueryParameters parameters{{"SERVICE", "WMS"},
                             {"VERSION", capabilities.version},
                             {"REQUEST", "GetMap"},
                             {"LAYERS", percentEncoded(layer.identifier)},
                             {"STYLES", percentEncoded(choices.style)},
                             {isNew ? "CRS" : "SRS", percentEncoded(place.name, ":")},
                             {"BBOX", isNew && place.crs.isNorthingFirst() ? "{South},{West},{North},{East}"
                                                                           : "{West},{South},{East},{North}"},
                             {"WIDTH", "{Width}"},
                             {"HEIGHT", "{Height}"},
                             {"FORMAT", percentEncoded(*format, "/")}};
  if (formatHasAlpha(*format)) {
    parameters.emplace_back("TRANSPARENT", choices.isTransparent ? "TRUE" : "FALSE");
  }
  for (const LayerDimension& dimension : layer.dimensions) {
    auto value = dimensionValue(dimension, choices, capabilities.url);
    if (!value) {
      return tl::make_unexpected(std::move(value.error()));
    }
    if (!value->value.empty() && !value->isDefault) {
      const std::string name = lowerCase(dimension.name);
      const bool isPlain = name == "time" || name == "elevation";
      parameters.emplace_back(
          isPlain ? (name == "time" ? "TIME" : "ELEVATION") : "DIM_" + percentEncoded(dimension.name),
          percentEncoded(value->value, ":/,"));
    }
  }
  for (const auto& [name, value] : choices.parameters) {
    parameters.emplace_back(percentEncoded(name), percentEncoded(value));
  }
  return parameters;
}

/// ArcGIS's export operations (REST API, "Export Map" and "Export Image"), without what the picture is to be like.
QueryParameters exportParameters(const CapabilitiesLayer& layer, const LayerChoices& choices, const MapPlace& place,
                                 const std::string& where) {
  QueryParameters parameters{{"bbox", "{West},{South},{East},{North}"}, {"size", "{Width},{Height}"}};
  const std::string code = place.name.substr(place.name.find(':') + 1);
  parameters.emplace_back("bboxSR", percentEncoded(code));
  parameters.emplace_back("imageSR", percentEncoded(code));
  if (!layer.identifier.empty() && layer.identifier != "0:image") {
    parameters.emplace_back("layers", "show:" + percentEncoded(layer.identifier));
  }
  for (const LayerDimension& dimension : layer.dimensions) {
    auto value = dimensionValue(dimension, choices, where);
    if (value && dimension.isTime() && !value->isDefault) {
      if (const auto instant = readInstant(value->value)) {
        parameters.emplace_back("time", std::to_string(instant->at));
      }
    }
  }
  parameters.emplace_back("f", "image");
  for (const auto& [name, value] : choices.parameters) {
    parameters.emplace_back(percentEncoded(name), percentEncoded(value));
  }
  return parameters;
}

QueryParameters picture(const LayerChoices& choices) {
  return {{"format", choices.format.empty() ? "png32" : percentEncoded(choices.format)},
          {"transparent", choices.isTransparent ? "true" : "false"}};
}

/// The first band as it is stored: every other format than TIFF brings it to 8 bits, or is none of GDAL's.
QueryParameters values(const CapabilitiesLayer& layer) {
  QueryParameters parameters{{"format", "tiff"}, {"pixelType", "F32"}};
  if (layer.valueBands > 1) {
    parameters.emplace_back("bandIds", "0");
  }
  return parameters;
}

TileUrl exportAddress(const Capabilities& capabilities, const QueryParameters& parameters,
                      const QueryParameters& likeness) {
  return TileUrl::cut(withParameters(withParameters(capabilities.mapAddress, parameters), likeness),
                      windowPlaceholders());
}

Result<TileUrl> addressOf(const Capabilities& capabilities, const CapabilitiesLayer& layer, const LayerChoices& choices,
                          const MapPlace& place) {
  if (capabilities.kind == CapabilitiesKind::ArcGis) {
    return exportAddress(capabilities, exportParameters(layer, choices, place, capabilities.url), picture(choices));
  }
  auto parameters = mapParameters(capabilities, layer, choices, place);
  if (!parameters) {
    return tl::make_unexpected(std::move(parameters.error()));
  }
  return TileUrl::cut(withParameters(capabilities.mapAddress, *parameters), windowPlaceholders());
}

/// The one tile that such a layer is.
std::vector<TileMatrix> wholeMatrix(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                    const Extent& extent) {
  constexpr int longest = 2048;
  const double aspect = (extent.east - extent.west) / (extent.north - extent.south);
  TileMatrix matrix;
  matrix.identifier = "0";
  matrix.tileWidth = aspect >= 1.0 ? longest : std::max(1, static_cast<int>(std::lround(longest * aspect)));
  matrix.tileHeight = aspect >= 1.0 ? std::max(1, static_cast<int>(std::lround(longest / aspect))) : longest;
  const auto fit = [](int& size, int fixed, int most) {
    size = fixed > 0 ? fixed : most > 0 ? std::min(size, most) : size;
  };
  fit(matrix.tileWidth, layer.fixedWidth, capabilities.maximumWidth);
  fit(matrix.tileHeight, layer.fixedHeight, capabilities.maximumHeight);
  matrix.left = extent.west;
  matrix.top = extent.north;
  matrix.pixelWidth = (extent.east - extent.west) / matrix.tileWidth;
  matrix.pixelHeight = (extent.north - extent.south) / matrix.tileHeight;
  return {matrix};
}

std::vector<TileMatrix> pyramidOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                  const MapPlace& place) {
  Pyramid pyramid;
  pyramid.extent = place.extent;
  pyramid.tileSize = tileSize;
  for (const int most : {capabilities.maximumWidth, capabilities.maximumHeight}) {
    pyramid.tileSize = most > 0 ? std::min(pyramid.tileSize, most) : pyramid.tileSize;
  }
  const double unit = place.crs.metresPerUnit();
  pyramid.finestPixel = std::max(layer.finestPixelMetres, finestPixelMetres) / unit;
  pyramid.coarsestPixel = layer.coarsestPixelMetres / unit;
  std::vector<TileMatrix> matrices = layOutPyramid(place.crs, pyramid);
  // The pyramid ends at or below what was asked for; below the layer's own limit maps are empty.
  while (matrices.size() > 1 && matrices.front().pixelWidth * unit < 0.999 * layer.finestPixelMetres) {
    matrices.erase(matrices.begin());
  }
  return matrices;
}

}  // namespace

Result<TileService> mapsOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                           const LayerChoices& choices) {
  auto place = choosePlace(capabilities, layer, choices);
  if (!place) {
    return tl::make_unexpected(std::move(place.error()));
  }
  auto address = addressOf(capabilities, layer, choices, *place);
  if (!address) {
    return tl::make_unexpected(std::move(address.error()));
  }
  TileService service;
  service.where = capabilities.url;
  service.name = layer.title;
  service.crs = place->crs.definition();
  service.attribution = creditText(layer.attribution.empty() ? capabilities.attribution : layer.attribution);
  const bool isWhole = layer.isWholeOnly || (layer.fixedWidth > 0 && layer.fixedHeight > 0);
  auto matrices = isWhole ? wholeMatrix(capabilities, layer, place->extent) : pyramidOf(capabilities, layer, *place);
  if (auto set = setMatrices(service, std::move(matrices), place->extent); !set) {
    return tl::make_unexpected(std::move(set.error()));
  }
  service.url = TileUrl::bind(std::move(*address), service.matrices);
  if (layer.hasValues && choices.format.empty()) {
    constexpr double lowestFloat = -3.4028234663852886e38;  // Esri's, where a service names no value of its own
    service.noData = layer.noData.value_or(lowestFloat);
    service.heightUrl = TileUrl::bind(
        exportAddress(capabilities, exportParameters(layer, choices, *place, capabilities.url), values(layer)),
        service.matrices);
  }
  return service;
}

}  // namespace meridian::globebrowsing
