#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string_view>

#include "globebrowsing/source/pixel_source.h"
#include "globebrowsing/streaming/worker_pool.h"
#include "globebrowsing/tiling/tiling.h"
#include "host/api/error.h"

namespace meridian {
class PropertyOwner;
}

namespace meridian::globebrowsing {

class TileSteps;
struct ReliefStyle;

/// Where a layer's tiles come from: one class per layer type, made from the layer's asset table without any input or
/// output (provider_registry.h), then checked by --validate or opened by a worker. Safe from any thread.
class TileProvider {
 public:
  enum class State { NotOpened, Opening, Ready, Failed };

  TileProvider() = default;
  TileProvider(const TileProvider&) = delete;
  TileProvider& operator=(const TileProvider&) = delete;
  virtual ~TileProvider() = default;

  /// False for what a shader makes by itself (SolidColor); then colours, heights and overlaps are of no use.
  [[nodiscard]] virtual bool hasTiles() const { return true; }
  /// Of one that colours the heights of the height layers; null for all others. Render thread only; good until the next
  /// call.
  [[nodiscard]] virtual const ReliefStyle* relief() { return nullptr; }
  /// Whether the local data exist, without opening them: what makes a layer usable for --validate.
  [[nodiscard]] virtual Result<void> check() const { return {}; }

  /// Of a provider whose tiles change with time or with its properties; null for all others. Tiles are then asked of
  /// the steps' providers only.
  [[nodiscard]] virtual const TileSteps* steps() const { return nullptr; }
  /// What can be set of it while it runs: the owner "TileProvider" below its layer. Null without any. It is the render
  /// thread's alone, and a layer takes it out of the tree before it lets the provider go.
  [[nodiscard]] virtual PropertyOwner* properties() { return nullptr; }

  [[nodiscard]] State state() const { return state_.load(std::memory_order_acquire); }
  /// Why it could not be opened; nothing unless Failed.
  [[nodiscard]] std::optional<Error> error() const;
  /// Of a Ready one whose data come from elsewhere: why some are not there yet, while they are tried again and again.
  [[nodiscard]] virtual std::optional<Error> lastFailure() const { return std::nullopt; }
  /// Of a Ready one: what was found wrong with data that are shown all the same.
  [[nodiscard]] virtual std::optional<Error> flaw() const { return std::nullopt; }
  /// Whom its data are to be credited to, as far as they say so themselves; empty unless Ready. Good as long as the
  /// provider.
  [[nodiscard]] virtual std::string_view attribution() const { return {}; }

  /// Before open(): asks for what has to be fetched first. Returns whether nothing is missing. If not, `wake` is called
  /// once, from any thread, perhaps before this returns; then prepare again. On a worker; may read from disk, but waits
  /// for no server.
  [[nodiscard]] bool prepare(const std::function<void()>& wake);
  /// Opens unless it is open, on this thread; may read from disk. A call during another's waits for it. The first
  /// outcome stays. Errors also where something had to be fetched first that is not there.
  Result<void> open();
  /// Both on workers, holding none while it waits: Opening at once. A failure is logged, unless nobody wants to read so
  /// many. The workers outlive whatever may wake it.
  static void openOn(WorkerPool& workers, std::shared_ptr<TileProvider> provider, bool logFailure = true);

  /// One tile, colours in colourLayout, by and by: where its data come from elsewhere. Null where colours and heights
  /// give it at once (or an error, when not Ready). Provider and tiling outlive the task.
  [[nodiscard]] std::unique_ptr<ColourTask> colourTask(const Tiling& tiling, const TileIndex& index) const;
  [[nodiscard]] std::unique_ptr<HeightTask> heightTask(const Tiling& tiling, const TileIndex& index,
                                                       const TileLayout& layout) const;
  /// The same at once. Blocking; on a worker. Errors: not Ready; what cannot be read; "cancelled" after a stop; also
  /// where there is a task for it.
  [[nodiscard]] Result<ColourPixels> colours(const Tiling& tiling, const TileIndex& index, std::stop_token stop) const;
  [[nodiscard]] Result<HeightPixels> heights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                             std::stop_token stop) const;

  /// Whether there is anything within the tile; false unless Ready. No input or output.
  [[nodiscard]] bool overlaps(const Tiling& tiling, const TileIndex& index) const;
  /// Whether there is finer data within the tile than its colours (its heights) show; false unless Ready. No input or
  /// output.
  [[nodiscard]] bool hasFinerColours(const Tiling& tiling, const TileIndex& index) const;
  [[nodiscard]] bool hasFinerHeights(const Tiling& tiling, const TileIndex& index) const;
  /// The same of either, for providers that are made of others.
  [[nodiscard]] bool hasFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const;

 private:
  /// As prepare(), before openData().
  [[nodiscard]] virtual bool prepareData(const std::function<void()>& /*wake*/) { return true; }
  /// Called once, before any of the following; those only after it succeeded.
  [[nodiscard]] virtual Result<void> openData() = 0;
  [[nodiscard]] virtual Result<ColourPixels> makeColours(const Tiling& tiling, const TileIndex& index,
                                                         std::stop_token stop) const = 0;
  [[nodiscard]] virtual Result<HeightPixels> makeHeights(const Tiling& tiling, const TileIndex& index,
                                                         const TileLayout& layout, std::stop_token stop) const = 0;
  [[nodiscard]] virtual std::unique_ptr<ColourTask> makeColourTask(const Tiling& /*tiling*/,
                                                                   const TileIndex& /*index*/) const {
    return nullptr;
  }
  [[nodiscard]] virtual std::unique_ptr<HeightTask> makeHeightTask(const Tiling& /*tiling*/, const TileIndex& /*index*/,
                                                                   const TileLayout& /*layout*/) const {
    return nullptr;
  }
  [[nodiscard]] virtual bool dataOverlap(const Tiling& tiling, const TileIndex& index) const = 0;
  [[nodiscard]] virtual bool dataFiner(const Tiling& tiling, const TileIndex& index,
                                       const TileLayout& layout) const = 0;

  static void openWhenPrepared(WorkerPool& workers, const std::shared_ptr<TileProvider>& provider, bool logFailure);
  [[nodiscard]] Result<void> openGuarded();
  [[nodiscard]] Result<void> requireReady() const;

  std::atomic<State> state_{State::NotOpened};
  std::mutex opening_;
  std::optional<Error> error_;  ///< written once, before Failed is published
};

}  // namespace meridian::globebrowsing
