#pragma once

#include <algorithm>
#include <chrono>

#include "globebrowsing/network/retry_policy.h"

namespace meridian::globebrowsing {

/// Whether a server is up, from how requests to it ended. While it is down nobody asks but one request at a time,
/// after a pause, to see whether it is back: 10 000 tiles that wait for a dead server cost what one does.
///
/// Knows no clock: whoever uses it says what time it is.
class CircuitBreaker {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  enum class State {
    Up,
    Down,    ///< nothing may be sent before pauseEnd()
    Probing  ///< down, and one request is under way to see; if it hangs, the next may go at pauseEnd()
  };

  explicit CircuitBreaker(const RetryOptions& options) : options_(options) {}

  /// A pause that has begun stays as long as it is.
  void setOptions(const RetryOptions& options) { options_ = options; }

  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] TimePoint pauseEnd() const { return std::max(pauseEnd_, notBefore_); }
  [[nodiscard]] bool mayProbe(TimePoint now) const { return state_ != State::Up && now >= pauseEnd(); }

  /// The request that is sent now is the probe.
  void beginProbe(TimePoint now);
  /// Nobody wants the probe any more: another may go.
  void abandonProbe(TimePoint now);

  /// Any answer proves it up, also to a request that was sent before it was taken to be down; but a pause that the
  /// server has asked for goes on: what answers then was under way when it asked.
  void succeeded(TimePoint now);
  /// Of what is no probe nothing is learned while it is down. `random` in [0, 1) shortens the pause by up to a quarter,
  /// so that many clients do not return together.
  void failed(bool wasProbe, TimePoint now, double random);
  /// Down for as long as the server itself has asked.
  void pauseFor(std::chrono::milliseconds pause, TimePoint now);

 private:
  RetryOptions options_;
  State state_ = State::Up;
  int failures_ = 0;  ///< in a row
  int pauses_ = 0;    ///< since it was last up
  TimePoint pauseEnd_{};
  TimePoint notBefore_{};  ///< by what the server has asked for
};

}  // namespace meridian::globebrowsing
