#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "globebrowsing/network/circuit_breaker.h"
#include "globebrowsing/network/retry_policy.h"

namespace meridian::globebrowsing {

/// How many requests are sent at a time. The rest waits here rather than in curl, where priorities are lost and
/// time-outs run. Each is at least 1.
struct ConcurrencyOptions {
  int perHost = 8;              ///< which is how many connections it gets
  int perHostMultiplexed = 32;  ///< of a host that answers over HTTP/2, where all share one connection
  int total = 64;
};

/// Requests that wait, run, or wait to be tried again: which is sent next, and when. Decides and does nothing; knows
/// neither curl nor a clock. Not for several threads.
///
/// Of all hosts that may be asked, the request of greatest priority goes first, ties in the order of asking. A request
/// that waits to be tried again takes up none of the places.
class RequestQueue {
 public:
  using Id = std::uint64_t;
  using TimePoint = CircuitBreaker::TimePoint;
  using Random = std::function<double()>;  ///< in [0, 1)

  /// How one attempt ended.
  struct Ending {
    Outcome outcome = Outcome::Done;
    std::optional<std::chrono::milliseconds> retryAfter{};
  };

  RequestQueue(const ConcurrencyOptions& concurrency, const RetryOptions& retry, Random random)
      : concurrency_(concurrency), retry_(retry), random_(std::move(random)) {}

  /// For all hosts, from the next decision on; a wait that has begun stays as long as it is.
  void setOptions(const ConcurrencyOptions& concurrency, const RetryOptions& retry);
  /// `host` is whatever shares limits and fate: scheme, name and port. One that is not patient is over when its host
  /// turns out to be down.
  void add(Id id, const std::string& host, double priority, bool isPatient = true);
  void setPriority(Id id, double priority);
  /// In whatever state it is.
  void remove(Id id, TimePoint now);

  /// The request to send now, which counts as running; nothing when none may be sent.
  std::optional<Id> start(TimePoint now);
  /// A running request has ended. True when it will be tried again, and stays; false when it is over, and is gone.
  bool finish(Id id, const Ending& ending, TimePoint now);
  /// Once a host is up again: puts back into line what was sent to see whether it is, and hangs, and names it. Its
  /// transfers are to be broken off: they would hang for as long as a transfer may.
  std::vector<Id> recallProbes(const std::string& host);
  [[nodiscard]] bool isRunning(Id id) const;
  void setMultiplexed(const std::string& host) { hosts_.try_emplace(host, retry_).first->second.isMultiplexed = true; }

  /// When start may find something that it does not find now, unless something happens before; always after `now`.
  [[nodiscard]] std::optional<TimePoint> wakeAt(TimePoint now) const;
  /// Not while the host is down, but when it is time to see whether it still is.
  [[nodiscard]] bool mayAsk(const std::string& host, TimePoint now) const;
  /// Hosts that are down and have requests waiting.
  [[nodiscard]] std::size_t hostsDown() const;
  [[nodiscard]] std::size_t running() const { return running_; }
  [[nodiscard]] std::size_t size() const { return requests_.size(); }

 private:
  enum class State { Waiting, Delayed, Running };
  struct Place {
    double priority;
    Id id;
    bool operator<(const Place& other) const {
      return priority != other.priority ? priority > other.priority : id < other.id;
    }
  };
  struct Host {
    explicit Host(const RetryOptions& options) : breaker(options) {}
    CircuitBreaker breaker;
    bool isMultiplexed = false;
    int running = 0;
    std::uint64_t answers = 0;  ///< whatever they said
    std::optional<Id> probe;
    std::vector<Id> probes;  ///< sent since it was last up, answered or not
    std::set<Place> waiting;
    std::multimap<TimePoint, Id> delayed;
  };
  struct Request {
    Host* host;
    double priority;
    bool isPatient;
    std::uint64_t answersSeen;  ///< by its host when it was added, or last failed
    State state = State::Waiting;
    int failures = 0;      ///< that count
    int hostFailures = 0;  ///< that are its host's fault
    std::multimap<TimePoint, Id>::iterator delay{};
  };

  void endDelays(Host& host, TimePoint now);
  [[nodiscard]] std::optional<Id> best(const Host& host, TimePoint now) const;
  [[nodiscard]] std::optional<Id> leastSuspect(const Host& host) const;
  void release(Request& request);
  void wait(Request& request, Id id, TimePoint until, TimePoint now);

  ConcurrencyOptions concurrency_;
  RetryOptions retry_;
  Random random_;
  std::map<std::string, Host> hosts_;  ///< never shrinks: a host is remembered with its state
  std::unordered_map<Id, Request> requests_;
  std::size_t running_ = 0;
};

}  // namespace meridian::globebrowsing
