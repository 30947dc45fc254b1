#include "globebrowsing/source/capabilities_reference.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "globebrowsing/source/document_file.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

/// Of layers that ArcGIS does not number: the whole service.
constexpr std::string_view wholeService = "0:image";

/// The parts between commas that no quotes hold.
std::vector<std::string> partsOf(std::string_view text) {
  std::vector<std::string> parts(1);
  bool isQuoted = false;
  for (const char c : text) {
    isQuoted = c == '"' ? !isQuoted : isQuoted;
    if (c == ',' && !isQuoted) {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

CapabilitiesReference referenceOf(std::string_view text, CapabilitiesKind kind) {
  CapabilitiesReference reference;
  reference.kind = kind;
  const std::vector<std::string> parts = partsOf(text);
  reference.url = repairedUrl(replaceAll(parts.front(), "\"", ""));
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::size_t equals = parts[i].find('=');
    choose(reference, trimmed(parts[i].substr(0, equals)),
           equals == std::string::npos ? std::string() : parts[i].substr(equals + 1));
  }
  return reference;
}

bool asksFor(std::string_view url, std::string_view request) {
  return equalIgnoringCase(parameterOf(url, "request").value_or(""), request);
}

/// The path without slashes at its end.
std::string pathOf(std::string_view url) {
  std::string path = withoutQuery(url);
  while (path.ends_with('/')) {
    path.pop_back();
  }
  return path;
}

/// An ArcGIS service answers with a page for people, unless told otherwise.
std::string arcGisAddress(const std::string& url) {
  if (!isWebAddress(url)) {
    return url;
  }
  const std::size_t query = url.find_first_of("?#");
  return withParameters(pathOf(url) + (query == std::string::npos ? std::string() : url.substr(query)),
                        {{"f", "json"}});
}

/// What an address says of itself.
std::optional<CapabilitiesReference> referenceByAddress(const std::string& url) {
  if (!isWebAddress(lowerCase(url))) {
    return std::nullopt;
  }
  const std::string path = lowerCase(pathOf(url));
  CapabilitiesReference reference;
  reference.url = url;
  if (path.ends_with("/mapserver") || path.ends_with("/imageserver")) {
    reference.url = arcGisAddress(url);
    reference.kind = CapabilitiesKind::ArcGis;
  } else if (path.ends_with("/tilemapresource.xml")) {
    reference.kind = CapabilitiesKind::Tms;
  } else if (path.ends_with("/wmtscapabilities.xml") ||
             (asksFor(url, "GetCapabilities") && equalIgnoringCase(parameterOf(url, "service").value_or(""), "WMTS"))) {
    reference.kind = CapabilitiesKind::Wmts;
  }
  return reference.kind ? std::optional(std::move(reference)) : std::nullopt;
}

std::string_view prefixOf(CapabilitiesKind kind) {
  switch (kind) {
    case CapabilitiesKind::Wmts:
      return "WMTS:";
    case CapabilitiesKind::Tms:
      return "TMS:";
    case CapabilitiesKind::ArcGis:
      return "ArcGIS:";
    case CapabilitiesKind::Wms:
    case CapabilitiesKind::TiledWms:
      break;
  }
  return "WMS:";
}

}  // namespace

void choose(CapabilitiesReference& reference, std::string_view name, std::string value) {
  if (value.size() >= 2 && value.front() == '"' && value.back() == '"') {
    value = value.substr(1, value.size() - 2);
  }
  LayerChoices& choices = reference.choices;
  const std::array<std::pair<std::string_view, std::string*>, 6> places{{{"layer", &reference.layer},
                                                                         {"style", &choices.style},
                                                                         {"tilematrixset", &choices.matrixSet},
                                                                         {"time", &choices.time},
                                                                         {"format", &choices.format},
                                                                         {"crs", &choices.crs}}};
  for (const auto& [known, place] : places) {
    if (equalIgnoringCase(known, name)) {
      *place = std::move(value);
      return;
    }
  }
}

std::optional<CapabilitiesReference> readReference(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string prefix = lowerCase(text.substr(0, colon));
  const std::string_view rest = text.substr(colon + 1);
  if (prefix == "wmts") {
    return referenceOf(rest, CapabilitiesKind::Wmts);
  }
  if (prefix == "tms") {
    return referenceOf(rest, CapabilitiesKind::Tms);
  }
  if (prefix == "arcgis") {
    CapabilitiesReference reference = referenceOf(rest, CapabilitiesKind::ArcGis);
    reference.url = arcGisAddress(reference.url);
    return reference;
  }
  if (prefix != "wms") {
    return referenceByAddress(repairedUrl(text));
  }
  CapabilitiesReference reference = referenceOf(rest, CapabilitiesKind::Wms);
  const bool asksForTiles = asksFor(reference.url, "GetTileService");
  if (!asksForTiles && !asksFor(reference.url, "GetCapabilities") && !containsIgnoringCase(rest, ",layer=")) {
    return std::nullopt;
  }
  reference.kind = asksForTiles ? CapabilitiesKind::TiledWms : CapabilitiesKind::Wms;
  return reference;
}

Result<std::string> writeReference(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                   const LayerChoices& choices) {
  const auto cannot = [&](const std::string& why) {
    return failure("the layer '" + layer.title + "' cannot be named in a FilePath: " + why, capabilities.url,
                   "choose another layer, or what the service takes by default");
  };
  if (!choices.dimensions.empty() || !choices.parameters.empty() || !choices.isTransparent) {
    return cannot("dimensions, further parameters and a background have no place there");
  }
  const bool isAlone = capabilities.layers.size() == 1 || layer.identifier == wholeService;
  const bool needsNoName =
      isAlone && (capabilities.kind == CapabilitiesKind::Tms || capabilities.kind == CapabilitiesKind::ArcGis);
  const bool needsQuotes = capabilities.url.find(',') != std::string::npos;
  std::string path(prefixOf(capabilities.kind));
  path += needsQuotes ? '"' + capabilities.url + '"' : capabilities.url;
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, std::string>>{{"layer", needsNoName ? std::string() : layer.identifier},
                                                        {"style", choices.style},
                                                        {"tilematrixset", choices.matrixSet},
                                                        {"crs", choices.crs},
                                                        {"format", choices.format},
                                                        {"time", choices.time}}) {
    path.append(value.empty() ? std::string() : fmt::format(",{}=\"{}\"", name, value));
  }
  const std::optional<CapabilitiesReference> read = readReference(path);
  if (!read) {
    return cannot("its document's address is not understood");
  }
  const Result<const CapabilitiesLayer*> found = layerOf(*read, capabilities);
  const bool isSame = found && (*found)->identifier == layer.identifier && (*found)->title == layer.title &&
                      (*found)->path == layer.path;
  return isSame ? Result<std::string>(std::move(path))
                : cannot("another one has its name, or a quotation mark is in it");
}

bool isCapabilitiesRoot(std::string_view name) {
  constexpr std::array<std::string_view, 6> roots{"Capabilities",     "WMS_Capabilities", "WMT_MS_Capabilities",
                                                  "WMS_Tile_Service", "TileMap",          "TileMapService"};
  return std::any_of(roots.begin(), roots.end(), [&](std::string_view root) { return equalIgnoringCase(root, name); });
}

Result<const CapabilitiesLayer*> layerOf(const CapabilitiesReference& reference, const Capabilities& capabilities) {
  const CapabilitiesLayer* layer = nullptr;
  if (!reference.layer.empty()) {
    layer = capabilities.find(reference.layer);
  } else {
    const auto usable = std::find_if(capabilities.layers.begin(), capabilities.layers.end(),
                                     [](const CapabilitiesLayer& candidate) { return candidate.obstacle.empty(); });
    layer = usable == capabilities.layers.end() ? nullptr : &*usable;
  }
  if (layer == nullptr) {
    return failure(reference.layer.empty() ? std::string("the service has no layer that can be shown")
                                           : "the service has no layer '" + reference.layer + "'",
                   reference.url, "choose one that its capabilities list");
  }
  return layer;
}

Result<TileService> serviceOf(const CapabilitiesReference& reference, const Capabilities& capabilities) {
  return layerOf(reference, capabilities).and_then([&](const CapabilitiesLayer* layer) {
    return serviceOf(capabilities, *layer, reference.choices);
  });
}

}  // namespace meridian::globebrowsing
