#include "globebrowsing/layers/data_properties.h"

#include <algorithm>
#include <string_view>
#include <tuple>
#include <utility>

namespace meridian::globebrowsing {

namespace {

constexpr int ordinaryTileSize = 512;
constexpr int leastTileSize = 32;
constexpr int greatestTileSize = 2048;

bool hasKey(LayerType type, std::string_view key) {
  const std::vector<Schema::Field>& fields = providerSchema(type).fields();
  return std::any_of(fields.begin(), fields.end(), [&](const Schema::Field& field) { return field.key == key; });
}

}  // namespace

DataProperties::DataProperties(const ProviderRequest& request, LayerType type, const std::function<void()>& changed) {
  for (const auto& [key, name, description] :
       {std::tuple{"FilePath", "File path", "A raster or a map service; the layer is opened anew with it"},
        std::tuple{"FolderPath", "Folder path", "A folder of images; the layer is opened anew with it"}}) {
    const Value* path = request.table.find(key);
    if (hasKey(type, key) && path != nullptr && path->string() != nullptr) {
      properties_.push_back(
          std::make_unique<StringProperty>(Property::Description{key, name, description}, *path->string()));
      properties_.back()->onChange(changed);
    }
  }
  if (hasKey(type, "TilePixelSize")) {
    const Value* size = request.table.find("TilePixelSize");
    const auto pixels = size != nullptr ? size->number().value_or(ordinaryTileSize) : ordinaryTileSize;
    properties_.push_back(std::make_unique<IntProperty>(
        Property::Description{"TilePixelSize", "Tile size", "Kept for scripts; tiles are always 512 pixels wide"},
        static_cast<int>(pixels), leastTileSize, greatestTileSize));
  }
}

void DataProperties::attach(PropertyOwner& layer, PropertyOwner* provider) {
  PropertyOwner& owner = provider != nullptr ? *provider : owner_;
  for (const auto& property : properties_) {
    owner.addProperty(*property);
  }
  if (provider == nullptr && !properties_.empty()) {
    layer.addChild(owner_);
  }
}

void DataProperties::detach(PropertyOwner& layer, PropertyOwner* provider) {
  PropertyOwner& owner = provider != nullptr ? *provider : owner_;
  if (provider == nullptr && !properties_.empty()) {
    layer.removeChild(owner_);
  }
  for (const auto& property : properties_) {
    owner.removeProperty(*property);
  }
}

Value DataProperties::applied(const Value& table) const {
  Table set = *table.table();
  for (const auto& property : properties_) {
    set.fields[property->identifier()] = property->value();
  }
  return set;
}

}  // namespace meridian::globebrowsing
