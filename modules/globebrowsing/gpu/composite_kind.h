#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "globebrowsing/layers/layer_group.h"

namespace meridian::globebrowsing {

/// What a fragment gets composed: one array layer of the composites each, made from one layer group.
enum class CompositeKind : std::uint8_t { Base, Night, Overlay };
inline constexpr std::size_t compositeKindCount = 3;
inline constexpr std::array<CompositeKind, compositeKindCount> allCompositeKinds{
    CompositeKind::Base, CompositeKind::Night, CompositeKind::Overlay};

[[nodiscard]] constexpr LayerGroupId layerGroup(CompositeKind kind) {
  switch (kind) {
    case CompositeKind::Base:
      return LayerGroupId::ColorLayers;
    case CompositeKind::Night:
      return LayerGroupId::NightLayers;
    case CompositeKind::Overlay:
      return LayerGroupId::Overlays;
  }
  return LayerGroupId::ColorLayers;
}

}  // namespace meridian::globebrowsing
