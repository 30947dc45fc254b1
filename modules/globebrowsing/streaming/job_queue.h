#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <vector>

#include "globebrowsing/streaming/tile_data.h"
#include "globebrowsing/streaming/tile_job.h"
#include "globebrowsing/streaming/tile_key.h"
#include "globebrowsing/streaming/worker_pool.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

/// A job with its priority, which the render thread renews while workers compare it.
struct QueuedJob {
  QueuedJob(const TileKey& tile, std::unique_ptr<TileJob> work, double wanted)
      : key(tile), job(std::move(work)), priority(wanted) {}

  TileKey key;
  std::unique_ptr<TileJob> job;  ///< the worker's while it is prepared or run
  std::atomic<double> priority;
  std::stop_source stop;
  Result<TileDataPointer> result = TileDataPointer();  ///< the worker's until the job is among the finished
  std::optional<Error> flaw;                           ///< the same
  std::atomic<bool> isAside = false;                   ///< waits for data from elsewhere
  bool hasBegun = false;                               ///< prepared once; the queue's
  bool isWoken = false;                                ///< while it was being prepared; the queue's
};

/// The jobs of one TileStreamer that wait, and those that have finished. It holds a task in the pool's line for every
/// job that could start at once; each such task takes the job of greatest priority at the moment it begins.
///
/// A job whose data come from elsewhere is put aside until they are there. So that what is fetched is what is wanted
/// now, a job begins only while fewer than `begunAhead` jobs of its stream and at least its priority are aside: a slow
/// server holds up neither other streams nor what has become more urgent.
///
/// Safe from any thread. Lives as long as one of its tasks waits in the pool.
class JobQueue : public std::enable_shared_from_this<JobQueue> {
 public:
  static constexpr std::size_t begunAhead = 16;

  explicit JobQueue(WorkerPool& workers) : workers_(&workers) {}

  void add(std::shared_ptr<QueuedJob> job);
  /// It never starts if it waits, and what it has asked for is dropped at once; if it runs it is asked to stop and does
  /// not come among the finished.
  void cancel(QueuedJob& job);
  /// Tells the jobs that are aside what their priorities are now.
  void renewPriorities();
  /// Appends what has finished since the last call.
  void takeFinished(std::vector<std::shared_ptr<QueuedJob>>& finished);
  /// Cancels everything and waits for what runs. Nothing may be added afterwards.
  void close();

 private:
  void postTask();
  void runBest(const std::stop_token& poolStops);
  /// Null when none may begin.
  std::shared_ptr<QueuedJob> takeBest();
  bool prepare(const std::shared_ptr<QueuedJob>& job);
  void putAside(const std::shared_ptr<QueuedJob>& job);
  void wake(const std::shared_ptr<QueuedJob>& job);
  /// Whether the caller, after unlocking, has to post a task for jobs that may have become able to start.
  bool claimTask();
  void finish(std::shared_ptr<QueuedJob> job, Result<TileDataPointer> result);

  WorkerPool* workers_;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::vector<std::shared_ptr<QueuedJob>> waiting_;  ///< in the order of asking
  std::vector<std::shared_ptr<QueuedJob>> aside_;    ///< until they are woken
  std::vector<std::shared_ptr<QueuedJob>> running_;
  std::vector<std::shared_ptr<QueuedJob>> finished_;
  std::size_t tasks_ = 0;  ///< in the pool's line or running
  std::size_t busy_ = 0;   ///< jobs that run, cancelled ones included
  bool closed_ = false;
};

}  // namespace meridian::globebrowsing
