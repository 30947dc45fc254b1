#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <utility>

#include "globebrowsing/capabilities_loader.h"
#include "globebrowsing/network/network_properties.h"
#include "globebrowsing/network/on_demand_fetcher.h"
#include "globebrowsing/providers/path_tokens.h"
#include "globebrowsing/source/source_tile_store.h"
#include "globebrowsing/streaming/tile_streamer.h"
#include "globebrowsing/streaming/worker_pool.h"
#include "globebrowsing/texture_pool_shares.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"
#include "host/api/statistics.h"

namespace meridian::globebrowsing {

/// What all globes share: workers, the network, the request queue with its memory cache, and the budgets, which are the
/// module's properties. Render thread only.
class GlobeServices {
 public:
  /// Adds the budgets and the network's settings to `owner`; it and the statistics outlive the services. What comes
  /// from the network is kept below `cacheFolder`; empty: nowhere.
  GlobeServices(PropertyOwner& owner, Statistics& statistics, const std::filesystem::path& cacheFolder);
  GlobeServices(const GlobeServices&) = delete;
  GlobeServices& operator=(const GlobeServices&) = delete;
  /// Ends the network first: nothing is answered any more, whoever still holds its parts.
  ~GlobeServices();

  [[nodiscard]] WorkerPool& workers() { return workers_; }
  /// Starts nothing until something is fetched.
  [[nodiscard]] const std::shared_ptr<OnDemandFetcher>& fetcher() const { return fetcher_; }
  /// Of all map services; layers hold it.
  [[nodiscard]] const std::shared_ptr<SourceTileStore>& sourceTiles() const { return sourceTiles_; }
  /// Delivers in enterFrame.
  [[nodiscard]] CapabilitiesLoader& capabilities() { return capabilities_; }
  [[nodiscard]] TileStreamer& streamer() { return streamer_; }
  [[nodiscard]] TexturePoolShares& poolShares() { return poolShares_; }
  [[nodiscard]] Statistics& statistics() { return statistics_; }

  /// Looks up path tokens for layers; none are known without it.
  void setTokenFolder(TokenFolder folderOf) { tokenFolder_ = std::move(folderOf); }
  [[nodiscard]] const TokenFolder& tokenFolder() const { return tokenFolder_; }

  /// Grows when the network's settings allow what they did not before, so that what failed may succeed now: servers are
  /// asked again, or larger images decoded. Globes then try again.
  [[nodiscard]] std::uint64_t timesAllowed() const { return timesAllowed_; }

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
  GlobeServices(PropertyOwner& owner, Statistics& statistics, const NetworkOptions& network);
  void setNetwork(const NetworkOptions& options);

  Statistics& statistics_;
  WorkerPool workers_;
  std::shared_ptr<OnDemandFetcher> fetcher_;
  std::shared_ptr<std::atomic<ImageLimits>> imageLimits_;  ///< for workers that decode
  std::shared_ptr<SourceTileStore> sourceTiles_;
  CapabilitiesLoader capabilities_;
  TileStreamer streamer_;
  TexturePoolShares poolShares_;
  TokenFolder tokenFolder_;
  CacheMode cacheMode_;
  std::uint64_t timesAllowed_ = 0;
  NetworkProperties network_;
  std::uint64_t frame_ = ~std::uint64_t{0};
};

}  // namespace meridian::globebrowsing
