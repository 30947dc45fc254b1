#include "globebrowsing/gpu/fade_watch.h"

#include <algorithm>

namespace meridian::globebrowsing {

void FadeWatch::update(std::span<Layer* const> layers, std::uint64_t frame) {
  bool sameLayers = layers.size() == opacities_.size();
  layers_ = layers;
  bool changed = false;
  opacities_.resize(layers.size());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const LayerOpacity now{layers[i]->version(), static_cast<float>(layers[i]->effectiveOpacity())};
    if (now != opacities_[i]) {
      sameLayers = sameLayers && now.version == opacities_[i].version;
      changed = true;
      mover_ = i;
      opacities_[i] = now;
    }
  }
  mover_ = std::min(mover_, layers.empty() ? 0 : layers.size() - 1);
  const bool rested = frame - lastChange_ > restFrames;
  if (changed && sameLayers) {
    moves_ = changedBefore_ && !rested;
    changedBefore_ = true;
    lastChange_ = frame;
  } else if (rested || layers.empty()) {
    moves_ = false;
  }
}

std::size_t FadeWatch::place(std::uint64_t version) const {
  const auto found = std::find_if(opacities_.begin(), opacities_.end(),
                                  [version](const LayerOpacity& layer) { return layer.version == version; });
  return static_cast<std::size_t>(found - opacities_.begin());
}

bool FadeWatch::mixes(std::uint64_t version) const {
  const std::size_t i = place(version);
  return i < layers_.size() && mixesExactly(layers_, i);
}

float FadeWatch::end(std::uint64_t version, float from) const {
  const std::size_t i = place(version);
  if (i == layers_.size() || opacities_[i].opacity <= from) {
    return 0.0F;
  }
  // Fade multiplies Opacity; whichever of them is less than 1 moves.
  const Layer& layer = *layers_[i];
  return layer.fade.get() < 1.0 ? std::max(static_cast<float>(layer.opacity.get()), opacities_[i].opacity) : 1.0F;
}

}  // namespace meridian::globebrowsing
