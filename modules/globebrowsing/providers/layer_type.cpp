#include "globebrowsing/providers/layer_type.h"

#include <algorithm>
#include <array>
#include <utility>

namespace meridian::globebrowsing {

namespace {

/// The names up to version 0.19, for those that were renamed.
constexpr std::array<std::pair<std::string_view, LayerType>, 10> olderNames{{
    {"DefaultTileLayer", LayerType::DefaultTileProvider},
    {"SingleImageTileLayer", LayerType::SingleImageProvider},
    {"ImageSequenceTileLayer", LayerType::ImageSequenceTileProvider},
    {"SizeReferenceTileLayer", LayerType::SizeReferenceTileProvider},
    {"TemporalTileLayer", LayerType::TemporalTileProvider},
    {"TileIndexTileLayer", LayerType::TileIndexTileProvider},
    {"ByIndexTileLayer", LayerType::TileProviderByIndex},
    {"ByLevelTileLayer", LayerType::TileProviderByLevel},
    {"SpoutImageTileLayer", LayerType::SpoutImageProvider},
    {"VideoTileLayer", LayerType::VideoTileProvider},
}};

}  // namespace

const std::vector<std::string>& layerTypeNames() {
  static const std::vector<std::string> names{"DefaultTileProvider",
                                              "SingleImageProvider",
                                              "ImageSequenceTileProvider",
                                              "SizeReferenceTileProvider",
                                              "TemporalTileProvider",
                                              "TileIndexTileProvider",
                                              "TileProviderByDate",
                                              "TileProviderByIndex",
                                              "TileProviderByLevel",
                                              "SolidColor",
                                              "SpoutImageProvider",
                                              "VideoTileProvider",
                                              "GraticuleTileProvider",
                                              "ColorRelief",
                                              "Hillshade",
                                              "Slope",
                                              "Isolines"};
  return names;
}

std::string_view name(LayerType type) {
  return layerTypeNames()[static_cast<std::size_t>(type)];
}

std::optional<LayerType> layerTypeFromName(std::string_view name) {
  const std::vector<std::string>& names = layerTypeNames();
  if (const auto found = std::find(names.begin(), names.end(), name); found != names.end()) {
    return static_cast<LayerType>(found - names.begin());
  }
  const auto older =
      std::find_if(olderNames.begin(), olderNames.end(), [name](const auto& pair) { return pair.first == name; });
  return older == olderNames.end() ? std::nullopt : std::optional(older->second);
}

}  // namespace meridian::globebrowsing
