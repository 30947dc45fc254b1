#pragma once

#include <cstdint>
#include <span>

#include "globebrowsing/layers/layer_opacities.h"

namespace meridian::globebrowsing {

/// Watches the opacities of a composite's layers: which of them moves, as in a fade, so that mixing two composites is
/// better than composing at every opacity. Render thread only; allocates only when layers come.
class FadeWatch {
 public:
  /// A fade is over when its opacity has rested for so many frames.
  static constexpr std::uint64_t restFrames = 30;

  /// Every frame. `layers` are those that are enabled, lowest first.
  void update(std::span<Layer* const> layers, std::uint64_t frame);

  [[nodiscard]] const LayerOpacities& opacities() const { return opacities_; }
  /// Whether some layer's opacity changed more than once of late: a single change is none.
  [[nodiscard]] bool moves() const { return moves_; }
  /// The same, and composites at its opacities are mixtures of two.
  [[nodiscard]] bool mixes() const { return moves_ && mixesExactly(layers_, mover_); }
  /// The layer of that version: whether composites at its opacities are mixtures of two.
  [[nodiscard]] bool mixes(std::uint64_t version) const;
  /// Where a fade of that layer probably ends that has left `from`.
  [[nodiscard]] float end(std::uint64_t version, float from) const;

 private:
  [[nodiscard]] std::size_t place(std::uint64_t version) const;

  std::span<Layer* const> layers_;
  LayerOpacities opacities_;
  std::uint64_t lastChange_ = 0;  ///< a frame
  std::size_t mover_ = 0;         ///< the layer of the last change
  bool changedBefore_ = false;
  bool moves_ = false;
};

}  // namespace meridian::globebrowsing
