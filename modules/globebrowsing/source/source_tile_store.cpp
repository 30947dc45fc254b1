#include "globebrowsing/source/source_tile_store.h"

#include <algorithm>
#include <exception>
#include <list>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

namespace meridian::globebrowsing {

namespace {

/// What tells decoded tiles apart.
std::string keyOf(const TileService& service, PixelKind kind, const TileMatrix& matrix, const FetchRequest& request) {
  const auto text = [](const std::optional<double>& value) { return value ? fmt::format("{}", *value) : "-"; };
  std::string key =
      fmt::format("{} {} {} {}x{} {} {} {} {} {}\n{}", static_cast<int>(kind), static_cast<int>(service.encoding),
                  service.bands, matrix.tileWidth, matrix.tileHeight, text(service.noData), service.isNoDataTransparent,
                  text(service.heightScale), text(service.heightOffset), service.isExceptionEmpty, request.url);
  for (const std::string& header : request.headers) {
    key.append("\n").append(header);
  }
  return key;
}

TileResult<SourceTilePointer> decodeGuarded(const TileDecoder& decode, const TileService& service, std::size_t matrix,
                                            PixelKind kind, const Fetched& fetched) {
  try {
    return decode(service, matrix, kind, fetched);
  } catch (const std::exception& exception) {
    return failure(std::string("decoding threw: ") + exception.what());
  } catch (...) {
    return failure("decoding threw something that is no exception");
  }
}

SourceTileAnswer failed(const Error& error) {
  return {nullptr, error};
}

TileResult<SourceTilePointer> checked(SourceTilePointer tile, PixelKind kind, const TileMatrix& matrix) {
  if (tile == nullptr) {
    return tile;
  }
  const auto pixels = static_cast<std::size_t>(tile->width) * static_cast<std::size_t>(tile->height);
  const std::size_t given = kind == PixelKind::Colours ? tile->rgba.size() / sizeof(Rgba) : tile->heights.size();
  if (tile->width != matrix.tileWidth || tile->height != matrix.tileHeight || given != pixels) {
    return ownFailure(fmt::format("the tile is of {} x {} pixels instead of {} x {}", tile->width, tile->height,
                                  matrix.tileWidth, matrix.tileHeight),
                      {}, "correct the tile size in the service's description");
  }
  return tile;
}

}  // namespace

/// Everything that callbacks and wants may need after the store is gone.
///
/// Pending fetches are destroyed, and wants woken, under no lock: the fetcher may wait for a callback of ours that
/// waits for the lock.
class SourceTileStore::State : public std::enable_shared_from_this<State> {
 public:
  struct Entry;
  using EntryPointer = std::shared_ptr<Entry>;

  /// One want's part; guarded by the state's mutex.
  struct Wanter {
    std::shared_ptr<const TileService> service;  ///< that of a tile may be another, which gives the same
    double priority = 0.0;
    std::size_t missing = 0;
    std::function<void()> settled;
  };

  struct Entry {
    enum class Stage { Fetching, Waiting, Decoding, Done };
    std::string key;
    std::shared_ptr<const TileService> service;
    PixelKind kind = PixelKind::Colours;
    std::size_t matrix = 0;  ///< its place in the service's
    FetchRequest request;
    Stage stage = Stage::Fetching;
    double priority = 0.0;
    std::vector<Wanter*> wanters;
    std::unique_ptr<PendingFetch> fetch;
    Fetched fetched;
    SourceTileAnswer answer;
    std::list<EntryPointer>::iterator place;  ///< in unwanted_, while it is Done and nobody wants it
  };

  /// What must be done after unlocking.
  struct Aftermath {
    std::vector<std::function<void()>> wake;
    std::vector<std::unique_ptr<PendingFetch>> drop;
    std::vector<EntryPointer> start;
    std::size_t tasks = 0;
  };

  State(Parts parts, std::size_t budget) : parts_(std::move(parts)), budget_(budget) {}

  const std::shared_ptr<Fetcher>& fetcher() const { return parts_.fetcher; }

  void close() {
    Aftermath after;
    {
      const std::lock_guard lock(mutex_);
      isClosed_ = true;
      for (const auto& [key, entry] : entries_) {
        dropFetch(*entry, after);
      }
      entries_.clear();
      unwanted_.clear();
      waiting_.clear();
      bytes_ = 0;
    }
  }

  /// Attaches the wanter to its tiles.
  std::vector<EntryPointer> attach(const Request& request, Wanter& wanter) {
    std::vector<EntryPointer> found;
    Aftermath after;
    {
      const std::lock_guard lock(mutex_);
      for (const TileAddress& tile : request.tiles) {
        found.push_back(attachOne(request, tile, wanter, after));
      }
    }
    finish(after);
    return found;
  }

  void detach(const std::vector<EntryPointer>& entries, Wanter& wanter) {
    Aftermath after;
    {
      const std::lock_guard lock(mutex_);
      wanter.settled = nullptr;
      for (const EntryPointer& entry : entries) {
        detachOne(entry, wanter, after);
      }
      evict();
    }
    finish(after);
  }

  void setPriority(const std::vector<EntryPointer>& entries, Wanter& wanter, double priority) {
    const std::lock_guard lock(mutex_);
    if (priority != wanter.priority) {
      wanter.priority = priority;
      for (const EntryPointer& entry : entries) {
        renewPriority(*entry);
      }
    }
  }

  bool isSettled(const Wanter& wanter) const {
    const std::lock_guard lock(mutex_);
    return wanter.missing == 0;
  }

  void setBudget(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    budget_ = bytes;
    evict();
  }

  std::size_t bytes() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
  }

  std::optional<Error> lastFailure(const TileService& service) const {
    const std::lock_guard lock(mutex_);
    for (const auto& [key, entry] : entries_) {
      const bool isWanted = std::any_of(entry->wanters.begin(), entry->wanters.end(),
                                        [&](const Wanter* wanter) { return wanter->service.get() == &service; });
      if (isWanted && entry->stage == Entry::Stage::Fetching && entry->fetch != nullptr) {
        if (std::optional<Error> failure = entry->fetch->lastFailure()) {
          return failure;
        }
      }
    }
    return std::nullopt;
  }

  std::size_t pending() const {
    const std::lock_guard lock(mutex_);
    return static_cast<std::size_t>(std::count_if(
        entries_.begin(), entries_.end(), [](const auto& pair) { return pair.second->stage != Entry::Stage::Done; }));
  }

 private:
  EntryPointer attachOne(const Request& request, const TileAddress& tile, Wanter& wanter, Aftermath& after) {
    const TileMatrix& matrix = request.service->matrices[tile.matrix];
    const bool isOfHeights = request.kind == PixelKind::Heights && request.service->heightUrl;
    FetchRequest fetch{isOfHeights ? request.service->heightUrl(tile) : request.service->url(tile),
                       request.service->headers, request.priority};
    fetch.emptyStatuses = request.service->emptyStatuses;
    std::string key = keyOf(*request.service, request.kind, matrix, fetch);
    EntryPointer& entry = entries_[key];
    if (entry == nullptr) {
      entry = std::make_shared<Entry>();
      entry->key = std::move(key);
      entry->service = request.service;
      entry->kind = request.kind;
      entry->matrix = tile.matrix;
      entry->request = std::move(fetch);
      entry->priority = request.priority;
      after.start.push_back(entry);
    } else if (entry->stage == Entry::Stage::Done && entry->wanters.empty()) {
      unwanted_.erase(entry->place);
    }
    entry->wanters.push_back(&wanter);
    wanter.missing += entry->stage == Entry::Stage::Done ? 0 : 1;
    renewPriority(*entry);
    return entry;
  }

  void detachOne(const EntryPointer& entry, Wanter& wanter, Aftermath& after) {
    const auto own = std::find(entry->wanters.begin(), entry->wanters.end(), &wanter);
    if (own == entry->wanters.end()) {
      return;
    }
    entry->wanters.erase(own);
    if (!entry->wanters.empty()) {
      renewPriority(*entry);
      return;
    }
    if (isClosed_) {
      return;
    }
    if (entry->stage == Entry::Stage::Done && entry->answer.tile != nullptr) {
      entry->place = unwanted_.insert(unwanted_.begin(), entry);
    } else if (entry->stage != Entry::Stage::Decoding) {  // what is being decoded is worth keeping
      dropFetch(*entry, after);
      std::erase(waiting_, entry);
      entries_.erase(entry->key);
    }
  }

  static void renewPriority(Entry& entry) {
    double greatest = entry.wanters.front()->priority;
    for (const Wanter* wanter : entry.wanters) {
      greatest = std::max(greatest, wanter->priority);
    }
    if (greatest != entry.priority) {
      entry.priority = greatest;
      if (entry.fetch != nullptr && entry.stage == Entry::Stage::Fetching) {
        entry.fetch->setPriority(greatest);
      }
    }
  }

  static void dropFetch(Entry& entry, Aftermath& after) {
    if (entry.fetch != nullptr) {
      after.drop.push_back(std::move(entry.fetch));
    }
  }

  bool isCurrent(const EntryPointer& entry) const {
    const auto found = entries_.find(entry->key);
    return found != entries_.end() && found->second == entry;
  }

  /// Under no lock.
  void finish(Aftermath& after) {
    after.drop.clear();
    for (const EntryPointer& entry : after.start) {
      start(entry);
    }
    for (std::size_t i = 0; i < after.tasks; ++i) {
      parts_.post([weak = weak_from_this()] {
        if (const std::shared_ptr<State> self = weak.lock()) {
          self->decodeBest();
        }
      });
    }
    for (const std::function<void()>& wake : after.wake) {
      wake();
    }
  }

  void start(const EntryPointer& entry) {
    std::unique_ptr<PendingFetch> fetch =
        parts_.fetcher->fetch(entry->request, [weak = weak_from_this(), entry](Result<Fetched> result) {
          if (const std::shared_ptr<State> self = weak.lock()) {
            self->fetched(entry, std::move(result));
          }
        });
    const std::lock_guard lock(mutex_);
    if (isCurrent(entry) && entry->stage == Entry::Stage::Fetching) {
      entry->fetch = std::move(fetch);
      if (entry->priority != entry->request.priority) {
        entry->fetch->setPriority(entry->priority);
      }
    }
  }

  /// On a thread of the fetcher's.
  void fetched(const EntryPointer& entry, Result<Fetched> result) {
    Aftermath after;
    {
      const std::lock_guard lock(mutex_);
      if (!isCurrent(entry) || entry->stage != Entry::Stage::Fetching) {
        return;
      }
      if (!result) {
        settle(entry, {nullptr, std::move(result.error())}, after);
      } else if (result->body == nullptr) {
        settle(entry, {}, after);
      } else {
        entry->fetched = std::move(*result);
        entry->stage = Entry::Stage::Waiting;
        waiting_.push_back(entry);
        after.tasks = 1;
      }
    }
    finish(after);
  }

  void decodeBest() {
    EntryPointer entry;
    Aftermath after;
    {
      const std::lock_guard lock(mutex_);
      const auto best = std::max_element(waiting_.begin(), waiting_.end(),
                                         [](const auto& a, const auto& b) { return a->priority < b->priority; });
      if (best == waiting_.end()) {
        return;  // its tile is not wanted any more
      }
      entry = *best;
      waiting_.erase(best);
      entry->stage = Entry::Stage::Decoding;
      dropFetch(*entry, after);
    }
    after.drop.clear();
    auto decoded = decodeGuarded(parts_.decode, *entry->service, entry->matrix, entry->kind, entry->fetched)
                       .and_then([&](SourceTilePointer tile) {
                         return checked(std::move(tile), entry->kind, entry->service->matrices[entry->matrix]);
                       });
    if (decoded && *decoded != nullptr) {
      parts_.fetcher->accept(entry->request, entry->fetched);
    } else if (decoded || !decoded.error().isOurs) {
      parts_.fetcher->reject(entry->request);
    }  // Else whoever corrects the description, or a limit, is to find the tile there.
    if (!decoded && decoded.error().where.empty()) {
      decoded.error().where = entry->request.url;
    }
    {
      const std::lock_guard lock(mutex_);
      entry->fetched = {};
      if (isCurrent(entry)) {
        settle(entry, decoded ? SourceTileAnswer{std::move(*decoded)} : failed(decoded.error()), after);
        evict();
      }
    }
    finish(after);
  }

  void settle(const EntryPointer& entry, SourceTileAnswer answer, Aftermath& after) {
    entry->stage = Entry::Stage::Done;
    entry->answer = std::move(answer);
    bytes_ += entry->answer.tile != nullptr ? entry->answer.tile->bytes() : 0;
    for (Wanter* wanter : entry->wanters) {
      if (--wanter->missing == 0 && wanter->settled) {
        after.wake.push_back(std::exchange(wanter->settled, nullptr));
      }
    }
    if (entry->wanters.empty()) {
      if (entry->answer.tile != nullptr) {
        entry->place = unwanted_.insert(unwanted_.begin(), entry);
      } else {
        entries_.erase(entry->key);
      }
    }
  }

  void evict() {
    for (auto oldest = unwanted_.end(); bytes_ > budget_ && oldest != unwanted_.begin();) {
      --oldest;
      const EntryPointer entry = *oldest;
      if (entry->answer.tile.use_count() == 1) {  // else somebody holds it, so dropping it here would free nothing
        bytes_ -= entry->answer.tile->bytes();
        entries_.erase(entry->key);
        oldest = unwanted_.erase(oldest);
      }
    }
  }

  const Parts parts_;
  mutable std::mutex mutex_;
  std::size_t budget_;
  std::size_t bytes_ = 0;
  bool isClosed_ = false;
  std::unordered_map<std::string, EntryPointer> entries_;
  std::list<EntryPointer> unwanted_;   ///< decoded, most recently wanted first
  std::vector<EntryPointer> waiting_;  ///< to be decoded
};

class SourceTileStore::HeldWant final : public Want {
 public:
  HeldWant(std::shared_ptr<State> state, Request request) : state_(std::move(state)) {
    wanter_.service = request.service;
    wanter_.priority = request.priority;
    wanter_.settled = std::move(request.settled);
    entries_ = state_->attach(request, wanter_);
  }
  HeldWant(const HeldWant&) = delete;
  HeldWant& operator=(const HeldWant&) = delete;
  ~HeldWant() override { state_->detach(entries_, wanter_); }

  void setPriority(double priority) override { state_->setPriority(entries_, wanter_, priority); }
  bool isSettled() const override { return state_->isSettled(wanter_); }
  SourceTileAnswer answer(std::size_t number) const override { return entries_[number]->answer; }

 private:
  std::shared_ptr<State> state_;
  State::Wanter wanter_;
  std::vector<State::EntryPointer> entries_;
};

SourceTileStore::SourceTileStore(Parts parts, std::size_t budgetBytes)
    : state_(std::make_shared<State>(std::move(parts), budgetBytes)) {}

SourceTileStore::~SourceTileStore() {
  state_->close();
}

std::unique_ptr<SourceTileStore::Want> SourceTileStore::want(Request request) {
  return std::make_unique<HeldWant>(state_, std::move(request));
}

const std::shared_ptr<Fetcher>& SourceTileStore::fetcher() const {
  return state_->fetcher();
}

void SourceTileStore::setBudget(std::size_t bytes) {
  state_->setBudget(bytes);
}

std::size_t SourceTileStore::bytes() const {
  return state_->bytes();
}

std::optional<Error> SourceTileStore::lastFailure(const TileService& service) const {
  return state_->lastFailure(service);
}

std::size_t SourceTileStore::pending() const {
  return state_->pending();
}

}  // namespace meridian::globebrowsing
