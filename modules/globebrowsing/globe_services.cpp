#include "globebrowsing/globe_services.h"

#include <algorithm>

#include "globebrowsing/source/tile_decoder.h"

namespace meridian::globebrowsing {

namespace {

constexpr std::size_t mebibyte = std::size_t{1} << 20;
constexpr int mostCacheMebibytes = 1 << 24;
/// Of the tile cache's size: what services' own tiles may take besides.
constexpr std::size_t sourceTileShare = 4;

NetworkOptions networkOptions(const std::filesystem::path& cacheFolder) {
  NetworkOptions options;
  options.cache.folder = cacheFolder.empty() ? cacheFolder : cacheFolder / "http";
  return withEnvironment(std::move(options));
}

int mebibytes(std::uint64_t bytes) {
  return static_cast<int>(std::min<std::uint64_t>(bytes / mebibyte, mostCacheMebibytes));
}

}  // namespace

GlobeServices::GlobeServices(PropertyOwner& owner, Statistics& statistics, const std::filesystem::path& cacheFolder)
    : GlobeServices(owner, statistics, networkOptions(cacheFolder)) {}

GlobeServices::GlobeServices(PropertyOwner& owner, Statistics& statistics, const NetworkOptions& network)
    : networkCacheMode({"NetworkCacheMode", "Network cache", "What is done with the cache of the network on disk"},
                       {"read-write", "cache-only", "read-only", "off"}, static_cast<int>(network.cache.mode)),
      networkCacheSize({"NetworkCacheSize", "Network cache size", "On disk, in MiB; 0 keeps nothing"},
                       mebibytes(network.cache.maximumBytes), 0, mostCacheMebibytes),
      statistics_(statistics),
      fetcher_(std::make_shared<OnDemandFetcher>(network)),
      sourceTiles_(std::make_shared<SourceTileStore>(
          SourceTileStore::Parts{fetcher_,
                                 [this](std::function<void()> work) {
                                   workers_.post([work = std::move(work)](const std::stop_token&) { work(); });
                                 },
                                 decodeTile})),
      capabilities_(workers_, fetcher_),
      streamer_(workers_, statistics) {
  for (Property* property : std::initializer_list<Property*>{&tileCacheSize, &texturePoolSize, &compositionBudget,
                                                             &networkCacheMode, &networkCacheSize}) {
    owner.addProperty(*property);
  }
  const auto setBudget = [this] {
    const std::size_t bytes = static_cast<std::size_t>(tileCacheSize.get()) * mebibyte;
    streamer_.setBudget(bytes);
    sourceTiles_->setBudget(bytes / sourceTileShare);
  };
  setBudget();
  tileCacheSize.onChange(setBudget);
  networkCacheMode.onChange([this] { fetcher_->setCacheMode(static_cast<CacheMode>(networkCacheMode.get())); });
  networkCacheSize.onChange(
      [this] { fetcher_->setCacheSize(static_cast<std::uint64_t>(networkCacheSize.get()) * mebibyte); });
}

GlobeServices::~GlobeServices() {
  fetcher_->close();
}

void GlobeServices::enterFrame(std::uint64_t frame) {
  if (frame != frame_) {
    streamer_.endFrame();
    statistics_.memory.tileCache += sourceTiles_->bytes();
    streamer_.beginFrame();
    statistics_.chunks = {};
    statistics_.memory.texturePool = 0;
    poolShares_.beginFrame();
    capabilities_.deliver();
    frame_ = frame;
  }
}

}  // namespace meridian::globebrowsing
