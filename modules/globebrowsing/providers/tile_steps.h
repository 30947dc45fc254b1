#pragma once

#include <cstdint>
#include <limits>
#include <memory>

#include "globebrowsing/providers/tile_provider.h"
#include "host/api/error.h"
#include "host/api/time.h"

namespace meridian::globebrowsing {

/// What a provider whose tiles change shows during a stretch of time: from `begin` until before `end`, as long as
/// nobody changes its properties.
struct TileStep {
  std::uint64_t id = 0;  ///< equal ids of one provider mean the same tiles
  Time begin{-std::numeric_limits<double>::infinity()};
  Time end{std::numeric_limits<double>::infinity()};
  Time instant{-std::numeric_limits<double>::infinity()};  ///< that the tiles are of; as a rule `begin`
};

/// The steps of a provider whose tiles change with time or with properties. Each step is a provider of its own, with a
/// stream of its own in the TileStreamer, so that the tiles of several can be in memory side by side.
/// Render thread only (properties are read), once the provider is open. No input or output.
class TileSteps {
 public:
  TileSteps() = default;
  TileSteps(const TileSteps&) = delete;
  TileSteps& operator=(const TileSteps&) = delete;
  virtual ~TileSteps() = default;

  /// Which is shown then. Every frame; allocates nothing.
  [[nodiscard]] virtual TileStep at(const Time& now) const = 0;
  /// The provider of at(now)'s tiles; usually unopened, and never one with steps.
  [[nodiscard]] virtual Result<std::shared_ptr<TileProvider>> make(const Time& now) const = 0;
  /// Whether between the instants of two steps their mixture is wanted.
  [[nodiscard]] virtual bool interpolates() const { return false; }
};

/// A provider that has no tiles but those of its steps.
class SteppedTileProvider : public TileProvider, public TileSteps {
 public:
  [[nodiscard]] const TileSteps* steps() const override { return this; }

 private:
  [[nodiscard]] Result<ColourPixels> makeColours(const Tiling& tiling, const TileIndex& index,
                                                 std::stop_token stop) const final;
  [[nodiscard]] Result<HeightPixels> makeHeights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                                 std::stop_token stop) const final;
  [[nodiscard]] bool dataOverlap(const Tiling&, const TileIndex&) const final { return false; }
  [[nodiscard]] bool dataFiner(const Tiling&, const TileIndex&, const TileLayout&) const final { return false; }
};

/// Mixes ids of steps into one.
[[nodiscard]] constexpr std::uint64_t combineIds(std::uint64_t a, std::uint64_t b) {
  // The golden ratio's bits, and two shifts, spread small numbers over the word.
  return a ^ (b + 0x9E3779B97F4A7C15ull + (a << 6) + (a >> 2));
}

}  // namespace meridian::globebrowsing
