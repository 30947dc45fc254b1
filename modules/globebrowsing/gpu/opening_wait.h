#pragma once

#include <algorithm>
#include <chrono>
#include <span>

#include "globebrowsing/layers/layer.h"

namespace meridian::globebrowsing {

/// Whether to wait for layers that are being opened: what is made without them is made again as soon as they
/// are open. Local data open within milliseconds; after half a second the rest goes on without them.
class OpeningWait {
 public:
  /// Every frame.
  void update(std::span<Layer* const> enabled) {
    const bool opening =
        std::any_of(enabled.begin(), enabled.end(), [](const Layer* layer) { return layer->isOpening(); });
    const Clock::time_point now = Clock::now();
    if (opening && !opening_) {
      since_ = now;
    }
    opening_ = opening;
    waits_ = opening && now - since_ < patience;
  }
  [[nodiscard]] bool waits() const { return waits_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds patience{500};
  Clock::time_point since_{};
  bool opening_ = false;
  bool waits_ = false;
};

}  // namespace meridian::globebrowsing
