#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "globebrowsing/providers/tile_steps.h"
#include "globebrowsing/streaming/tile_streamer.h"

namespace meridian::globebrowsing {

/// Tiles that a layer shows, has just shown or is going to show: a provider, with streams of its own in the
/// TileStreamer that are forgotten with it. A layer whose tiles never change has a single one. Render thread only.
class LayerStep {
 public:
  /// The streamer outlives it; null: no stream. `source` is the layer's provider.
  LayerStep(std::shared_ptr<TileProvider> tiles, TileStreamer* streamer, const TileProvider* source,
            const TileStep& when = {})
      : tiles_(std::move(tiles)),
        streamer_(streamer),
        stream_(streamer != nullptr ? streamer->newStream() : 0),
        reliefStream_(streamer != nullptr ? streamer->newStream() : 0),
        source_(source),
        when_(when) {}
  LayerStep(const LayerStep&) = delete;
  LayerStep& operator=(const LayerStep&) = delete;
  ~LayerStep() {
    if (streamer_ != nullptr) {
      streamer_->forget(stream_);
      streamer_->forget(reliefStream_);
    }
  }

  /// Where its tiles come from.
  [[nodiscard]] const std::shared_ptr<TileProvider>& tiles() const { return tiles_; }
  [[nodiscard]] std::uint32_t stream() const { return stream_; }
  /// Of its heights in reliefLayout.
  [[nodiscard]] std::uint32_t reliefStream() const { return reliefStream_; }
  /// Whether it could not be opened, or any of its tiles failed or has a flaw.
  [[nodiscard]] bool hasFailed() const {
    return tiles_->state() == TileProvider::State::Failed ||
           (streamer_ != nullptr &&
            (streamer_->lastError(stream_) != nullptr || streamer_->lastError(reliefStream_) != nullptr));
  }
  /// The layer's provider that it was made by; only to be compared.
  [[nodiscard]] const TileProvider* source() const { return source_; }
  [[nodiscard]] const TileStep& when() const { return when_; }

 private:
  std::shared_ptr<TileProvider> tiles_;
  TileStreamer* streamer_;
  std::uint32_t stream_;
  std::uint32_t reliefStream_;
  const TileProvider* source_;
  TileStep when_;
};

using LayerStepPointer = std::shared_ptr<const LayerStep>;

}  // namespace meridian::globebrowsing
