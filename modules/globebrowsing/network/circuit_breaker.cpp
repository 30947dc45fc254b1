#include "globebrowsing/network/circuit_breaker.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace meridian::globebrowsing {

void CircuitBreaker::beginProbe(TimePoint now) {
  state_ = State::Probing;
  pauseEnd_ = now + options_.maximumPause;
}

void CircuitBreaker::abandonProbe(TimePoint now) {
  if (state_ == State::Probing) {
    state_ = State::Down;
    pauseEnd_ = now;
  }
}

void CircuitBreaker::succeeded(TimePoint now) {
  state_ = now < notBefore_ ? State::Down : State::Up;
  pauseEnd_ = now;
  failures_ = 0;
  pauses_ = 0;
}

void CircuitBreaker::failed(bool wasProbe, TimePoint now, double random) {
  // What was under way when it went down says nothing new.
  if (state_ != State::Up && !wasProbe) {
    return;
  }
  ++failures_;
  if (state_ == State::Up && failures_ < options_.failuresUntilDown) {
    return;
  }
  const double whole = std::min(std::ldexp(static_cast<double>(options_.firstPause.count()), std::min(pauses_, 60)),
                                static_cast<double>(options_.maximumPause.count()));
  ++pauses_;
  state_ = State::Down;
  pauseEnd_ = now + std::chrono::milliseconds(static_cast<std::int64_t>(std::ceil(whole * (1.0 - 0.25 * random))));
}

void CircuitBreaker::pauseFor(std::chrono::milliseconds pause, TimePoint now) {
  notBefore_ = std::max(notBefore_, now + pause);
  state_ = state_ == State::Up ? State::Down : state_;
}

}  // namespace meridian::globebrowsing
