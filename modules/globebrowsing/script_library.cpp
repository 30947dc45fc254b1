#include "globebrowsing/script_library.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "globebrowsing/geo_json_scripts.h"
#include "globebrowsing/gibs.h"
#include "globebrowsing/layers_file.h"
#include "globebrowsing/map_server_scripts.h"
#include "globebrowsing/patch_scripts.h"
#include "globebrowsing/script_arguments.h"

namespace meridian::globebrowsing {

namespace {

/// A globe's group by any of its names, or the error that a script gets.
Result<LayerGroup*> groupOf(RenderableGlobe& globe, const Value& group) {
  return text(group, "group").and_then([&](const std::string& word) -> Result<LayerGroup*> {
    if (const std::optional<NamedGroup> named = layerGroupFromName(word)) {
      return &globe.layers().group(named->group);
    }
    std::vector<std::string_view> names;
    names.reserve(allLayerGroups.size());
    for (const LayerGroupId id : allLayerGroups) {
      names.push_back(name(id));
    }
    return failure(fmt::format("there is no layer group \"{}\"", word), {},
                   fmt::format("use one of: {}", fmt::join(names, ", ")));
  });
}

ScriptResult addLayer(Host& host, std::span<const Value> arguments) {
  const Result<std::string> group = text(arguments[1], "group");
  return group ? none(addLayerFromScript(host, arguments[0], *group, arguments[2]))
               : tl::make_unexpected(group.error());
}

ScriptResult deleteLayer(Host& host, std::span<const Value> arguments) {
  return globe(host, arguments[0]).and_then([&](RenderableGlobe* found) -> ScriptResult {
    const Result<std::string> group = text(arguments[1], "group");
    const Result<std::string> layer = identifierOf(arguments[2], "layer");
    if (!group || !layer) {
      return tl::make_unexpected(group ? layer.error() : group.error());
    }
    const Result<void> deleted = found->layers().deleteLayer(*group, *layer);
    // Assets delete all that they added; that one of them was left out has been told.
    return !deleted && found->wasRefused(*layer) ? none({}) : none(deleted);
  });
}

ScriptResult layers(Host& host, std::span<const Value> arguments) {
  return globe(host, arguments[0]).and_then([&](RenderableGlobe* found) -> ScriptResult {
    const Result<LayerGroup*> group = groupOf(*found, arguments[1]);
    if (!group) {
      return tl::make_unexpected(group.error());
    }
    Table identifiers;
    for (const auto& layer : (*group)->layers()) {
      identifiers.list.emplace_back(layer->identifier());
    }
    return std::vector<Value>{Value(std::move(identifiers))};
  });
}

/// The identifier of a layer given by it or by its place (from 0).
Result<std::string> layerAt(const LayerGroup& group, const Value& which) {
  if (const std::optional<double> place = which.number()) {
    if (*place >= 0.0 && *place < static_cast<double>(group.layers().size()) && *place == std::floor(*place)) {
      return group.layers()[static_cast<std::size_t>(*place)]->identifier();
    }
    return failure(fmt::format("there is no layer number {} in {}", *place, name(group.id())));
  }
  return text(which, "layer");
}

ScriptResult moveLayer(Host& host, std::span<const Value> arguments) {
  return globe(host, arguments[0]).and_then([&](RenderableGlobe* found) -> ScriptResult {
    const Result<LayerGroup*> group = groupOf(*found, arguments[1]);
    if (!group) {
      return tl::make_unexpected(group.error());
    }
    const LayerGroup& own = **group;
    const Result<std::string> source = layerAt(own, arguments[2]);
    const Result<std::string> destination = layerAt(own, arguments[3]);
    if (!source || !destination) {
      return tl::make_unexpected(source ? destination.error() : source.error());
    }
    const auto& all = own.layers();
    const auto place =
        std::find_if(all.begin(), all.end(), [&](const auto& layer) { return layer->identifier() == *destination; });
    if (place == all.end()) {
      return failure(fmt::format("there is no layer \"{}\" in {}", *destination, name(own.id())));
    }
    return none(found->layers().moveLayer(name(own.id()), *source, static_cast<int>(place - all.begin())));
  });
}

/// Globes whose map servers are known come first; then the place (from 1) of the first without.
ScriptResult globes(Host& host, const MapServers& servers) {
  std::vector<Value> identifiers;
  for (const std::string& node : host.nodes()) {
    if (dynamic_cast<RenderableGlobe*>(host.renderable(node)) != nullptr) {
      identifiers.emplace_back(node);
    }
  }
  const auto firstWithout = std::stable_partition(
      identifiers.begin(), identifiers.end(), [&](const Value& node) { return !servers.of(*node.string()).empty(); });
  const auto place = static_cast<int>(firstWithout - identifiers.begin()) + 1;
  return std::vector<Value>{Table{{Table{std::move(identifiers), {}}, place}, {}}};
}

}  // namespace

ScriptLibrary makeScriptLibrary(Host& host, MapServers& servers) {
  using Arguments = std::span<const Value>;
  const auto bind = [&host](ScriptResult (*function)(Host&, Arguments)) {
    return [&host, function](Arguments arguments) { return function(host, arguments); };
  };
  ScriptLibrary library{
      "globebrowsing",
      {{"addLayer", "globe, group, table", "Adds a layer to a globe's group", 3, 3, bind(addLayer)},
       {"deleteLayer", "globe, group, layer", "Deletes a layer, given by identifier or by its table", 3, 3,
        bind(deleteLayer)},
       {"layers", "globe, group", "The identifiers of a group's layers, lowest first", 2, 2, bind(layers)},
       {"getLayers", "globe, group", "As layers, by its older name", 2, 2, bind(layers)},
       {"moveLayer", "globe, group, source, destination",
        "Moves a layer to another's place; layers by identifier or by place from 0", 4, 4, bind(moveLayer)},
       {"globes", "", "{ identifiers of all globes, place of the first whose servers are not known }", 0, 0,
        [&host, &servers](Arguments) { return globes(host, servers); }}}};
  for (auto&& functions : {gibsFunctions(host), mapServerFunctions(host, servers), patchFunctions(host),
                           geoJsonFunctions(host), layersFileFunctions(host)}) {
    library.functions.insert(library.functions.end(), functions.begin(), functions.end());
  }
  return library;
}

}  // namespace meridian::globebrowsing
