#include "globebrowsing/script_library.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "globebrowsing/renderable_globe.h"

namespace meridian::globebrowsing {

namespace {

Result<std::string> text(const Value& value, std::string_view argument) {
  if (const std::string* found = value.string()) {
    return *found;
  }
  return failure(fmt::format("{} must be a string, found {}", argument, kindName(value.kind())));
}

/// The globe of the first argument, or the error that a script gets.
Result<RenderableGlobe*> globe(Host& host, const Value& node) {
  return text(node, "globe").and_then([&](const std::string& identifier) -> Result<RenderableGlobe*> {
    if (auto* found = dynamic_cast<RenderableGlobe*>(host.renderable(identifier))) {
      return found;
    }
    return failure(fmt::format("there is no globe \"{}\"", identifier), {},
                   "openspace.globebrowsing.globes() lists those there are");
  });
}

/// A globe's group by any of its names, or the error that a script gets.
Result<LayerGroup*> groupOf(RenderableGlobe& globe, const Value& group) {
  return text(group, "group").and_then([&](const std::string& word) -> Result<LayerGroup*> {
    if (const std::optional<NamedGroup> named = layerGroupFromName(word)) {
      return &globe.layers().group(named->group);
    }
    std::vector<std::string_view> names;
    for (const LayerGroupId id : allLayerGroups) {
      names.push_back(name(id));
    }
    return failure(fmt::format("there is no layer group \"{}\"", word), {},
                   fmt::format("use one of: {}", fmt::join(names, ", ")));
  });
}

ScriptResult nothing() {
  return std::vector<Value>{};
}

ScriptResult addLayer(Host& host, std::span<const Value> arguments) {
  return globe(host, arguments[0]).and_then([&](RenderableGlobe* found) -> ScriptResult {
    const Result<std::string> group = text(arguments[1], "group");
    if (!group) {
      return tl::make_unexpected(group.error());
    }
    const Result<Layer*> added = found->layers().addLayer(*group, {arguments[2], "addLayer", *group, {}});
    return added ? nothing() : tl::make_unexpected(added.error());
  });
}

ScriptResult deleteLayer(Host& host, std::span<const Value> arguments) {
  return globe(host, arguments[0]).and_then([&](RenderableGlobe* found) -> ScriptResult {
    const Value* named = arguments[2].isTable() ? arguments[2].find("Identifier") : &arguments[2];
    const Result<std::string> group = text(arguments[1], "group");
    const Result<std::string> layer = text(named != nullptr ? *named : Value(), "layer");
    if (!group || !layer) {
      return tl::make_unexpected(group ? layer.error() : group.error());
    }
    const Result<void> deleted = found->layers().deleteLayer(*group, *layer);
    return deleted ? nothing() : tl::make_unexpected(deleted.error());
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
    const Result<void> moved =
        found->layers().moveLayer(name(own.id()), *source, static_cast<int>(place - all.begin()));
    return moved ? nothing() : tl::make_unexpected(moved.error());
  });
}

ScriptResult globes(Host& host) {
  Table identifiers;
  for (const std::string& node : host.nodes()) {
    if (dynamic_cast<RenderableGlobe*>(host.renderable(node)) != nullptr) {
      identifiers.list.emplace_back(node);
    }
  }
  return std::vector<Value>{Value(std::move(identifiers))};
}

}  // namespace

ScriptLibrary makeScriptLibrary(Host& host) {
  using Arguments = std::span<const Value>;
  const auto bind = [&host](ScriptResult (*function)(Host&, Arguments)) {
    return [&host, function](Arguments arguments) { return function(host, arguments); };
  };
  return {"globebrowsing",
          {{"addLayer", "globe, group, table", "Adds a layer to a globe's group", 3, 3, bind(addLayer)},
           {"deleteLayer", "globe, group, layer", "Deletes a layer, given by identifier or by its table", 3, 3,
            bind(deleteLayer)},
           {"layers", "globe, group", "The identifiers of a group's layers, lowest first", 2, 2, bind(layers)},
           {"getLayers", "globe, group", "As layers, by its older name", 2, 2, bind(layers)},
           {"moveLayer", "globe, group, source, destination",
            "Moves a layer to another's place; layers by identifier or by place from 0", 4, 4, bind(moveLayer)},
           {"globes", "", "The identifiers of all globes", 0, 0, [&host](Arguments) { return globes(host); }}}};
}

}  // namespace meridian::globebrowsing
