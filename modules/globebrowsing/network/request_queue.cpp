#include "globebrowsing/network/request_queue.h"

#include <algorithm>
#include <cassert>

namespace meridian::globebrowsing {

void RequestQueue::setOptions(const ConcurrencyOptions& concurrency, const RetryOptions& retry) {
  concurrency_ = concurrency;
  retry_ = retry;
  for (auto& [name, host] : hosts_) {
    host.breaker.setOptions(retry);
  }
}

void RequestQueue::add(Id id, const std::string& host, double priority, bool isPatient) {
  Host& server = hosts_.try_emplace(host, retry_).first->second;
  const bool isNew = requests_.emplace(id, Request{&server, priority, isPatient, server.answers}).second;
  assert(isNew);
  static_cast<void>(isNew);
  server.waiting.insert({priority, id});
}

void RequestQueue::setPriority(Id id, double priority) {
  const auto place = requests_.find(id);
  if (place == requests_.end() || place->second.priority == priority) {
    return;
  }
  Request& request = place->second;
  if (request.state == State::Waiting) {
    request.host->waiting.erase({request.priority, id});
    request.host->waiting.insert({priority, id});
  }
  request.priority = priority;
}

void RequestQueue::remove(Id id, TimePoint now) {
  const auto place = requests_.find(id);
  if (place == requests_.end()) {
    return;
  }
  Request& request = place->second;
  Host& host = *request.host;
  switch (request.state) {
    case State::Waiting:
      host.waiting.erase({request.priority, id});
      break;
    case State::Delayed:
      host.delayed.erase(request.delay);
      break;
    case State::Running:
      release(request);
      if (host.probe == id) {
        host.probe.reset();
        host.breaker.abandonProbe(now);
      }
      break;
  }
  requests_.erase(place);
}

std::optional<RequestQueue::Id> RequestQueue::start(TimePoint now) {
  for (auto& [name, host] : hosts_) {
    endDelays(host, now);
  }
  if (running_ >= static_cast<std::size_t>(std::max(concurrency_.total, 1))) {
    return std::nullopt;
  }
  std::optional<Place> first;
  for (const auto& [name, host] : hosts_) {
    if (const auto id = best(host, now)) {
      const Place place{requests_.at(*id).priority, *id};
      first = !first || place < *first ? place : *first;
    }
  }
  if (!first) {
    return std::nullopt;
  }
  Request& request = requests_.at(first->id);
  Host& host = *request.host;
  if (host.breaker.state() != CircuitBreaker::State::Up) {
    host.breaker.beginProbe(now);
    host.probe = first->id;
    host.probes.push_back(first->id);
  }
  host.waiting.erase(*first);
  request.state = State::Running;
  ++host.running;
  ++running_;
  return first->id;
}

bool RequestQueue::finish(Id id, const Ending& ending, TimePoint now) {
  const auto place = requests_.find(id);
  assert(place != requests_.end() && place->second.state == State::Running);
  Request& request = place->second;
  Host& host = *request.host;
  release(request);
  const bool wasProbe = host.probe == id;
  if (wasProbe) {
    host.probe.reset();
  }

  const bool wasUp = host.breaker.state() == CircuitBreaker::State::Up;
  const bool blamesHost = ending.outcome == Outcome::Unreachable || ending.outcome == Outcome::Unavailable;
  if (!blamesHost) {
    ++host.answers;
    host.breaker.succeeded(now);
  } else {
    host.breaker.failed(wasProbe, now, random_());
    if (ending.retryAfter && ending.retryAfter->count() > 0) {
      host.breaker.pauseFor(*ending.retryAfter, now);
    }
  }
  if (ending.outcome == Outcome::Done || ending.outcome == Outcome::Final) {
    requests_.erase(place);
    return false;
  }

  // A server that answers nobody is down, though it may take some failures to be sure.
  const bool isHostsFault = blamesHost && (!wasUp || host.answers == request.answersSeen);
  const bool isDown = host.breaker.state() != CircuitBreaker::State::Up;
  request.answersSeen = host.answers;
  ++(isHostsFault && request.isPatient ? request.hostFailures : request.failures);
  if (request.failures >= retry_.attempts || (isDown && !request.isPatient)) {
    requests_.erase(place);
    return false;
  }
  auto delay = std::chrono::milliseconds(0);  // while it is down, its pause is delay enough
  if (!isDown) {
    delay = std::max(retryDelay(retry_, request.failures + request.hostFailures, random_()),
                     ending.retryAfter.value_or(delay));
  }
  wait(request, id, now + delay, now);
  return true;
}

std::vector<RequestQueue::Id> RequestQueue::recallProbes(const std::string& name) {
  std::vector<Id> recalled;
  Host& host = hosts_.at(name);
  if (host.breaker.state() != CircuitBreaker::State::Up) {
    return recalled;
  }
  for (const Id id : std::exchange(host.probes, {})) {
    if (isRunning(id)) {
      Request& request = requests_.at(id);
      release(request);
      request.state = State::Waiting;
      host.waiting.insert({request.priority, id});
      recalled.push_back(id);
    }
  }
  host.probe.reset();
  return recalled;
}

bool RequestQueue::isRunning(Id id) const {
  const auto place = requests_.find(id);
  return place != requests_.end() && place->second.state == State::Running;
}

std::optional<RequestQueue::TimePoint> RequestQueue::wakeAt(TimePoint now) const {
  std::optional<TimePoint> earliest;
  const auto consider = [&](TimePoint time) {
    if (time > now && (!earliest || time < *earliest)) {
      earliest = time;
    }
  };
  for (const auto& [name, host] : hosts_) {
    if (!host.delayed.empty()) {
      consider(host.delayed.begin()->first);
    }
    if (!host.waiting.empty() && host.breaker.state() != CircuitBreaker::State::Up) {
      consider(host.breaker.pauseEnd());
    }
  }
  return earliest;
}

bool RequestQueue::mayAsk(const std::string& host, TimePoint now) const {
  const auto place = hosts_.find(host);
  if (place == hosts_.end()) {
    return true;
  }
  const CircuitBreaker& breaker = place->second.breaker;
  return breaker.state() == CircuitBreaker::State::Up || breaker.mayProbe(now);
}

std::size_t RequestQueue::hostsDown() const {
  return static_cast<std::size_t>(std::count_if(hosts_.begin(), hosts_.end(), [](const auto& entry) {
    const Host& host = entry.second;
    return host.breaker.state() != CircuitBreaker::State::Up && (!host.waiting.empty() || host.running > 0);
  }));
}

void RequestQueue::endDelays(Host& host, TimePoint now) {
  while (!host.delayed.empty() && host.delayed.begin()->first <= now) {
    const Id id = host.delayed.begin()->second;
    host.delayed.erase(host.delayed.begin());
    Request& request = requests_.at(id);
    request.state = State::Waiting;
    host.waiting.insert({request.priority, id});
  }
}

std::optional<RequestQueue::Id> RequestQueue::best(const Host& host, TimePoint now) const {
  if (host.waiting.empty()) {
    return std::nullopt;
  }
  if (host.breaker.state() != CircuitBreaker::State::Up) {
    return host.breaker.mayProbe(now) ? leastSuspect(host) : std::nullopt;
  }
  const int most = host.isMultiplexed ? concurrency_.perHostMultiplexed : concurrency_.perHost;
  return host.running < std::max(most, 1) ? std::optional<Id>(host.waiting.begin()->id) : std::nullopt;
}

/// A server that hangs on one address must not look down because that address is asked for again and again.
std::optional<RequestQueue::Id> RequestQueue::leastSuspect(const Host& host) const {
  const auto suspicion = [&](const Place& place) {
    const Request& request = requests_.at(place.id);
    return request.failures + request.hostFailures;
  };
  const auto least = std::min_element(host.waiting.begin(), host.waiting.end(),
                                      [&](const Place& a, const Place& b) { return suspicion(a) < suspicion(b); });
  return least->id;
}

void RequestQueue::release(Request& request) {
  --request.host->running;
  --running_;
}

void RequestQueue::wait(Request& request, Id id, TimePoint until, TimePoint now) {
  if (until > now) {
    request.state = State::Delayed;
    request.delay = request.host->delayed.emplace(until, id);
  } else {
    request.state = State::Waiting;
    request.host->waiting.insert({request.priority, id});
  }
}

}  // namespace meridian::globebrowsing
