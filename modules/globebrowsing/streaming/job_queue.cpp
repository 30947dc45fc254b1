#include "globebrowsing/streaming/job_queue.h"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

namespace meridian::globebrowsing {

namespace {

Result<TileDataPointer> runGuarded(TileJob& job, const std::stop_token& stop) {
  try {
    Result<TileDataPointer> result = job.run(stop);
    if (result && *result == nullptr) {
      return failure("the job made no tile");
    }
    return result;
  } catch (const std::exception& exception) {
    return failure(std::string("the job threw: ") + exception.what());
  } catch (...) {
    return failure("the job threw something that is no exception");
  }
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

void JobQueue::add(std::shared_ptr<QueuedJob> job) {
  bool needsTask = false;
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(job));
    // More tasks than workers could start nothing sooner, and would crowd out whatever else is posted.
    needsTask = tasks_ < workers_->size();
    tasks_ += needsTask ? 1 : 0;
  }
  if (needsTask) {
    postTask();
  }
}

void JobQueue::postTask() {
  workers_->post([self = shared_from_this()](const std::stop_token& stop) { self->runBest(stop); });
}

void JobQueue::cancel(QueuedJob& job) {
  const std::lock_guard lock(mutex_);
  job.stop.request_stop();
  if (!dropFrom(waiting_, job) && !dropFrom(running_, job)) {
    dropFrom(finished_, job);
  }
}

void JobQueue::takeFinished(std::vector<std::shared_ptr<QueuedJob>>& finished) {
  const std::lock_guard lock(mutex_);
  finished.insert(finished.end(), std::make_move_iterator(finished_.begin()), std::make_move_iterator(finished_.end()));
  finished_.clear();
}

void JobQueue::close() {
  std::unique_lock lock(mutex_);
  closed_ = true;
  waiting_.clear();
  for (const std::shared_ptr<QueuedJob>& job : running_) {
    job->stop.request_stop();
  }
  ended_.wait(lock, [this] { return busy_ == 0; });
  finished_.clear();
}

std::shared_ptr<QueuedJob> JobQueue::takeBest() {
  const auto best = std::max_element(waiting_.begin(), waiting_.end(), [](const auto& a, const auto& b) {
    return a->priority.load(std::memory_order_relaxed) < b->priority.load(std::memory_order_relaxed);
  });
  std::shared_ptr<QueuedJob> job = std::move(*best);
  waiting_.erase(best);
  return job;
}

void JobQueue::runBest(const std::stop_token& poolStops) {
  std::shared_ptr<QueuedJob> job;
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.empty() || closed_) {
      --tasks_;
      return;
    }
    job = takeBest();
    running_.push_back(job);
    ++busy_;
  }
  Result<TileDataPointer> result = TileDataPointer();
  {
    const std::stop_callback stopWithPool(poolStops, [&job] { job->stop.request_stop(); });
    result = runGuarded(*job->job, job->stop.get_token());
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
