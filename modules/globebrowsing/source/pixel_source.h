#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "globebrowsing/source/resample.h"
#include "globebrowsing/tiling/tiling.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

/// A tile on its way whose data come from elsewhere, without a thread that waits for them. One thread at a time. What
/// is on its way is dropped with the task.
template <class Pixels>
class PixelTask {
 public:
  virtual ~PixelTask() = default;
  /// Asks for what is missing. Returns whether nothing is: then make() can be called. If not, `wake` is called once,
  /// from any thread, perhaps before this returns; then prepare again. On a worker; does not block.
  [[nodiscard]] virtual bool prepare(double priority, const std::function<void()>& wake) = 0;
  /// A greater one is served first. While it waits; quick.
  virtual void setPriority(double priority) = 0;
  /// Once, on a worker. Errors: data that were needed failed for good, and without them there is nothing.
  [[nodiscard]] virtual Result<Pixels> make(const std::stop_token& stop) = 0;
  /// Why something is missing in what make() gave: the rest is there.
  [[nodiscard]] virtual std::optional<Error> flaw() const = 0;
};
/// That a source has a height which its body cannot have, for flaw().
[[nodiscard]] Error implausibleHeight(double metres, const HeightLimits& limits, const std::string& where);
using ColourTask = PixelTask<ColourPixels>;
using HeightTask = PixelTask<HeightPixels>;

/// Where a layer's pixels come from, brought onto a globe's tiling. Safe from any thread.
class PixelSource {
 public:
  virtual ~PixelSource() = default;

  /// Whether the source reaches into the tile; may be true for a near miss, never false for a hit. No input or output.
  [[nodiscard]] virtual bool overlaps(const Tiling& tiling, const TileIndex& index) const = 0;
  /// Whether the source has pixels within the tile that are finer than the tile's samples. No input or output.
  [[nodiscard]] virtual bool hasDataFiner(const Tiling& tiling, const TileIndex& index,
                                          const TileLayout& layout) const = 0;

  /// The tile at once; blocking. Errors also where it has to be asked for by a task.
  [[nodiscard]] virtual Result<ColourPixels> colours(const Tiling& tiling, const TileIndex& index,
                                                     const TileLayout& layout, std::stop_token stop) const = 0;
  [[nodiscard]] virtual Result<HeightPixels> heights(const Tiling& tiling, const TileIndex& index,
                                                     const TileLayout& layout, std::stop_token stop) const = 0;
  /// The tile by and by; null where it can be had at once. Source and tiling outlive the task.
  [[nodiscard]] virtual std::unique_ptr<ColourTask> colourTask(const Tiling& /*tiling*/, const TileIndex& /*index*/,
                                                               const TileLayout& /*layout*/) const {
    return nullptr;
  }
  [[nodiscard]] virtual std::unique_ptr<HeightTask> heightTask(const Tiling& /*tiling*/, const TileIndex& /*index*/,
                                                               const TileLayout& /*layout*/) const {
    return nullptr;
  }
  /// Why data that were asked for are not there yet, where they are tried again and again.
  [[nodiscard]] virtual std::optional<Error> lastFailure() const { return std::nullopt; }
  /// What was found wrong with data that are shown all the same, for as long as the source; the first of it.
  [[nodiscard]] virtual std::optional<Error> flaw() const { return std::nullopt; }
  /// Whom the data themselves say they are to be credited to, on one line; good as long as the source.
  [[nodiscard]] virtual std::string_view attribution() const { return {}; }
};

}  // namespace meridian::globebrowsing
