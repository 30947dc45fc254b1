#include "globebrowsing/capabilities_loader.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "globebrowsing/source/capabilities.h"
#include "globebrowsing/source/document_file.h"
#include "globebrowsing/source/service_asset.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

/// Before every tile: somebody waits for it.
constexpr double documentPriority = 1e9;

/// What an asset can say of the layer: a table for each style.
Result<std::vector<OfferedLayer::Style>> stylesOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                                  const std::string& globe) {
  std::vector<OfferedLayer::Style> styles;
  const std::size_t count = std::max<std::size_t>(layer.styles.size(), 1);
  for (std::size_t i = 0; i < count; ++i) {
    LayerChoices choices;
    choices.style = i == 0 ? std::string() : layer.styles[i].identifier;
    Result<LayerAsset> asset = assetOf(capabilities, layer, choices, {globe});
    if (!asset) {
      return tl::make_unexpected(std::move(asset.error()));
    }
    std::string name = layer.styles.empty()            ? "default"
                       : layer.styles[i].title.empty() ? layer.styles[i].identifier
                                                       : layer.styles[i].title;
    styles.push_back({std::move(name), std::move(asset->table)});
  }
  return styles;
}

OfferedLayer offeredLayer(const Capabilities& capabilities, const CapabilitiesLayer& layer, const std::string& globe) {
  OfferedLayer offered;
  offered.name = layer.title.empty() ? layer.identifier : layer.title;
  offered.obstacle = layer.obstacle;
  offered.extent = layer.extent;
  offered.times = layer.timeDimension() != nullptr ? layer.timeDimension()->values : std::string();
  offered.attribution = creditText(layer.attribution.empty() ? capabilities.attribution : layer.attribution);
  if (!offered.obstacle.empty()) {
    return offered;
  }
  Result<std::vector<OfferedLayer::Style>> styles = stylesOf(capabilities, layer, globe);
  if (!styles) {
    offered.obstacle = styles.error().what;
    return offered;
  }
  offered.styles = std::move(*styles);
  offered.url = *offered.styles.front().table.find("FilePath")->string();
  return offered;
}

/// All layers but headings.
MapServers::Offer offerOf(const Fetched& document, const MapServer& server) {
  if (document.body == nullptr) {
    return failure("there are no capabilities at that address", server.url, "check the address");
  }
  return parseCapabilities(*document.body, server.url).map([&](const Capabilities& capabilities) {
    std::vector<OfferedLayer> offered;
    for (const CapabilitiesLayer& layer : capabilities.layers) {
      if (!layer.identifier.empty()) {
        offered.push_back(offeredLayer(capabilities, layer, server.globe));
      }
    }
    return offered;
  });
}

}  // namespace

/// What workers do for a load: they begin the fetch, since the first of a program opens the cache on disk, and read
/// what it brings.
struct CapabilitiesLoader::Work {
  std::mutex mutex;
  std::optional<MapServers::Offer> offer;
  std::unique_ptr<PendingFetch> fetch;
  bool isGivenUp = false;

  void put(MapServers::Offer found) {
    const std::lock_guard lock(mutex);
    offer = std::move(found);
  }
  [[nodiscard]] std::optional<MapServers::Offer> take() {
    const std::lock_guard lock(mutex);
    return std::exchange(offer, std::nullopt);
  }
  void hold(std::unique_ptr<PendingFetch> begun) {
    const std::lock_guard lock(mutex);
    if (!isGivenUp) {
      fetch.swap(begun);
    }
  }
  void giveUp() {
    std::unique_ptr<PendingFetch> cancelled;  // under no lock: it may wait for what takes the lock
    const std::lock_guard lock(mutex);
    isGivenUp = true;
    cancelled.swap(fetch);
  }
};

CapabilitiesLoader::~CapabilitiesLoader() {
  for (const Load& load : loads_) {
    if (load.work != nullptr) {
      load.work->giveUp();
    }
  }
}

void CapabilitiesLoader::load(const MapServer& server, Done done) {
  loads_.push_back({server, std::move(done), nullptr, {}});
}

void CapabilitiesLoader::begin(Load& load) {
  load.work = std::make_shared<Work>();
  load.end = std::chrono::steady_clock::now() + longestWait;
  workers_.post(
      [&workers = workers_, work = load.work, server = load.server, fetcher = fetcher_](const std::stop_token&) {
        if (isWebAddress(server.url)) {
          work->hold(fetchFor(workers, work, server, fetcher));
        } else {
          work->put(readDocumentFile(server.url).and_then([&](const Fetched& read) { return offerOf(read, server); }));
        }
      });
}

std::unique_ptr<PendingFetch> CapabilitiesLoader::fetchFor(WorkerPool& workers, const std::shared_ptr<Work>& work,
                                                           const MapServer& server,
                                                           const std::shared_ptr<Fetcher>& fetcher) {
  FetchRequest request;
  request.url = server.url;
  request.priority = documentPriority;
  request.maximumBytes = largestDocument;
  request.emptyStatuses = {};
  request.isPatient = false;
  // Weakly: the fetcher holds this function, and so does what the work holds.
  return fetcher->fetch(request, [&workers, weakWork = std::weak_ptr(work), server, request,
                                  weakFetcher = std::weak_ptr(fetcher)](Result<Fetched> answer) {
    workers.post([weakWork, server, request, weakFetcher, answer = std::move(answer)](const std::stop_token&) {
      const std::shared_ptr<Work> still = weakWork.lock();
      const std::shared_ptr<Fetcher> fetcherOfIt = weakFetcher.lock();
      if (still == nullptr || fetcherOfIt == nullptr) {
        return;
      }
      MapServers::Offer offer = answer ? offerOf(*answer, server) : tl::make_unexpected(answer.error());
      if (offer) {
        fetcherOfIt->accept(request, *answer);
      }
      still->put(std::move(offer));
    });
  });
}

void CapabilitiesLoader::deliver() {
  if (loads_.empty()) {
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  std::vector<Load> open;
  std::vector<std::pair<Done, MapServers::Offer>> found;
  for (Load& load : loads_) {
    if (load.work == nullptr) {
      begin(load);
    }
    std::optional<MapServers::Offer> offer = load.work->take();
    if (!offer && now >= load.end) {
      offer = failure("the capabilities did not arrive within 15 seconds", load.server.url,
                      "check the server, or try again");
    }
    if (offer) {
      load.work->giveUp();
      found.emplace_back(std::move(load.done), std::move(*offer));
    } else {
      open.push_back(std::move(load));
    }
  }
  loads_ = std::move(open);
  for (auto& [done, offer] : found) {  // last: they may load others
    done(std::move(offer));
  }
}

}  // namespace meridian::globebrowsing
