#pragma once

#include <functional>
#include <mutex>
#include <utility>
#include <vector>

namespace meridian::globebrowsing {

/// Tasks for a thread that sleeps in something that has a wake of its own. Posted from any thread, run in that order.
class Mailbox {
 public:
  using Task = std::function<void()>;

  /// `wake` makes the thread return from its sleep; it is called under the mailbox's lock, and not after close().
  explicit Mailbox(std::function<void()> wake) : wake_(std::move(wake)) {}

  /// After close() the task is dropped. Without `urgent` it waits until the thread wakes for something else.
  void post(Task task, bool urgent = true) {
    const std::lock_guard lock(mutex_);
    if (isClosed_) {
      return;
    }
    tasks_.push_back(std::move(task));
    hasUrgent_ = hasUrgent_ || urgent;
    if (urgent && std::exchange(isAsleep_, false)) {
      wake_();
    }
  }

  /// Everything posted since the last call.
  [[nodiscard]] std::vector<Task> take() {
    const std::lock_guard lock(mutex_);
    isAsleep_ = false;
    hasUrgent_ = false;
    return std::exchange(tasks_, {});
  }

  /// To be called before going to sleep: false when there is something urgent to be taken first. A thread that is awake
  /// is not woken, which is most of the cost of a post.
  [[nodiscard]] bool maySleep() {
    const std::lock_guard lock(mutex_);
    isAsleep_ = !hasUrgent_;
    return isAsleep_;
  }

  void close() {
    std::vector<Task> dropped;
    const std::lock_guard lock(mutex_);
    isClosed_ = true;
    dropped.swap(tasks_);
  }

 private:
  std::mutex mutex_;
  std::function<void()> wake_;
  std::vector<Task> tasks_;
  bool hasUrgent_ = false;  ///< since the last take()
  bool isAsleep_ = false;
  bool isClosed_ = false;
};

}  // namespace meridian::globebrowsing
