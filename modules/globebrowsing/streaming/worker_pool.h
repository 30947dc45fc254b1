#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace meridian::globebrowsing {

/// Threads nicer than the one that made the pool, so that the render thread gets a core whenever it wants one. Not at
/// idle priority (SCHED_IDLE): that gets next to nothing while other programs use all cores, and pictures stay coarse.
/// First posted, first served; who needs an order of its own posts a task that takes its best job (TileStreamer).
///
/// Safe from any thread. Exceptions end in the log, never in a thread's end.
class WorkerPool {
 public:
  using Task = std::function<void(const std::stop_token&)>;

  /// About a tenth of the render thread's share, where both want the same core.
  static constexpr int niceness = 10;

  /// One less than the machine has cores, but at least one.
  [[nodiscard]] static std::size_t defaultSize();

  explicit WorkerPool(std::size_t threads = defaultSize());
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;
  /// Stops.
  ~WorkerPool();

  [[nodiscard]] std::size_t size() const { return size_; }

  /// After stop() the task is dropped. The token tells of stop().
  void post(Task task);
  /// Waits until nothing waits and nothing runs; tasks posted meanwhile included. Not from a worker.
  void drain();
  /// Drops what waits, asks what runs to stop, and waits for it. Not from a worker.
  void stop();

 private:
  void work();

  std::mutex mutex_;
  std::condition_variable posted_;
  std::condition_variable idle_;
  std::deque<Task> tasks_;
  std::size_t running_ = 0;
  std::stop_source stopping_;
  std::size_t size_;
  std::vector<std::jthread> threads_;
};

}  // namespace meridian::globebrowsing
