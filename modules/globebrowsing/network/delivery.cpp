#include "globebrowsing/network/delivery.h"

#include <exception>
#include <utility>

#include "host/api/log.h"

namespace meridian::globebrowsing {

void Delivery::deliver(Result<Fetched> result) {
  Fetcher::Done done;
  {
    const std::lock_guard lock(mutex_);
    done.swap(done_);
    if (!done) {
      return;
    }
    caller_ = std::this_thread::get_id();
  }
  try {
    done(std::move(result));
  } catch (const std::exception& exception) {
    log::error("what was to be done with an answer threw: {}", exception.what());
  } catch (...) {
    log::error("what was to be done with an answer threw what is no exception");
  }
  done = nullptr;  // what it holds goes before cancel() returns elsewhere
  const std::lock_guard lock(mutex_);
  caller_ = {};
  ended_.notify_all();
}

bool Delivery::cancel() {
  Fetcher::Done dropped;  // goes after the lock: what it holds may cancel others
  std::unique_lock lock(mutex_);
  dropped.swap(done_);
  const bool isDropped = dropped != nullptr;
  if (caller_ != std::this_thread::get_id()) {
    ended_.wait(lock, [&] { return caller_ == std::thread::id(); });
  }
  lock.unlock();
  return isDropped;
}

void Delivery::setLastFailure(const Error& error) {
  const std::lock_guard lock(mutex_);
  lastFailure_ = error;
}

std::optional<Error> Delivery::lastFailure() const {
  const std::lock_guard lock(mutex_);
  return lastFailure_;
}

}  // namespace meridian::globebrowsing
