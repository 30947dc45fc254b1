#include "globebrowsing/capabilities_loader.h"

#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "globebrowsing/source/capabilities.h"
#include "globebrowsing/source/document_file.h"
#include "globebrowsing/source/service_asset.h"

namespace meridian::globebrowsing {

namespace {

/// Before every tile: somebody waits for it.
constexpr double documentPriority = 1e9;

/// Layers that an asset can name.
MapServers::Offer offerOf(const Fetched& document, const MapServer& server) {
  if (document.body == nullptr) {
    return failure("there are no capabilities at that address", server.url, "check the address");
  }
  return parseCapabilities(*document.body, server.url).map([&](const Capabilities& capabilities) {
    std::vector<OfferedLayer> offered;
    for (const CapabilitiesLayer& layer : capabilities.layers) {
      if (layer.identifier.empty() || !layer.obstacle.empty()) {
        continue;
      }
      const Result<LayerAsset> asset = assetOf(capabilities, layer, {}, {server.globe});
      const Value* filePath = asset ? asset->table.find("FilePath") : nullptr;
      if (filePath != nullptr && filePath->string() != nullptr) {
        offered.push_back({layer.title.empty() ? layer.identifier : layer.title, *filePath->string()});
      }
    }
    return offered;
  });
}

}  // namespace

/// What a worker found.
struct CapabilitiesLoader::Outcome {
  std::mutex mutex;
  std::optional<MapServers::Offer> offer;

  void put(MapServers::Offer found) {
    const std::lock_guard lock(mutex);
    offer = std::move(found);
  }
  [[nodiscard]] std::optional<MapServers::Offer> take() {
    const std::lock_guard lock(mutex);
    return std::exchange(offer, std::nullopt);
  }
};

void CapabilitiesLoader::load(const MapServer& server, Done done) {
  loads_.push_back({server, std::move(done), nullptr, {}, nullptr});
}

void CapabilitiesLoader::begin(Load& load) {
  load.outcome = std::make_shared<Outcome>();
  load.end = std::chrono::steady_clock::now() + longestWait;
  const MapServer& server = load.server;
  if (!isWebAddress(server.url)) {
    workers_.post([outcome = load.outcome, server](const std::stop_token&) {
      outcome->put(readDocumentFile(server.url).and_then([&](const Fetched& read) { return offerOf(read, server); }));
    });
    return;
  }
  FetchRequest request;
  request.url = server.url;
  request.priority = documentPriority;
  request.maximumBytes = largestDocument;
  request.emptyStatuses = {};
  request.isPatient = false;
  // The fetcher only weakly: it holds this function.
  load.fetch = fetcher_->fetch(request, [&workers = workers_, outcome = load.outcome, server, request,
                                         weak = std::weak_ptr(fetcher_)](Result<Fetched> answer) {
    workers.post([outcome, server, request, weak, answer = std::move(answer)](const std::stop_token&) {
      MapServers::Offer offer = answer ? offerOf(*answer, server) : tl::make_unexpected(answer.error());
      if (const std::shared_ptr<Fetcher> fetcher = weak.lock(); fetcher != nullptr && offer) {
        fetcher->accept(request, *answer);
      }
      outcome->put(std::move(offer));
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
    if (load.outcome == nullptr) {
      begin(load);
    }
    std::optional<MapServers::Offer> offer = load.outcome->take();
    if (!offer && now >= load.end) {
      offer = failure("the capabilities did not arrive within 15 seconds", load.server.url,
                      "check the server, or try again");
    }
    if (offer) {
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
