#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "globebrowsing/network/cache_worker.h"
#include "globebrowsing/network/delivery.h"
#include "globebrowsing/network/fetcher.h"
#include "globebrowsing/network/request_queue.h"
#include "globebrowsing/network/web_address.h"

namespace meridian::globebrowsing {

/// Of an answer that may be accepted: what goes onto disk with its body.
struct AnswerOrigin {
  std::string key;
  int status = 0;
  AnswerFacts facts{};
  mutable std::atomic<bool> isAccepted{false};  ///< requests that shared a transfer share this
};

/// The status that a rejected address answers with from then on.
inline constexpr int nothingHere = 204;

/// One call of fetch.
struct Waiter {
  Waiter(Fetcher::Done done, double wanted) : delivery(std::move(done)), priority(wanted) {}

  Delivery delivery;
  std::atomic<double> priority;
  std::atomic<bool> isRenewed{false};  ///< a task that looks at the new priority is on its way
  RequestQueue::Id flight = 0;         ///< the network thread's; 0 while there is none
};

/// Requests that may share a transfer and its answer.
struct Flight {
  FetchRequest request{};
  WebAddress address{};
  std::string key{};       ///< in the caches
  std::string identity{};  ///< identityOf() its request
  std::vector<std::shared_ptr<Waiter>> waiters{};
  std::optional<CachedAnswer> kept{};  ///< past its lifetime
  bool isQueued = false;               ///< else it waits for the cache
  int attempts = 0;
};

/// All that are under way, by number and by identity. The network thread's.
class Flights {
 public:
  using Id = RequestQueue::Id;

  /// The flight of that identity, a new one if there is none, with one more waiter; and whether it is new.
  std::pair<Id, bool> join(std::string identity, const std::shared_ptr<Waiter>& waiter);
  /// Null: it has ended.
  [[nodiscard]] Flight* find(Id id);
  /// Of one that is there.
  [[nodiscard]] Flight& at(Id id) { return byId_.at(id); }
  /// Takes out one that is there.
  Flight take(Id id);
  [[nodiscard]] std::size_t size() const { return byId_.size(); }
  /// Calls `visit(id, flight)` for each, which adds and takes none.
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (const auto& [id, flight] : byId_) {
      visit(id, flight);
    }
  }

 private:
  std::unordered_map<Id, Flight> byId_;
  std::unordered_map<std::string, Id> byIdentity_;
  Id lastId_ = 0;
};

/// In the order of greatness, whatever it is.
[[nodiscard]] double orderable(double priority);
[[nodiscard]] double greatestPriority(const Flight& flight);
/// What the caches know the request's answer by.
[[nodiscard]] std::string cacheKey(const WebAddress& address, const FetchRequest& request);
/// Requests of the same identity may share a transfer: the same answer is good for both, and both wait alike.
[[nodiscard]] std::string identityOf(const std::string& key, const FetchRequest& request);
[[nodiscard]] bool isEmptyStatus(const FetchRequest& request, int status);
[[nodiscard]] std::string contentTypeOf(const AnswerFacts& facts);
[[nodiscard]] Fetched fetchedFromCache(const CachedAnswer& kept, bool isStale);

}  // namespace meridian::globebrowsing
