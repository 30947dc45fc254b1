#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <unordered_map>

#include "globebrowsing/network/disk_cache.h"

namespace meridian::globebrowsing {

/// The disk cache on a thread of its own, so that nobody else waits for the disk. Safe from any thread.
///
/// Look-ups overtake writes, except those of their own key.
class CacheWorker {
 public:
  using Found = std::function<void(std::optional<CachedAnswer>)>;

  CacheWorker(const CacheOptions& options, NetworkStatistics& statistics);
  CacheWorker(const CacheWorker&) = delete;
  CacheWorker& operator=(const CacheWorker&) = delete;
  /// Drops look-ups and does what is to be written.
  ~CacheWorker();

  /// `found` is called on the cache's thread.
  void find(const std::string& key, Found found);
  void store(const std::string& key, CachedAnswer answer);
  void refresh(const std::string& key, AnswerFacts facts);
  void remove(const std::string& key);
  void setMode(CacheMode mode);
  void setMaximumBytes(std::uint64_t bytes);
  /// Waits until nothing waits and everything is committed.
  void drain();

 private:
  using Work = std::function<void(DiskCache&)>;
  struct Write {
    std::string key;
    std::size_t bytes = 0;
    Work work;
  };

  void add(const std::string& key, std::size_t bytes, Work work);
  void run();
  void writeSome(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable added_;
  std::condition_variable idle_;
  std::deque<Work> reads_;
  std::deque<Write> writes_;
  std::unordered_map<std::string, int> unwritten_;  ///< how many of writes_ have that key
  std::size_t unwrittenBytes_ = 0;
  std::size_t maximumUnwrittenBytes_;
  bool isBusy_ = false;
  bool stopping_ = false;
  DiskCache cache_;  ///< the thread's
  std::thread thread_;
};

}  // namespace meridian::globebrowsing
