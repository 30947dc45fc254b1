#pragma once

#include <vector>

#include "globebrowsing/providers/provider_registry.h"
#include "globebrowsing/source/tile_settings.h"

namespace meridian::globebrowsing {

/// The keys of a layer's table `Tiles`: what its map service does not say of its tiles.
[[nodiscard]] const Schema& tilesSchema();

/// Reads it; empty settings where there is none. No input or output. Errors: a wrong type or name, FirstLevel greater
/// than LastLevel, an extent that is empty or off the map, ExtentDegrees beside it.
[[nodiscard]] Result<TileSettings> readTiles(const ProviderRequest& request);
/// That they suit a FilePath: those of URL templates are of nothing else.
[[nodiscard]] Result<void> checkTiles(const TileSettings& settings, const std::string& filePath,
                                      const std::string& where);

/// A key that is none of the schema's, with the place of its table: "Layers.HeightLayers[1].Tiles".
struct UnknownTilesKey {
  UnknownKey key;
  std::string where;
};
/// Those of every table `Tiles` within the layer's table: inner providers may have one of their own.
[[nodiscard]] std::vector<UnknownTilesKey> unknownTilesKeys(const ProviderRequest& request);

}  // namespace meridian::globebrowsing
