#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "globebrowsing/layers/layer_group.h"

namespace meridian::globebrowsing {

/// What a fragment gets composed: one array layer of the composites each. Base holds the colour layers and, as alpha,
/// 1 less what the water masks reflect.
enum class CompositeKind : std::uint8_t { Base, Night, Overlay };
inline constexpr std::size_t compositeKindCount = 3;
inline constexpr std::array<CompositeKind, compositeKindCount> allCompositeKinds{
    CompositeKind::Base, CompositeKind::Night, CompositeKind::Overlay};

inline constexpr std::array<LayerGroupId, 4> composedGroups{LayerGroupId::ColorLayers, LayerGroupId::WaterMasks,
                                                            LayerGroupId::NightLayers, LayerGroupId::Overlays};
/// The groups that a kind is made from, in the order of its layers.
[[nodiscard]] constexpr std::span<const LayerGroupId> layerGroups(CompositeKind kind) {
  switch (kind) {
    case CompositeKind::Base:
      return std::span(composedGroups).first(2);
    case CompositeKind::Night:
      return std::span(composedGroups).subspan(2, 1);
    case CompositeKind::Overlay:
      return std::span(composedGroups).subspan(3, 1);
  }
  return {};
}

}  // namespace meridian::globebrowsing
