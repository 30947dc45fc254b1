#include "globebrowsing/streaming/job_queue.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <map>
#include <string>
#include <utility>

namespace meridian::globebrowsing {

namespace {

/// What the work gives, or what it threw.
template <class Work>
auto guarded(Work work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::exception& exception) {
    return failure(std::string("the job threw: ") + exception.what());
  } catch (...) {
    return failure("the job threw something that is no exception");
  }
}

Result<TileDataPointer> run(TileJob& job, const std::stop_token& stop) {
  Result<TileDataPointer> result = job.run(stop);
  if (result && *result == nullptr) {
    return failure("the job made no tile");
  }
  return result;
}

bool dropFrom(std::vector<std::shared_ptr<QueuedJob>>& jobs, const QueuedJob& job) {
  const auto found = std::find_if(jobs.begin(), jobs.end(), [&](const auto& one) { return one.get() == &job; });
  if (found == jobs.end()) {
    return false;
  }
  jobs.erase(found);  // keeps the order of asking
  return true;
}

}  // namespace

bool JobQueue::claimTask() {
  // More tasks than workers could start nothing sooner, and would crowd out whatever else is posted.
  const bool needsTask = !closed_ && !waiting_.empty() && tasks_ < workers_->size();
  tasks_ += needsTask ? 1 : 0;
  return needsTask;
}

void JobQueue::add(std::shared_ptr<QueuedJob> job) {
  bool needsTask = false;
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(job));
    needsTask = claimTask();
  }
  if (needsTask) {
    postTask();
  }
}

void JobQueue::postTask() {
  workers_->post([self = shared_from_this()](const std::stop_token& stop) { self->runBest(stop); });
}

void JobQueue::cancel(QueuedJob& job) {
  std::unique_ptr<TileJob> dropped;  // destroyed under no lock: what it asked for may be about to wake it
  bool needsTask = false;
  {
    const std::lock_guard lock(mutex_);
    job.stop.request_stop();
    if (dropFrom(waiting_, job) || dropFrom(aside_, job)) {
      dropped = std::move(job.job);
      needsTask = claimTask();
    } else if (!dropFrom(running_, job)) {
      dropFrom(finished_, job);
    }
  }
  if (needsTask) {
    postTask();
  }
}

void JobQueue::renewPriorities() {
  bool needsTask = false;
  {
    const std::lock_guard lock(mutex_);
    for (const std::shared_ptr<QueuedJob>& job : aside_) {
      job->job->setPriority(job->priority.load(std::memory_order_relaxed));
    }
    needsTask = claimTask();
  }
  if (needsTask) {
    postTask();
  }
}

void JobQueue::takeFinished(std::vector<std::shared_ptr<QueuedJob>>& finished) {
  const std::lock_guard lock(mutex_);
  finished.insert(finished.end(), std::make_move_iterator(finished_.begin()), std::make_move_iterator(finished_.end()));
  finished_.clear();
}

void JobQueue::close() {
  std::vector<std::shared_ptr<QueuedJob>> dropped;  // destroyed under no lock
  std::unique_lock lock(mutex_);
  closed_ = true;
  dropped.swap(waiting_);
  dropped.insert(dropped.end(), aside_.begin(), aside_.end());
  aside_.clear();
  for (const std::shared_ptr<QueuedJob>& job : running_) {
    job->stop.request_stop();
  }
  ended_.wait(lock, [this] { return busy_ == 0; });
  finished_.clear();
  lock.unlock();
  for (const std::shared_ptr<QueuedJob>& job : dropped) {
    job->job.reset();
  }
}

std::shared_ptr<QueuedJob> JobQueue::takeBest() {
  const auto priorityOf = [](const auto& job) { return job->priority.load(std::memory_order_relaxed); };
  // Of the streams that have as many aside as may be: what a further one must exceed.
  std::map<std::uint32_t, std::vector<double>> begun;
  for (const std::shared_ptr<QueuedJob>& job : aside_) {
    begun[job->key.stream].push_back(priorityOf(job));
  }
  for (auto& [stream, priorities] : begun) {
    if (priorities.size() >= begunAhead) {
      std::nth_element(priorities.begin(), priorities.begin() + (begunAhead - 1), priorities.end(), std::greater<>());
    }
  }
  const auto mayBegin = [&](const auto& job) {
    const auto found = begun.find(job->key.stream);
    return job->hasBegun || found == begun.end() || found->second.size() < begunAhead ||
           priorityOf(job) > found->second[begunAhead - 1];
  };
  auto best = waiting_.end();
  for (auto job = waiting_.begin(); job != waiting_.end(); ++job) {
    if (mayBegin(*job) && (best == waiting_.end() || priorityOf(*job) > priorityOf(*best))) {
      best = job;
    }
  }
  if (best == waiting_.end()) {
    return nullptr;
  }
  std::shared_ptr<QueuedJob> job = std::move(*best);
  waiting_.erase(best);
  return job;
}

bool JobQueue::prepare(const std::shared_ptr<QueuedJob>& job) {
  return job->job->prepare(job->priority.load(std::memory_order_relaxed),
                           [queue = weak_from_this(), weak = std::weak_ptr<QueuedJob>(job)] {
                             const std::shared_ptr<JobQueue> self = queue.lock();
                             const std::shared_ptr<QueuedJob> woken = weak.lock();
                             if (self && woken) {
                               self->wake(woken);
                             }
                           });
}

void JobQueue::wake(const std::shared_ptr<QueuedJob>& job) {
  bool needsTask = false;
  {
    const std::lock_guard lock(mutex_);
    if (dropFrom(aside_, *job)) {
      job->isAside = false;
      waiting_.push_back(job);
      needsTask = claimTask();
    } else {
      job->isWoken = true;
    }
  }
  if (needsTask) {
    postTask();
  }
}

void JobQueue::putAside(const std::shared_ptr<QueuedJob>& job) {
  bool again = false;
  {
    std::unique_lock lock(mutex_);
    if (dropFrom(running_, *job) && !closed_) {
      job->hasBegun = true;
      job->isAside = !job->isWoken;
      (job->isWoken ? waiting_ : aside_).push_back(job);
    } else {  // it was cancelled
      lock.unlock();
      job->job.reset();
      lock.lock();
    }
    --busy_;
    again = !waiting_.empty() && !closed_;
    tasks_ -= again ? 0 : 1;
  }
  ended_.notify_all();
  if (again) {
    postTask();
  }
}

void JobQueue::runBest(const std::stop_token& poolStops) {
  std::shared_ptr<QueuedJob> job;
  {
    const std::lock_guard lock(mutex_);
    job = closed_ ? nullptr : takeBest();
    if (job == nullptr) {
      --tasks_;
      return;
    }
    job->isWoken = false;
    running_.push_back(job);
    ++busy_;
  }
  const Result<bool> prepared = guarded([&]() -> Result<bool> { return prepare(job); });
  if (prepared && !*prepared) {
    putAside(job);
    return;
  }
  Result<TileDataPointer> result = TileDataPointer();
  if (prepared) {
    const std::stop_callback stopWithPool(poolStops, [&job] { job->stop.request_stop(); });
    result = guarded([&] { return run(*job->job, job->stop.get_token()); });
    job->flaw = job->job->flaw();
  } else {
    result = tl::make_unexpected(prepared.error());
  }
  job->job.reset();
  finish(std::move(job), std::move(result));
}

void JobQueue::finish(std::shared_ptr<QueuedJob> job, Result<TileDataPointer> result) {
  bool again = false;
  {
    const std::lock_guard lock(mutex_);
    job->result = std::move(result);
    if (dropFrom(running_, *job) && !closed_) {  // else it was cancelled
      finished_.push_back(std::move(job));
    }
    --busy_;
    again = !waiting_.empty() && !closed_;
    tasks_ -= again ? 0 : 1;
  }
  ended_.notify_all();
  if (again) {
    postTask();  // to the end of the pool's line, so that others get their turn
  }
}

}  // namespace meridian::globebrowsing
