#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include "globebrowsing/map_servers.h"
#include "globebrowsing/network/fetcher.h"
#include "globebrowsing/streaming/worker_pool.h"

namespace meridian::globebrowsing {

/// Loads what map servers offer: fetches their capabilities (or reads a file) and, where these are lists, the documents
/// that they name (server_documents.h); reads them on workers. Render thread only.
class CapabilitiesLoader {
 public:
  using Done = std::function<void(MapServers::Offer)>;
  /// As long as OpenSpace waits.
  static constexpr std::chrono::seconds longestWait{15};

  /// The workers outlive the loader, and what the fetcher calls.
  CapabilitiesLoader(WorkerPool& workers, std::shared_ptr<Fetcher> fetcher, std::chrono::seconds wait = longestWait)
      : workers_(workers), fetcher_(std::move(fetcher)), wait_(wait) {}
  CapabilitiesLoader(const CapabilitiesLoader&) = delete;
  CapabilitiesLoader& operator=(const CapabilitiesLoader&) = delete;
  ~CapabilitiesLoader();

  /// Begins with the next deliver(), so that where no frame is drawn (--validate) nobody is asked. `done` is called by
  /// a later one, within longestWait, with what is there by then; not at all once the loader is gone.
  void load(const MapServer& server, Done done);
  /// Every frame.
  void deliver();

 private:
  struct Work;
  struct Load {
    MapServer server;
    Done done;
    std::shared_ptr<Work> work;  ///< null until it has begun
    std::chrono::steady_clock::time_point end;
  };
  void begin(Load& load);

  WorkerPool& workers_;
  std::shared_ptr<Fetcher> fetcher_;
  std::chrono::seconds wait_;
  std::vector<Load> loads_;
};

}  // namespace meridian::globebrowsing
