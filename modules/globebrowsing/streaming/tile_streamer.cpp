#include "globebrowsing/streaming/tile_streamer.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "globebrowsing/streaming/job_queue.h"
#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

/// Of an entry itself, beside its tile.
constexpr std::size_t entryBytes = 160;

double usable(double priority) {
  return std::isnan(priority) ? std::numeric_limits<double>::lowest() : priority;
}

std::size_t bytesOf(const Error& error) {
  return sizeof(error) + error.what.capacity() + error.where.capacity() + error.remedy.capacity();
}

}  // namespace

TileStreamer::TileStreamer(WorkerPool& workers, Statistics& statistics, const TileStreamerOptions& options)
    : options_(options), statistics_(&statistics), queue_(std::make_shared<JobQueue>(workers)) {}

TileStreamer::~TileStreamer() {
  queue_->close();
}

TileAnswer TileStreamer::answer(const Entry& entry) const {
  if (entry.job != nullptr) {
    TileAnswer pending{TileAnswer::State::Pending};
    const Stream& stream = streams_.at(entry.key.stream);
    pending.isLate = stream.asideFrame + 1 >= frame_ &&
                     (now_ - stream.heard > patience || (entry.job->isAside && now_ - entry.asked > 3 * patience));
    return pending;
  }
  if (entry.error != nullptr) {
    return {TileAnswer::State::Failed, nullptr, entry.error.get()};
  }
  return {TileAnswer::State::Ready, &entry.data};
}

TileAnswer TileStreamer::use(Entries::iterator entry, double priority) {
  if (entry->job != nullptr) {
    entry->job->priority.store(usable(priority), std::memory_order_relaxed);
  } else if (entry->data != nullptr && entry->lastUse + 1 < frame_) {
    ++statistics_->tiles.cacheHits;
  }
  markUsed(entry);
  return answer(*entry);
}

void TileStreamer::markUsed(Entries::iterator entry) {
  entry->lastUse = frame_;
  entries_.splice(entries_.begin(), entries_, entry);
}

TileAnswer TileStreamer::enqueue(const TileKey& key, double priority, std::unique_ptr<TileJob> job) {
  assert(job != nullptr && key.stream != 0);
  Entry& entry = entries_.emplace_front();
  entry.key = key;
  entry.lastUse = frame_;
  places_.emplace(key, entries_.begin());
  entry.job = std::make_shared<QueuedJob>(key, std::move(job), usable(priority));
  entry.pendingPlace = pending_.size();
  pending_.push_back(entries_.begin());
  entry.asked = now_;
  ++streams_[key.stream].pending;
  ++statistics_->tiles.requested;
  queue_->add(entry.job);
  return answer(entry);
}

TileAnswer TileStreamer::peek(const TileKey& key) const {
  const auto place = places_.find(key);
  return place == places_.end() ? TileAnswer{} : answer(*place->second);
}

void TileStreamer::touch(const TileKey& key) {
  if (const auto place = places_.find(key); place != places_.end()) {
    markUsed(place->second);
  }
}

void TileStreamer::drop(const TileKey& key) {
  const auto place = places_.find(key);
  if (place == places_.end()) {
    return;
  }
  if (place->second->job != nullptr) {
    cancel(*place->second);
  }
  erase(place->second);
}

void TileStreamer::forget(std::uint32_t stream) {
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    if (entry->key.stream != stream) {
      ++entry;
      continue;
    }
    if (entry->job != nullptr) {
      cancel(*entry);
    }
    entry = erase(entry);
  }
  streams_.erase(stream);
}

std::size_t TileStreamer::beginFrame() {
  ++frame_;
  queue_->takeFinished(finished_);
  now_ = Clock::now();
  std::size_t taken = 0;
  while (taken < finished_.size()) {
    take(*finished_[taken++]);
    if (std::chrono::duration<double, std::milli>(Clock::now() - now_).count() >= options_.takeMilliseconds) {
      break;
    }
  }
  finished_.erase(finished_.begin(), finished_.begin() + static_cast<std::ptrdiff_t>(taken));
  return taken;
}

void TileStreamer::take(QueuedJob& finished) {
  const auto place = places_.find(finished.key);
  if (place == places_.end() || place->second->job.get() != &finished) {
    return;  // cancelled after it had finished
  }
  Entry& entry = *place->second;
  entry.bytes = entryBytes;
  if (finished.result) {
    entry.data = std::move(*finished.result);
    entry.bytes += entry.data->bytes();
    ++statistics_->tiles.loaded;
    statistics_->tiles.bytes += entry.data->bytes();
    if (finished.flaw) {
      keepError(entry.key.stream, std::make_shared<const Error>(std::move(*finished.flaw)));
    }
  } else {
    entry.error = std::make_shared<const Error>(std::move(finished.result.error()));
    entry.bytes += bytesOf(*entry.error);
    keepError(entry.key.stream, entry.error);
    ++statistics_->tiles.failed;
  }
  bytes_ += entry.bytes;
  streams_[entry.key.stream].heard = now_;
  leavePending(entry);
}

void TileStreamer::keepError(std::uint32_t stream, std::shared_ptr<const Error> error) {
  std::shared_ptr<const Error>& last = streams_[stream].lastError;
  if (last == nullptr) {
    // A damaged file fails in many tiles: one message is enough.
    log::error("{}; more of this layer's tiles may be missing", error->message());
  }
  last = std::move(error);
}

void TileStreamer::leavePending(Entry& entry) {
  entry.job.reset();
  --streams_[entry.key.stream].pending;
  const Entries::iterator last = pending_.back();
  last->pendingPlace = entry.pendingPlace;
  pending_[entry.pendingPlace] = last;
  pending_.pop_back();
}

void TileStreamer::cancel(Entry& entry) {
  queue_->cancel(*entry.job);
  ++statistics_->tiles.cancelled;
  leavePending(entry);
}

TileStreamer::Entries::iterator TileStreamer::erase(Entries::iterator entry) {
  bytes_ -= entry->bytes;
  places_.erase(entry->key);
  return entries_.erase(entry);
}

void TileStreamer::endFrame() {
  for (std::size_t i = pending_.size(); i-- > 0;) {
    // Backwards: leaving swaps the last one, already looked at, into the place.
    if (const Entries::iterator entry = pending_[i]; entry->lastUse != frame_) {
      cancel(*entry);
      erase(entry);
    } else if (entry->job->isAside) {
      Stream& stream = streams_[entry->key.stream];
      if (stream.asideFrame + 1 < frame_) {
        stream.heard = now_;
      }
      stream.asideFrame = frame_;
    }
  }
  queue_->renewPriorities();
  evict();
  statistics_->memory.tileCache = bytes_;
}

void TileStreamer::evict() {
  while (bytes_ > options_.budgetBytes) {
    const auto oldest = std::prev(entries_.end());
    if (oldest->lastUse + 1 >= frame_) {
      return;  // so are all before it
    }
    if (oldest->data.use_count() > 1) {
      markUsed(oldest);  // somebody holds it, so dropping it here would free nothing
    } else {
      erase(oldest);
    }
  }
}

std::size_t TileStreamer::pending(std::uint32_t stream) const {
  const auto found = streams_.find(stream);
  return found == streams_.end() ? 0 : found->second.pending;
}

const Error* TileStreamer::lastError(std::uint32_t stream) const {
  const auto found = streams_.find(stream);
  return found == streams_.end() ? nullptr : found->second.lastError.get();
}

}  // namespace meridian::globebrowsing
