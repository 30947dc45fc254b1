#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
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
  std::unique_ptr<TileJob> job;  ///< the worker's while it runs, destroyed there
  std::atomic<double> priority;
  std::stop_source stop;
  Result<TileDataPointer> result = TileDataPointer();  ///< the worker's until the job is among the finished
};

/// The jobs of one TileStreamer that wait, and those that have finished. It holds a task in the pool's line for every
/// job that could start at once; each such task takes the job of greatest priority at the moment it begins.
///
/// Safe from any thread. Lives as long as one of its tasks waits in the pool.
class JobQueue : public std::enable_shared_from_this<JobQueue> {
 public:
  explicit JobQueue(WorkerPool& workers) : workers_(&workers) {}

  void add(std::shared_ptr<QueuedJob> job);
  /// It never starts if it waits; if it runs it is asked to stop and does not come among the finished.
  void cancel(QueuedJob& job);
  /// Appends what has finished since the last call.
  void takeFinished(std::vector<std::shared_ptr<QueuedJob>>& finished);
  /// Cancels everything and waits for what runs. Nothing may be added afterwards.
  void close();

 private:
  void postTask();
  void runBest(const std::stop_token& poolStops);
  std::shared_ptr<QueuedJob> takeBest();

  WorkerPool* workers_;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::vector<std::shared_ptr<QueuedJob>> waiting_;  ///< in the order of asking
  std::vector<std::shared_ptr<QueuedJob>> running_;
  std::vector<std::shared_ptr<QueuedJob>> finished_;
  std::size_t tasks_ = 0;  ///< in the pool's line or running
  bool closed_ = false;
};

}  // namespace meridian::globebrowsing
