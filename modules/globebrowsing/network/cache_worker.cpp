#include "globebrowsing/network/cache_worker.h"

#include <utility>

#include <pthread.h>

namespace meridian::globebrowsing {

namespace {

/// In one transaction; look-ups wait for it.
constexpr std::size_t writesAtOnce = 32;

}  // namespace

CacheWorker::CacheWorker(const CacheOptions& options, NetworkStatistics& statistics)
    : maximumUnwrittenBytes_(options.maximumUnwrittenBytes), cache_(options, statistics), thread_([this] { run(); }) {}

CacheWorker::~CacheWorker() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    reads_.clear();
  }
  added_.notify_one();
  thread_.join();
}

void CacheWorker::find(const std::string& key, Found found) {
  Work work = [key, found = std::move(found)](DiskCache& cache) { found(cache.find(key)); };
  {
    const std::lock_guard lock(mutex_);
    if (unwritten_.contains(key)) {
      ++unwritten_[key];
      writes_.push_back({key, 0, std::move(work)});
    } else {
      reads_.push_back(std::move(work));
    }
  }
  added_.notify_one();
}

void CacheWorker::store(const std::string& key, CachedAnswer answer) {
  const std::size_t bytes = answer.body->size();
  add(key, bytes, [key, answer = std::move(answer)](DiskCache& cache) { cache.store(key, answer); });
}

void CacheWorker::refresh(const std::string& key, AnswerFacts facts) {
  add(key, 0, [key, facts = std::move(facts)](DiskCache& cache) { cache.refresh(key, facts); });
}

void CacheWorker::remove(const std::string& key) {
  add(key, 0, [key](DiskCache& cache) { cache.remove(key); });
}

void CacheWorker::setMode(CacheMode mode) {
  add({}, 0, [mode](DiskCache& cache) { cache.setMode(mode); });
}

void CacheWorker::setMaximumBytes(std::uint64_t bytes) {
  add({}, 0, [bytes](DiskCache& cache) { cache.setMaximumBytes(bytes); });
}

void CacheWorker::add(const std::string& key, std::size_t bytes, Work work) {
  {
    const std::lock_guard lock(mutex_);
    if (bytes > 0 && unwrittenBytes_ + bytes > maximumUnwrittenBytes_) {
      return;
    }
    unwrittenBytes_ += bytes;
    ++unwritten_[key];
    writes_.push_back({key, bytes, std::move(work)});
  }
  added_.notify_one();
}

void CacheWorker::drain() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [&] { return reads_.empty() && writes_.empty() && !isBusy_; });
}

void CacheWorker::run() {
  pthread_setname_np(pthread_self(), "network-cache");
  std::unique_lock lock(mutex_);
  for (;;) {
    added_.wait(lock, [&] { return stopping_ || !reads_.empty() || !writes_.empty(); });
    if (reads_.empty() && writes_.empty()) {
      return;
    }
    isBusy_ = true;
    if (!reads_.empty()) {
      const Work work = std::move(reads_.front());
      reads_.pop_front();
      lock.unlock();
      work(cache_);
      lock.lock();
    } else {
      writeSome(lock);
    }
    isBusy_ = false;
    if (reads_.empty() && writes_.empty()) {
      idle_.notify_all();
    }
  }
}

void CacheWorker::writeSome(std::unique_lock<std::mutex>& lock) {
  for (std::size_t i = 0; i < writesAtOnce && !writes_.empty() && (reads_.empty() || i == 0); ++i) {
    Write write = std::move(writes_.front());
    writes_.pop_front();
    lock.unlock();
    write.work(cache_);
    lock.lock();
    unwrittenBytes_ -= write.bytes;
    if (const auto count = unwritten_.find(write.key); --count->second == 0) {
      unwritten_.erase(count);
    }
  }
  lock.unlock();
  cache_.commit();
  lock.lock();
}

}  // namespace meridian::globebrowsing
