#include "globebrowsing/layers/layer_opacities.h"

#include <algorithm>

namespace meridian::globebrowsing {

namespace {

bool has(std::span<const LayerOpacity> opacities, std::uint64_t version) {
  return opacityOf(opacities, version) > 0.0F;
}

/// Whether settings take 0..1 to 0..1.
bool staysInRange(const LayerSettings& settings) {
  const double least = settings.offset;
  const double most = settings.multiplier + settings.offset;
  return std::min(least, most) >= 0.0 && std::max(least, most) <= 1.0;
}

}  // namespace

float opacityOf(std::span<const LayerOpacity> opacities, std::uint64_t version) {
  const auto found = std::find_if(opacities.begin(), opacities.end(),
                                  [version](const LayerOpacity& layer) { return layer.version == version; });
  return found == opacities.end() ? 0.0F : found->opacity;
}

OpacityDifference difference(std::span<const LayerOpacity> a, std::span<const LayerOpacity> b) {
  using Kind = OpacityDifference::Kind;
  OpacityDifference found;
  const auto note = [&](std::uint64_t version, float first, float second) {
    found = {found.kind == Kind::None ? Kind::OneOpacity : Kind::Other, version, first, second};
  };
  std::size_t i = 0;
  std::size_t j = 0;
  while (found.kind != Kind::Other) {
    while (i < a.size() && a[i].opacity <= 0.0F) {
      ++i;
    }
    while (j < b.size() && b[j].opacity <= 0.0F) {
      ++j;
    }
    if (i == a.size() && j == b.size()) {
      break;
    }
    if (i < a.size() && j < b.size() && a[i].version == b[j].version) {
      if (a[i].opacity != b[j].opacity) {
        note(a[i].version, a[i].opacity, b[j].opacity);
      }
      ++i;
      ++j;
    } else if (i < a.size() && !has(b.subspan(j), a[i].version)) {
      note(a[i].version, a[i].opacity, 0.0F);
      ++i;
    } else if (j < b.size() && !has(a.subspan(i), b[j].version)) {
      note(b[j].version, 0.0F, b[j].opacity);
      ++j;
    } else {
      found.kind = Kind::Other;  // in another order
    }
  }
  return found;
}

float mixingWeight(float from, float to, float opacity) {
  return from == to ? 0.0F : (opacity - from) / (to - from);
}

bool mixesExactly(std::span<Layer* const> layers, std::size_t i) {
  const LayerGroupId group = layers[i]->group();
  for (std::size_t j = 0; j < layers.size(); ++j) {
    const Layer& layer = *layers[j];
    if (layer.group() != group) {
      continue;
    }
    const BlendMode mode = layer.blend();
    const bool isOverAlpha = mode == BlendMode::MultiplyMix && group != LayerGroupId::ColorLayers;
    if (mode == BlendMode::Add || mode == BlendMode::Subtract || !staysInRange(layer.settings()) ||
        (j > i && (mode == BlendMode::Color || isOverAlpha))) {
      return false;
    }
  }
  return true;
}

}  // namespace meridian::globebrowsing
