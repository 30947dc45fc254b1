#pragma once

#include <span>
#include <vector>

#include "globebrowsing/layers/blend.h"
#include "globebrowsing/source/resample.h"
#include "globebrowsing/tiling/tiling.h"

namespace meridian::globebrowsing {

/// One height layer's part in a tile.
struct HeightPart {
  const HeightPixels* pixels = nullptr;  ///< null or empty: the layer has nothing there
  LayerSettings settings{};
  double opacity = 1.0;
  /// Of the tile in that of the pixels: of an ancestor, while the tile's own are not there.
  UnitSquareTransform within{};
};

/// The heights that are drawn, culled, picked and answered by heightAt: one tile of them.
struct ComposedHeights {
  std::vector<float> metres;  ///< layout.size() squared, north row first; always finite
  float minimum = 0.0F;       ///< of the tile's interior, without its apron
  float maximum = 0.0F;
};

/// Lays the parts over each other, lowest first: height = mix(below, settings(metres), opacity), where below starts at
/// 0 (the ellipsoid); a part that is not a number there shows what is below. In double; an ancestor's bilinearly.
/// What settings raise beyond the limits is drawn at them. Deterministic per sample, so shared nodes that came in equal
/// go out equal.
[[nodiscard]] ComposedHeights composeHeights(std::span<const HeightPart> parts, const TileLayout& layout,
                                             const HeightLimits& limits = {});

}  // namespace meridian::globebrowsing
