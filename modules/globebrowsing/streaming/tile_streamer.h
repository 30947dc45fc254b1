#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "globebrowsing/streaming/tile_data.h"
#include "globebrowsing/streaming/tile_job.h"
#include "globebrowsing/streaming/tile_key.h"
#include "globebrowsing/streaming/worker_pool.h"
#include "host/api/error.h"
#include "host/api/statistics.h"

namespace meridian::globebrowsing {

class JobQueue;
struct QueuedJob;

/// What the streamer says about a tile. The pointers are good until endFrame; copy the shared pointer to hold longer.
struct TileAnswer {
  enum class State {
    Absent,   ///< only from peek: neither in memory nor asked for
    Pending,  ///< waits (for a worker, or for data from elsewhere, tried again and again) or runs
    Ready,    ///< `data` is there
    Failed    ///< for good; `error` says why
  };
  State state = State::Absent;
  const TileDataPointer* data = nullptr;
  const Error* error = nullptr;
  /// Pending, and better not waited for: tiles of its stream wait for data from elsewhere, and none has come for
  /// TileStreamer::patience; or this one waits for them, and was asked for three times as long ago. Go on without it,
  /// and ask again.
  bool isLate = false;
};

/// Sizes and limits of a TileStreamer.
struct TileStreamerOptions {
  std::size_t budgetBytes = std::size_t{512} << 20;
  /// Of beginFrame, for taking finished jobs. At least one is taken each frame, however small this is.
  double takeMilliseconds = 1.0;
};

/// Request queue and memory cache of tiles (docs/architecture.md, A tile).
///
/// A frame is beginFrame, any number of requests, endFrame. Whoever wants a tile asks for it every frame with a current
/// priority; workers always take the greatest priority of the moment, ties in the order of asking. What a frame did not
/// ask for is cancelled at its end: dropped if it waits, asked to stop if it runs. A tile is *in use* when it was asked
/// for or touched in this frame or the last, or when somebody holds its pointer; the others are evicted, least recently
/// used first, while the cache is over its budget. What is in use stays even over the budget.
///
/// A failure is for good until the stream is forgotten (or the error, long unused, is evicted like a tile); layers do
/// so when the network's settings allow more than before. Render thread only, but for what jobs do. A frame that asks
/// for nothing new allocates nothing.
class TileStreamer {
 public:
  /// Of a server that works something comes at least now and then.
  static constexpr std::chrono::milliseconds patience{1000};

  /// Both outlive the streamer. Counts into statistics.tiles (a cache hit is a tile that was not in use any more and is
  /// asked for again) and statistics.memory.tileCache.
  TileStreamer(WorkerPool& workers, Statistics& statistics, const TileStreamerOptions& options = {});
  TileStreamer(const TileStreamer&) = delete;
  TileStreamer& operator=(const TileStreamer&) = delete;
  /// Cancels everything and waits for jobs that run.
  ~TileStreamer();

  /// Never given before, never 0.
  [[nodiscard]] std::uint32_t newStream() { return ++lastStream_; }

  /// `makeJob()` gives a std::unique_ptr<TileJob>; it is called only when the tile is neither in memory nor pending.
  /// Any finite priority; a greater one is served first.
  template <class MakeJob>
  TileAnswer request(const TileKey& key, double priority, MakeJob&& makeJob) {
    if (const auto place = places_.find(key); place != places_.end()) {
      return use(place->second, priority);
    }
    return enqueue(key, priority, std::forward<MakeJob>(makeJob)());
  }
  /// As request, but asks for nothing and marks nothing as used.
  [[nodiscard]] TileAnswer peek(const TileKey& key) const;
  /// Marks the tile as used this frame (and, if it is pending, as still wanted), without asking for it.
  void touch(const TileKey& key);
  /// Drops one tile: its next request makes it anew.
  void drop(const TileKey& key);
  /// Drops all of a stream, its failures and its last error too, and cancels its jobs.
  void forget(std::uint32_t stream);

  /// Takes finished jobs. Returns how many.
  std::size_t beginFrame();
  /// Cancels what nobody asked for in this frame and evicts down to the budget.
  void endFrame();

  void setBudget(std::size_t bytes) { options_.budgetBytes = bytes; }
  [[nodiscard]] std::size_t budget() const { return options_.budgetBytes; }
  /// Of all tiles in memory.
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

  /// Tiles that wait or run; of all streams, or of one.
  [[nodiscard]] std::size_t pending() const { return pending_.size(); }
  [[nodiscard]] std::size_t pending(std::uint32_t stream) const;
  /// Of that stream's tiles that failed or have a flaw, the last one's; null without one. Good until the next call.
  [[nodiscard]] const Error* lastError(std::uint32_t stream) const;

 private:
  using Clock = std::chrono::steady_clock;
  /// One tile: pending while `job` is set, failed while `error` is set, else ready.
  struct Entry {
    TileKey key;
    std::uint64_t lastUse = 0;  ///< number of the frame
    std::size_t bytes = 0;
    TileDataPointer data;
    std::shared_ptr<const Error> error;
    std::shared_ptr<QueuedJob> job;
    std::size_t pendingPlace = 0;  ///< in pending_, while `job` is set
    Clock::time_point asked;
  };
  struct Stream {
    std::size_t pending = 0;
    std::uint64_t asideFrame = 0;  ///< the last at whose end tiles waited for data from elsewhere
    Clock::time_point heard;       ///< of it last, or when the first of these began to wait
    std::shared_ptr<const Error> lastError;
  };
  using Entries = std::list<Entry>;

  TileAnswer use(Entries::iterator entry, double priority);
  TileAnswer enqueue(const TileKey& key, double priority, std::unique_ptr<TileJob> job);
  [[nodiscard]] TileAnswer answer(const Entry& entry) const;
  void markUsed(Entries::iterator entry);
  void take(QueuedJob& finished);
  void keepError(std::uint32_t stream, std::shared_ptr<const Error> error);
  void cancel(Entry& entry);
  void leavePending(Entry& entry);
  Entries::iterator erase(Entries::iterator entry);
  void evict();

  TileStreamerOptions options_;
  Statistics* statistics_;
  std::shared_ptr<JobQueue> queue_;
  std::uint32_t lastStream_ = 0;
  std::uint64_t frame_ = 1;
  std::size_t bytes_ = 0;
  Entries entries_;  ///< most recently used first, so lastUse never grows towards the end
  std::unordered_map<TileKey, Entries::iterator> places_;
  std::vector<Entries::iterator> pending_;
  std::vector<std::shared_ptr<QueuedJob>> finished_;  ///< taken from the queue, not yet into entries
  std::unordered_map<std::uint32_t, Stream> streams_;
  Clock::time_point now_ = Clock::now();  ///< at the beginning of the frame
};

}  // namespace meridian::globebrowsing
