#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "globebrowsing/layers/layer.h"

namespace meridian::globebrowsing {

/// One layer in what was composed, or is to be.
struct LayerOpacity {
  std::uint64_t version = 0;  ///< Layer::version()
  float opacity = 1.0F;       ///< Layer::effectiveOpacity()
  bool operator==(const LayerOpacity&) const = default;
};

/// The enabled layers of a group, or of several, lowest first. A layer that is not there has the opacity 0.
using LayerOpacities = std::vector<LayerOpacity>;

[[nodiscard]] float opacityOf(std::span<const LayerOpacity> opacities, std::uint64_t version);

/// How two compositions differ.
struct OpacityDifference {
  enum class Kind { None, OneOpacity, Other };
  Kind kind = Kind::None;
  std::uint64_t version = 0;  ///< of the layer, if one opacity differs
  float first = 0.0F;         ///< and its opacity in either
  float second = 0.0F;
};
[[nodiscard]] OpacityDifference difference(std::span<const LayerOpacity> a, std::span<const LayerOpacity> b);

/// Where between them the opacity lies: 0 is `from`, 1 is `to`; beyond both less than 0 or more than 1.
[[nodiscard]] float mixingWeight(float from, float to, float opacity);

/// Whether composites at any opacity of layer i are mixtures of those at two opacities, so that a fade need not compose
/// in each frame. `over` is linear in the opacity of the upper layer, in colours multiplied by their alpha, whatever
/// the mode of that layer; so it is in what it is laid on, but for Color and, where that has an alpha of its own,
/// MultiplyMix. What is cut off at 0 and 1 when it is stored is not linear: Add, Subtract and settings that go beyond.
[[nodiscard]] bool mixesExactly(std::span<Layer* const> layers, std::size_t i);

}  // namespace meridian::globebrowsing
