#include "globebrowsing/globe_services.h"

#include <utility>

#include "globebrowsing/source/gdal_network.h"
#include "globebrowsing/source/tile_decoder.h"

namespace meridian::globebrowsing {

namespace {

constexpr std::size_t mebibyte = std::size_t{1} << 20;
/// Of the tile cache's size: what services' own tiles may take besides.
constexpr std::size_t sourceTileShare = 4;

NetworkOptions networkOptions(const std::filesystem::path& cacheFolder) {
  NetworkOptions options;
  options.cache.folder = cacheFolder.empty() ? cacheFolder : cacheFolder / "http";
  return withEnvironment(std::move(options));
}

}  // namespace

GlobeServices::GlobeServices(PropertyOwner& owner, Statistics& statistics, const std::filesystem::path& cacheFolder)
    : GlobeServices(owner, statistics, networkOptions(cacheFolder)) {}

GlobeServices::GlobeServices(PropertyOwner& owner, Statistics& statistics, const NetworkOptions& network)
    : statistics_(statistics),
      fetcher_(std::make_shared<OnDemandFetcher>(network)),
      imageLimits_(std::make_shared<std::atomic<ImageLimits>>(network.images)),
      sourceTiles_(std::make_shared<SourceTileStore>(
          SourceTileStore::Parts{fetcher_,
                                 [this](std::function<void()> work) {
                                   workers_.post([work = std::move(work)](const std::stop_token&) { work(); });
                                 },
                                 [limits = imageLimits_](const TileService& service, std::size_t matrix, PixelKind kind,
                                                         const Fetched& fetched) {
                                   return decodeTileWithin(*limits, service, matrix, kind, fetched);
                                 }})),
      capabilities_(workers_, fetcher_),
      streamer_(workers_, statistics),
      cacheMode_(network.cache.mode),
      network_(owner, network, [this](const NetworkOptions& options) { setNetwork(options); }) {
  for (Property* property : std::initializer_list<Property*>{&tileCacheSize, &texturePoolSize, &compositionBudget}) {
    owner.addProperty(*property);
  }
  const auto setBudget = [this] {
    const std::size_t bytes = static_cast<std::size_t>(tileCacheSize.get()) * mebibyte;
    streamer_.setBudget(bytes);
    sourceTiles_->setBudget(bytes / sourceTileShare);
  };
  setBudget();
  tileCacheSize.onChange(setBudget);
  setGdalNetwork(network);
}

void GlobeServices::setNetwork(const NetworkOptions& options) {
  fetcher_->setOptions(options);
  const ImageLimits images = imageLimits_->exchange(options.images);
  const CacheMode mode = std::exchange(cacheMode_, options.cache.mode);
  setGdalNetwork(options);
  if ((mode == CacheMode::CacheOnly && cacheMode_ != mode) || options.images.side > images.side ||
      options.images.pixels > images.pixels) {
    ++timesAllowed_;
  }
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
