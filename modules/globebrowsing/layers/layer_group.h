#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace meridian::globebrowsing {

/// The groups of a globe's layers, in the order in which a fragment meets them.
enum class LayerGroupId : std::uint8_t { HeightLayers, ColorLayers, Overlays, NightLayers, WaterMasks };
inline constexpr std::size_t layerGroupCount = 5;
inline constexpr std::array<LayerGroupId, layerGroupCount> allLayerGroups{
    LayerGroupId::HeightLayers, LayerGroupId::ColorLayers, LayerGroupId::Overlays, LayerGroupId::NightLayers,
    LayerGroupId::WaterMasks};

/// How a layer is put onto what lies below it; blend.h has the formulas.
enum class BlendMode : std::uint8_t { Normal, Multiply, MultiplyMix, Add, Subtract, Color };
/// What is done to a layer's colours before its settings.
enum class Adjustment : std::uint8_t { None, ChromaKey };
/// Where a layer's colours come from; heights are always tiles.
enum class Sampling : std::uint8_t { Tile, SolidColor, ColorRelief, Hillshade, Slope, Isolines };
inline constexpr std::array<Sampling, 6> allSamplings{Sampling::Tile,      Sampling::SolidColor, Sampling::ColorRelief,
                                                      Sampling::Hillshade, Sampling::Slope,      Sampling::Isolines};
/// Whether they are made from the composed heights.
[[nodiscard]] constexpr bool isRelief(Sampling sampling) {
  return sampling >= Sampling::ColorRelief;
}

/// As assets and scripts write them: "ColorLayers", "MultiplyMix", "ChromaKey".
[[nodiscard]] std::string_view name(LayerGroupId group);
[[nodiscard]] std::string_view name(BlendMode mode);
[[nodiscard]] std::string_view name(Adjustment adjustment);
[[nodiscard]] std::string_view name(Sampling sampling);
[[nodiscard]] const std::vector<std::string>& layerGroupNames();
[[nodiscard]] const std::vector<std::string>& blendModeNames();
[[nodiscard]] const std::vector<std::string>& adjustmentNames();

/// A group by its present or one of its older names.
struct NamedGroup {
  LayerGroupId group = LayerGroupId::ColorLayers;
  BlendMode blendMode = BlendMode::Normal;  ///< of its layers that name none
};
[[nodiscard]] std::optional<NamedGroup> layerGroupFromName(std::string_view name);
[[nodiscard]] std::optional<BlendMode> blendModeFromName(std::string_view name);
/// "TransferFunction", which never did anything, is None.
[[nodiscard]] std::optional<Adjustment> adjustmentFromName(std::string_view name);

}  // namespace meridian::globebrowsing
