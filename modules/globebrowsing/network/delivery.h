#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "globebrowsing/network/fetcher.h"

namespace meridian::globebrowsing {

/// The one call of `done` that a fetch has promised, against its cancellation from any thread.
class Delivery {
 public:
  explicit Delivery(Fetcher::Done done) : done_(std::move(done)) {}

  /// Calls `done`, unless it was called or cancelled before. Exceptions end in the log.
  void deliver(Result<Fetched> result);
  /// Afterwards `done` is not called any more, and if it was being called on another thread that call has ended. From
  /// within `done` itself it only returns. False when `done` has been called.
  bool cancel();

  void setLastFailure(const Error& error);
  [[nodiscard]] std::optional<Error> lastFailure() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable ended_;
  Fetcher::Done done_;        ///< empty once it was called or cancelled
  std::thread::id caller_{};  ///< while it is being called
  std::optional<Error> lastFailure_;
};

}  // namespace meridian::globebrowsing
