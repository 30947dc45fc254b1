#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meridian::globebrowsing {

/// The types of layers that assets may name, numbered as OpenSpace numbers them, and after those ours. Those that have
/// a provider here are in provider_registry.h.
enum class LayerType : std::uint8_t {
  DefaultTileProvider,
  SingleImageProvider,
  ImageSequenceTileProvider,
  SizeReferenceTileProvider,
  TemporalTileProvider,
  TileIndexTileProvider,
  TileProviderByDate,
  TileProviderByIndex,
  TileProviderByLevel,
  SolidColor,
  SpoutImageProvider,
  VideoTileProvider,
  GraticuleTileProvider,
  ColorRelief,
  Hillshade,
  Slope,
  Isolines
};

/// In the order of their numbers.
[[nodiscard]] const std::vector<std::string>& layerTypeNames();
[[nodiscard]] std::string_view name(LayerType type);
/// By the present name or the one up to version 0.19 ("DefaultTileLayer").
[[nodiscard]] std::optional<LayerType> layerTypeFromName(std::string_view name);

}  // namespace meridian::globebrowsing
