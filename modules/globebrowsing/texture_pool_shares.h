#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace meridian::globebrowsing {

/// Who gets how much of the texture pool, which all globes share: the globe that looks largest gets three quarters, the
/// others, which are hardly more than discs in the sky, a sixteenth each. Drivers may give memory to the whole pool at
/// once (llvmpipe does), so a full-sized one for every globe in sight would multiply what the user asked for.
/// Render thread only.
class TexturePoolShares {
 public:
  enum class Share : std::uint8_t { Small, Large };
  /// Below that apparent radius in pixels a globe's roots have all the texels that it can show.
  static constexpr double smallRadius = 64.0;

  [[nodiscard]] static constexpr std::size_t bytes(Share share, std::size_t pool) {
    return share == Share::Large ? pool / 4 * 3 : pool / 16;
  }

  void beginFrame() {
    largest_ = candidate_;
    candidate_ = nullptr;
    candidatePixels_ = 0.0;
    ++frame_;
  }

  /// Every globe that is drawn tells its apparent radius each frame, and gets the share that it should have, by the
  /// bids of the last frame; nothing while there are none. The holder of the large share keeps it until another globe
  /// looks a quarter larger, and that one gets it only when the holder has let go, so that there are never two.
  std::optional<Share> bid(const void* globe, double pixels) {
    const bool holds = globe == holder_;
    const double weight = holds ? 1.25 * pixels : pixels;
    if ((pixels >= smallRadius || holds) && weight > candidatePixels_) {
      candidate_ = globe;
      candidatePixels_ = weight;
    }
    if (frame_ < 2) {
      return std::nullopt;
    }
    return globe == largest_ && (holds || holder_ == nullptr) ? Share::Large : Share::Small;
  }

  void hold(const void* globe) { holder_ = globe; }
  void release(const void* globe) {
    if (holder_ == globe) {
      holder_ = nullptr;
    }
  }
  /// After the bids of a frame: whether that globe is to have the large share and does not hold it yet. The holder lets
  /// go once it has filled smaller textures, without waiting for servers, or at once when it is not drawn.
  [[nodiscard]] bool waits(const void* globe) const { return globe == candidate_ && globe != holder_; }
  /// Whether another globe waits for the share that this one holds.
  [[nodiscard]] bool isWaitedFor(const void* globe) const {
    return holder_ == globe && largest_ != nullptr && largest_ != globe;
  }

 private:
  const void* holder_ = nullptr;
  const void* largest_ = nullptr;    ///< by the last frame's bids
  const void* candidate_ = nullptr;  ///< by this frame's
  double candidatePixels_ = 0.0;
  std::uint64_t frame_ = 0;
};

}  // namespace meridian::globebrowsing
