#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "globebrowsing/providers/layer_type.h"
#include "globebrowsing/providers/tile_provider.h"
#include "host/api/error.h"
#include "host/api/schema.h"
#include "host/api/value.h"

namespace meridian::globebrowsing {

class SeriesShare;
class SourceTileStore;

/// What a provider is made from.
struct ProviderRequest {
  Value table;         ///< the layer's table; the provider's keys lie flat among the layer's own
  std::string where;   ///< file and line of the asset, for errors
  std::string path;    ///< of the table within the asset: "Renderable.Layers.ColorLayers.Blue"
  std::string folder;  ///< of the asset file; relative paths start there
  /// Where the tiles of map services come from; null where nothing is fetched (--validate).
  std::shared_ptr<SourceTileStore> sourceTiles{};
  std::shared_ptr<SeriesShare> share{};  ///< of the steps of a series; else null
  HeightLimits heightLimits{};           ///< of the globe; heights beyond are no data
};

/// The place of a key for errors: "earth.asset:12: Renderable.Layers.ColorLayers.Blue.FilePath".
[[nodiscard]] std::string placeOf(const ProviderRequest& request, std::string_view key);

/// One type of provider. To add one: write the class, add its line in provider_registry.cpp.
struct ProviderType {
  LayerType type = LayerType::DefaultTileProvider;
  std::string description;
  const Schema* schema = nullptr;  ///< of the provider's own keys
  /// Gets a table that has passed the schema. No input or output.
  Result<std::shared_ptr<TileProvider>> (*make)(const ProviderRequest& request) = nullptr;
};

[[nodiscard]] std::span<const ProviderType> providerTypes();

/// Of that type's own keys; it has a provider.
[[nodiscard]] const Schema& providerSchema(LayerType type);

/// The type that the table's `Type` names; DefaultTileProvider without one. Errors: an unknown type, or one that has no
/// provider here; the remedy lists those that have.
[[nodiscard]] Result<LayerType> layerTypeOf(const ProviderRequest& request);

/// Checks the table against its type's schema and makes the provider, unopened.
[[nodiscard]] Result<std::shared_ptr<TileProvider>> makeProvider(const ProviderRequest& request);

}  // namespace meridian::globebrowsing
