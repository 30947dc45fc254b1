#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "globebrowsing/providers/provider_registry.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::globebrowsing {

/// The keys that say where a layer's data are, as properties below its TileProvider: FilePath and FolderPath as far as
/// its table has them, and TilePixelSize as far as its type does. They stay when the provider is made anew. Render
/// thread only.
class DataProperties {
 public:
  /// `changed`: after a path was set; the provider is then to be made from applied().
  DataProperties(const ProviderRequest& request, LayerType type, const std::function<void()>& changed);

  /// Below the provider's own owner, or where it has none below one of that name. `layer` outlives both.
  void attach(PropertyOwner& layer, PropertyOwner* provider);
  /// Before that owner goes.
  void detach(PropertyOwner& layer, PropertyOwner* provider);
  /// The layer's table with what was set.
  [[nodiscard]] Value applied(const Value& table) const;

 private:
  std::vector<std::unique_ptr<Property>> properties_;
  PropertyOwner owner_{"TileProvider", "Tile provider", "Where the layer's data are"};
};

}  // namespace meridian::globebrowsing
