#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/api/error.h"

namespace meridian::globebrowsing {

/// What to fetch, and how little of it is still an answer.
struct FetchRequest {
  std::string url;
  std::vector<std::string> headers{};  ///< further ones, "Name: value"
  double priority = 0.0;               ///< a greater one is served first
  /// Of the body after decoding of its content encoding. Default: TransferLimits::bodyBytes.
  std::optional<std::size_t> maximumBytes{};
  /// Statuses that say "nothing here": not an error, and remembered for a while. 204 always is one.
  std::vector<int> emptyStatuses{404};
  /// While its server is down it waits, as a tile should; otherwise that is an error, for what somebody sits and waits
  /// for.
  bool isPatient = true;
};

struct AnswerOrigin;

/// An answer. Its body is immutable and may be held as long as anybody likes.
struct Fetched {
  int status = 200;
  std::string contentType{};
  std::shared_ptr<const std::vector<std::uint8_t>> body{};  ///< null when there is nothing at that address
  bool isFromCache = false;
  bool isStale = false;  ///< past its lifetime, and served because the server could not be asked
  /// What a cache has to know of an answer from a server, for Fetcher::accept. Null in all others.
  std::shared_ptr<const AnswerOrigin> origin{};
};

/// A request under way; destroying it cancels: its `done` is not called any more once the destructor has returned.
/// Safe from any thread, and from within any `done`. When `done` runs on another thread just then, the destructor waits
/// for it: so never destroy one under a lock that its `done` takes. It may outlive its fetcher.
class PendingFetch {
 public:
  PendingFetch() = default;
  PendingFetch(const PendingFetch&) = delete;
  PendingFetch& operator=(const PendingFetch&) = delete;
  virtual ~PendingFetch() = default;
  virtual void setPriority(double priority) = 0;
  /// Why it is not there yet, if it has failed before and waits to be tried again.
  [[nodiscard]] virtual std::optional<Error> lastFailure() const { return std::nullopt; }
};

/// Gets what lies at an address without blocking anybody: from a cache, from a server, from a test. Safe from any
/// thread.
class Fetcher {
 public:
  using Done = std::function<void(Result<Fetched>)>;

  virtual ~Fetcher() = default;

  /// `done` is called once, on a thread of the fetcher's, and must be quick; it may start or cancel other requests, but
  /// not destroy the fetcher. An error is final for this request: what can be tried again was. While its server is
  /// down a patient request waits for as long as somebody holds it. A fetcher that is destroyed cancels all its
  /// requests.
  [[nodiscard]] virtual std::unique_ptr<PendingFetch> fetch(FetchRequest request, Done done) = 0;

  /// The body turned out to be what was asked for; only now may it be kept on disk. Of an answer from the cache: no
  /// effect.
  virtual void accept(const FetchRequest& request, const Fetched& answer) = 0;
  /// The body is not what it says, or says that there is nothing: it is not kept, what the cache has is dropped, and
  /// for a while the address answers "nothing here" without being asked again.
  virtual void reject(const FetchRequest& request) = 0;
};

}  // namespace meridian::globebrowsing
