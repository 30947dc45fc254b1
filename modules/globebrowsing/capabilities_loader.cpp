#include "globebrowsing/capabilities_loader.h"

#include <mutex>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "globebrowsing/server_documents.h"
#include "globebrowsing/source/document_file.h"

namespace meridian::globebrowsing {

namespace {

/// Before every tile: somebody waits for it.
constexpr double documentPriority = 1e9;

FetchRequest requestFor(const ServerDocuments::Wanted& wanted) {
  FetchRequest request;
  request.url = wanted.url;
  request.priority = documentPriority - static_cast<double>(wanted.number);  // in the order of the lists
  request.maximumBytes = largestDocument;
  request.emptyStatuses = {};
  request.isPatient = false;
  return request;
}

}  // namespace

/// What workers do for a load: they begin the fetches, since the first of a program opens the cache on disk, and read
/// what these bring.
struct CapabilitiesLoader::Work : std::enable_shared_from_this<Work> {
  Work(WorkerPool& pool, std::shared_ptr<Fetcher> asked, MapServer named)
      : workers(pool), fetcher(std::move(asked)), server(std::move(named)), documents(server) {}

  void begin() {
    if (isWebAddress(server.url)) {
      fetch({0, server.url});
    } else {
      put(0, readDocumentFile(server.url).and_then([&](const Fetched& read) {
        return ServerDocuments::read(read, server.url, server.globe);
      }));
    }
  }

  /// What there is, if that is all.
  [[nodiscard]] bool isComplete() {
    const std::lock_guard lock(mutex);
    return documents.isComplete();
  }
  [[nodiscard]] MapServers::Offer offer(const std::string& late) {
    const std::lock_guard lock(mutex);
    return documents.offer(late);
  }
  void giveUp() {
    std::vector<std::unique_ptr<PendingFetch>> cancelled;  // under no lock: they may wait for what takes the lock
    const std::lock_guard lock(mutex);
    isGivenUp = true;
    cancelled.swap(fetches);
  }

 private:
  void fetch(const ServerDocuments::Wanted& wanted) {
    const FetchRequest request = requestFor(wanted);
    // Weakly: the fetcher holds this function, and this holds the fetch.
    std::unique_ptr<PendingFetch> begun = fetcher->fetch(
        request, [&pool = workers, weak = weak_from_this(), request, number = wanted.number](Result<Fetched> answer) {
          pool.post([weak, request, number, answer = std::move(answer)](const std::stop_token&) {
            if (const std::shared_ptr<Work> still = weak.lock()) {
              still->read(request, number, answer);
            }
          });
        });
    const std::lock_guard lock(mutex);
    if (!isGivenUp) {
      fetches.push_back(std::move(begun));
    }
  }

  void read(const FetchRequest& request, std::size_t number, const Result<Fetched>& answer) {
    if (!answer) {
      put(number, tl::make_unexpected(answer.error()));
      return;
    }
    auto entries = ServerDocuments::read(*answer, request.url, server.globe);
    if (entries) {
      fetcher->accept(request, *answer);
    }
    put(number, std::move(entries));
  }

  void put(std::size_t number, Result<std::vector<ServerDocuments::Entry>> entries) {
    std::vector<ServerDocuments::Wanted> wanted;
    {
      const std::lock_guard lock(mutex);
      if (isGivenUp) {
        return;
      }
      wanted = documents.put(number, std::move(entries));
    }
    for (const ServerDocuments::Wanted& each : wanted) {
      fetch(each);
    }
  }

  WorkerPool& workers;
  const std::shared_ptr<Fetcher> fetcher;
  const MapServer server;
  std::mutex mutex;  ///< of all that follows
  ServerDocuments documents;
  std::vector<std::unique_ptr<PendingFetch>> fetches;
  bool isGivenUp = false;
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
  load.work = std::make_shared<Work>(workers_, fetcher_, load.server);
  load.end = std::chrono::steady_clock::now() + wait_;
  workers_.post([work = load.work](const std::stop_token&) { work->begin(); });
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
      open.push_back(std::move(load));
    } else if (load.work->isComplete() || now >= load.end) {
      load.work->giveUp();
      found.emplace_back(std::move(load.done),
                         load.work->offer(fmt::format("did not arrive within {} seconds", wait_.count())));
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
