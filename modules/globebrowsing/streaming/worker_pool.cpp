#include "globebrowsing/streaming/worker_pool.h"

#include <algorithm>
#include <cerrno>
#include <exception>
#include <system_error>
#include <utility>

#include <sys/resource.h>

#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

/// On Linux both calls are about the calling thread alone.
void lowerPriority() {
  if (setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + WorkerPool::niceness) != 0) {
    log::debug("a worker stays at normal priority: {}", std::generic_category().message(errno));
  }
}

void runGuarded(const WorkerPool::Task& task, const std::stop_token& stop) {
  try {
    task(stop);
  } catch (const std::exception& exception) {
    log::error("a worker's task threw: {}", exception.what());
  } catch (...) {
    log::error("a worker's task threw something that is no exception");
  }
}

}  // namespace

std::size_t WorkerPool::defaultSize() {
  return std::max(2U, std::thread::hardware_concurrency()) - 1;
}

WorkerPool::WorkerPool(std::size_t threads) : size_(std::max<std::size_t>(threads, 1)) {
  threads_.reserve(size_);
  for (std::size_t i = 0; i < size_; ++i) {
    threads_.emplace_back([this] { work(); });
  }
}

WorkerPool::~WorkerPool() {
  stop();
}

void WorkerPool::post(Task task) {
  {
    const std::lock_guard lock(mutex_);
    if (stopping_.stop_requested()) {
      return;
    }
    tasks_.push_back(std::move(task));
  }
  posted_.notify_one();
}

void WorkerPool::drain() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this] { return tasks_.empty() && running_ == 0; });
}

void WorkerPool::stop() {
  std::deque<Task> dropped;  // destroyed after unlocking: a task's end may post
  {
    const std::lock_guard lock(mutex_);
    stopping_.request_stop();
    dropped.swap(tasks_);
  }
  posted_.notify_all();
  idle_.notify_all();
  for (std::jthread& thread : threads_) {
    if (thread.joinable()) {
      thread.join();
    }
  }
}

void WorkerPool::work() {
  lowerPriority();
  const std::stop_token stop = stopping_.get_token();
  std::unique_lock lock(mutex_);
  while (true) {
    posted_.wait(lock, [&] { return stop.stop_requested() || !tasks_.empty(); });
    if (stop.stop_requested()) {
      return;
    }
    ++running_;
    Task task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    runGuarded(task, stop);
    task = nullptr;
    lock.lock();
    --running_;
    if (running_ == 0 && tasks_.empty()) {
      idle_.notify_all();
    }
  }
}

}  // namespace meridian::globebrowsing
