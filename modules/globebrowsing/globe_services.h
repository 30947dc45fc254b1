#pragma once

#include <cstdint>

#include "globebrowsing/streaming/tile_streamer.h"
#include "globebrowsing/streaming/worker_pool.h"
#include "globebrowsing/texture_pool_shares.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"
#include "host/api/statistics.h"

namespace meridian::globebrowsing {

/// What all globes share: workers, the request queue with its memory cache, and the budgets, which are the module's
/// properties. Render thread only.
class GlobeServices {
 public:
  /// Adds the budgets to `owner`; both arguments outlive the services.
  GlobeServices(PropertyOwner& owner, Statistics& statistics);

  [[nodiscard]] WorkerPool& workers() { return workers_; }
  [[nodiscard]] TileStreamer& streamer() { return streamer_; }
  [[nodiscard]] TexturePoolShares& poolShares() { return poolShares_; }
  [[nodiscard]] Statistics& statistics() { return statistics_; }

  /// Every globe calls this first in its update: the first call of a frame ends the last frame of the streamer and
  /// begins the next, so that what no globe asked for is cancelled, and empties the gauges that globes add to:
  /// chunks and texture pool.
  void enterFrame(std::uint64_t frame);

  IntProperty tileCacheSize{{"TileCacheSize", "Tile cache", "Of decoded tiles in memory, in MiB"}, 512, 16, 65536};
  IntProperty texturePoolSize{
      {"TexturePoolSize", "Texture pool",
       "On the graphics card, in MiB: three quarters for the globe that looks largest, a sixteenth for each other"},
      512,
      64,
      65536};
  FloatProperty compositionBudget{
      {"CompositionBudget", "Composition budget", "Of blending layers in a frame, in milliseconds"}, 2.0, {0.1, 100.0}};

 private:
  Statistics& statistics_;
  WorkerPool workers_;
  TileStreamer streamer_;
  TexturePoolShares poolShares_;
  std::uint64_t frame_ = ~std::uint64_t{0};
};

}  // namespace meridian::globebrowsing
