#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "host/api/error.h"

namespace meridian::globebrowsing {

/// What to fetch, and how little of it is still an answer.
struct FetchRequest {
  std::string url;
  std::vector<std::string> headers{};                ///< further ones, "Name: value"
  double priority = 0.0;                             ///< a greater one is served first
  std::size_t maximumBytes = std::size_t{32} << 20;  ///< after decoding of the content encoding
  /// Statuses that say "nothing here": not an error, and remembered for a while. 204 always is one.
  std::vector<int> emptyStatuses{404};
};

/// An answer. Its body is immutable and may be held as long as anybody likes.
struct Fetched {
  int status = 200;
  std::string contentType{};
  std::shared_ptr<const std::vector<std::uint8_t>> body{};  ///< null when there is nothing at that address
  bool isFromCache = false;
  bool isStale = false;  ///< past its lifetime, and served because the server could not be asked
};

/// A request under way; destroying it cancels: its `done` is not called any more once the destructor has returned.
class PendingFetch {
 public:
  PendingFetch() = default;
  PendingFetch(const PendingFetch&) = delete;
  PendingFetch& operator=(const PendingFetch&) = delete;
  virtual ~PendingFetch() = default;
  virtual void setPriority(double priority) = 0;
};

/// Gets what lies at an address without blocking anybody: from a cache, from a server, from a test. Safe from any
/// thread.
class Fetcher {
 public:
  using Done = std::function<void(Result<Fetched>)>;

  virtual ~Fetcher() = default;

  /// `done` is called once, on a thread of the fetcher's, and must be quick; it may start or cancel other requests, but
  /// not destroy the fetcher. An error is final for this request: what can be tried again was.
  [[nodiscard]] virtual std::unique_ptr<PendingFetch> fetch(FetchRequest request, Done done) = 0;

  /// The body turned out to be what was asked for; only now may it be kept on disk. Of an answer from the cache: no
  /// effect.
  virtual void accept(const FetchRequest& request, const Fetched& answer) = 0;
  /// The body is not what it says, or says that there is nothing: it is not kept, what the cache has is dropped, and
  /// for a while the address answers "nothing here" without being asked again.
  virtual void reject(const FetchRequest& request) = 0;
};

}  // namespace meridian::globebrowsing
