#include "globebrowsing/layers/layer_manager.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace meridian::globebrowsing {

namespace {

std::string_view guiName(LayerGroupId group) {
  switch (group) {
    case LayerGroupId::HeightLayers:
      return "Height Layers";
    case LayerGroupId::ColorLayers:
      return "Color Layers";
    case LayerGroupId::Overlays:
      return "Overlays";
    case LayerGroupId::NightLayers:
      return "Night Layers";
    case LayerGroupId::WaterMasks:
      return "Water Masks";
  }
  return "";
}

Result<NamedGroup> requireGroup(std::string_view group, std::string where) {
  if (const std::optional<NamedGroup> named = layerGroupFromName(group)) {
    return *named;
  }
  return failure(fmt::format("unknown layer group \"{}\"", group), std::move(where),
                 fmt::format("use one of: {}", fmt::join(layerGroupNames(), ", ")));
}

}  // namespace

LayerGroup::LayerGroup(LayerGroupId group)
    : PropertyOwner(std::string(globebrowsing::name(group)), std::string(guiName(group))), id_(group) {
  addProperty(blendTileLevels);
  blendTileLevels.onChange([this] { ++settingsVersion_; });
}

LayerGroup::~LayerGroup() = default;

Layer* LayerGroup::find(std::string_view identifier) const {
  const auto found = place(identifier);
  return found == layers_.end() ? nullptr : found->get();
}

std::vector<std::unique_ptr<Layer>>::const_iterator LayerGroup::place(std::string_view identifier) const {
  return std::find_if(layers_.begin(), layers_.end(),
                      [identifier](const auto& layer) { return layer->identifier() == identifier; });
}

Error LayerGroup::noSuchLayer(std::string_view layer) const {
  return {fmt::format("there is no layer {} in {}", layer, identifier()), uri(), "check the layer's identifier"};
}

Result<Layer*> LayerGroup::add(LayerDescription description, const LayerServices& services) {
  if (child(description.identifier) != nullptr || property(description.identifier) != nullptr) {
    return failure(fmt::format("the name {} is already used in {}", description.identifier, identifier()),
                   placeOf(description.request, "Identifier"), "give the layer another Identifier");
  }
  auto added = std::make_unique<Layer>(std::move(description), id_, services,
                                       [this](Layer& layer, auto change) { changed(layer, change); });
  Layer* layer = added.get();
  layer->setVersion(nextLayerVersion());
  if (!layer->hadZIndex() && !layers_.empty()) {
    const Layer& last = *layers_.back();
    layer->setZIndex(last.hadZIndex() ? last.zIndex() + 1 : last.zIndex());
  }
  const auto above = std::upper_bound(layers_.begin(), layers_.end(), layer->zIndex(),
                                      [](int zIndex, const auto& other) { return zIndex < other->zIndex(); });
  const auto position = static_cast<std::size_t>(above - layers_.begin());
  layers_.insert(above, std::move(added));
  addChild(*layer);
  moveChild(*layer, position);
  restructure();
  return layer;
}

Result<void> LayerGroup::remove(std::string_view identifier) {
  const auto found = place(identifier);
  if (found == layers_.end()) {
    return tl::make_unexpected(noSuchLayer(identifier));
  }
  layers_.erase(found);
  restructure();
  return {};
}

Result<void> LayerGroup::move(std::string_view identifier, int position) {
  const auto found = place(identifier);
  if (found == layers_.end()) {
    return tl::make_unexpected(noSuchLayer(identifier));
  }
  const auto from = found - layers_.begin();
  const auto to = std::clamp<std::ptrdiff_t>(position, 0, std::ssize(layers_) - 1);
  if (from == to) {
    return {};
  }
  Layer& layer = **found;
  layer.moveTo(layers_[static_cast<std::size_t>(to)]->zIndex());
  const auto first = layers_.begin();
  if (from < to) {
    std::rotate(first + from, first + from + 1, first + to + 1);
  } else {
    std::rotate(first + to, first + from, first + from + 1);
  }
  moveChild(layer, static_cast<std::size_t>(to));
  restructure();
  return {};
}

void LayerGroup::update(const Time& now) {
  bool removals = false;
  for (const std::unique_ptr<Layer>& layer : layers_) {
    layer->update(now);
    removals = removals || layer->wantsRemoval();
  }
  if (removals) {
    std::erase_if(layers_, [](const auto& layer) { return layer->wantsRemoval(); });
    restructure();
  }
}

void LayerGroup::changed(Layer& layer, Layer::Change change) {
  const bool isFading = change == Layer::Change::Opacity && id_ != LayerGroupId::HeightLayers;
  if (!isFading && !isToggled(layer)) {
    layer.setVersion(nextLayerVersion());
  }
  if (change == Layer::Change::Structure) {
    restructure();
  } else if (layer.isEnabled() && !isFading) {
    ++settingsVersion_;
  }
}

/// Whether it was enabled or disabled just now: that alone changes nothing about the layer.
bool LayerGroup::isToggled(const Layer& layer) const {
  return layer.isEnabled() != (std::find(enabled_.begin(), enabled_.end(), &layer) != enabled_.end());
}

std::uint64_t LayerGroup::nextLayerVersion() {
  return ++lastLayerVersion_ * layerGroupCount + static_cast<std::uint64_t>(id_);
}

void LayerGroup::restructure() {
  std::vector<Layer*> enabled;
  std::vector<LayerStructure> structure;
  for (const std::unique_ptr<Layer>& layer : layers_) {
    if (layer->isEnabled()) {
      enabled.push_back(layer.get());
      structure.push_back(layer->structure());
    }
  }
  StructureKey key(std::move(structure));
  if (enabled != enabled_ || key != key_) {
    enabled_ = std::move(enabled);
    key_ = std::move(key);
    ++structureVersion_;
    ++settingsVersion_;
  }
}

LayerManager::LayerManager(const LayerServices& services)
    : PropertyOwner("Layers", "Layers", "What is drawn on the globe"), services_(services) {
  for (const LayerGroupId id : allLayerGroups) {
    groups_[static_cast<std::size_t>(id)] = std::make_unique<LayerGroup>(id);
    addChild(group(id));
  }
}

std::string layerName(std::string_view group, const Value& table, std::size_t number) {
  const Value* identifier = table.find("Identifier");
  const std::string* text = identifier == nullptr ? nullptr : identifier->string();
  return text == nullptr || text->empty() ? fmt::format("{}[{}]", group, number) : fmt::format("{}.{}", group, *text);
}

std::vector<RefusedLayer> LayerManager::load(const Value& layers, const std::string& where, const std::string& path,
                                             const std::string& folder) {
  const auto place = [&](const std::string& key) { return placeOf({{}, where, path, folder}, key); };
  if (!layers.isTable()) {
    return {{"Layers",
             {fmt::format("expected a table of layer groups, found {}", kindName(layers.kind())), place({}), {}}}};
  }
  std::vector<RefusedLayer> refused;
  for (const auto& [groupName, value] : layers.table()->fields) {
    const Result<NamedGroup> known = requireGroup(groupName, place(groupName));
    if (!known) {
      refused.push_back({groupName, known.error()});
      continue;
    }
    const Table* table = value.table();
    if (table == nullptr || (table->list.empty() && !table->fields.empty())) {
      refused.push_back({groupName,
                         {fmt::format("expected a list of layers, found {}",
                                      table == nullptr ? kindName(value.kind()) : "a table with names"),
                          place(groupName), "write { { Identifier = ... }, { Identifier = ... } }"}});
      continue;
    }
    for (std::size_t i = 0; i < table->list.size(); ++i) {
      const std::size_t number = i + 1;  // as Lua counts
      const std::string layerPath = (path.empty() ? path : path + '.') + layerName(groupName, table->list[i], number);
      if (Result<Layer*> added = addLayer(groupName, {table->list[i], where, layerPath, folder}); !added) {
        refused.push_back(
            {layerName(globebrowsing::name(known->group), table->list[i], number), std::move(added.error())});
      }
    }
  }
  return refused;
}

Result<Layer*> LayerManager::addLayer(std::string_view groupName, const ProviderRequest& request) {
  const Result<NamedGroup> named = requireGroup(groupName, placeOf(request, {}));
  if (!named) {
    return tl::make_unexpected(named.error());
  }
  ProviderRequest served = request;
  served.sourceTiles = services_.sourceTiles;
  served.table = withTokensReplaced(served.table, services_.tokenFolder);
  served.heightLimits = services_.heightLimits;
  return readLayer(served, named->group, named->blendMode).and_then([&](LayerDescription description) {
    return group(named->group).add(std::move(description), services_);
  });
}

Result<void> LayerManager::deleteLayer(std::string_view groupName, std::string_view identifier) {
  return requireGroup(groupName, uri()).and_then([&](const NamedGroup& named) {
    return group(named.group).remove(identifier);
  });
}

Result<void> LayerManager::moveLayer(std::string_view groupName, std::string_view identifier, int position) {
  return requireGroup(groupName, uri()).and_then([&](const NamedGroup& named) {
    return group(named.group).move(identifier, position);
  });
}

std::size_t LayerManager::layerCount() const {
  std::size_t count = 0;
  for (const auto& group : groups_) {
    count += group->layers().size();
  }
  return count;
}

void LayerManager::retryFailed() {
  for (const auto& group : groups_) {
    for (const std::unique_ptr<Layer>& layer : group->layers()) {
      layer->retryFailed();
    }
  }
}

void LayerManager::update(const Time& now) {
  for (const auto& group : groups_) {
    group->update(now);
  }
}

std::uint64_t LayerManager::structureVersion() const {
  std::uint64_t sum = 0;
  for (const auto& group : groups_) {
    sum += group->structureVersion();
  }
  return sum;
}

}  // namespace meridian::globebrowsing
