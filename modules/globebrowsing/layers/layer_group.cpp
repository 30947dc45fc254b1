#include "globebrowsing/layers/layer_group.h"

#include <algorithm>
#include <utility>

namespace meridian::globebrowsing {

namespace {

/// The groups that OpenSpace had until 2017.
constexpr std::array<std::pair<std::string_view, NamedGroup>, 3> olderGroups{{
    {"ColorOverlays", {LayerGroupId::Overlays, BlendMode::Normal}},
    {"GrayScaleLayers", {LayerGroupId::ColorLayers, BlendMode::Normal}},
    {"GrayScaleColorOverlays", {LayerGroupId::ColorLayers, BlendMode::Color}},
}};

template <class Enum, class Names>
std::optional<Enum> fromName(const Names& names, std::string_view name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? std::nullopt : std::optional(static_cast<Enum>(found - names.begin()));
}

}  // namespace

std::string_view name(LayerGroupId group) {
  return layerGroupNames()[static_cast<std::size_t>(group)];
}
std::string_view name(BlendMode mode) {
  return blendModeNames()[static_cast<std::size_t>(mode)];
}
std::string_view name(Adjustment adjustment) {
  return adjustmentNames()[static_cast<std::size_t>(adjustment)];
}
std::string_view name(Sampling sampling) {
  static constexpr std::array<std::string_view, allSamplings.size()> names{"Tile",      "SolidColor", "ColorRelief",
                                                                           "Hillshade", "Slope",      "Isolines"};
  return names[static_cast<std::size_t>(sampling)];
}

const std::vector<std::string>& layerGroupNames() {
  static const std::vector<std::string> names{"HeightLayers", "ColorLayers", "Overlays", "NightLayers", "WaterMasks"};
  return names;
}

const std::vector<std::string>& blendModeNames() {
  static const std::vector<std::string> names{"Normal", "Multiply", "MultiplyMix", "Add", "Subtract", "Color"};
  return names;
}

const std::vector<std::string>& adjustmentNames() {
  static const std::vector<std::string> names{"None", "ChromaKey"};
  return names;
}

std::optional<NamedGroup> layerGroupFromName(std::string_view name) {
  if (const auto group = fromName<LayerGroupId>(layerGroupNames(), name)) {
    return NamedGroup{*group, BlendMode::Normal};
  }
  const auto older =
      std::find_if(olderGroups.begin(), olderGroups.end(), [name](const auto& pair) { return pair.first == name; });
  return older == olderGroups.end() ? std::nullopt : std::optional(older->second);
}

std::optional<BlendMode> blendModeFromName(std::string_view name) {
  return fromName<BlendMode>(blendModeNames(), name);
}

std::optional<Adjustment> adjustmentFromName(std::string_view name) {
  return name == "TransferFunction" ? Adjustment::None : fromName<Adjustment>(adjustmentNames(), name);
}

}  // namespace meridian::globebrowsing
