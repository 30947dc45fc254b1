#include "host/scripting/clock.h"

#include <algorithm>
#include <cmath>

namespace meridian::scripting {

double Clock::rate() const {
  if (rampSeconds_ <= 0.0) {
    return rampTo_;
  }
  return rampFrom_ + (rampTo_ - rampFrom_) * (rampElapsed_ / rampSeconds_);
}

void Clock::setTime(Time time) {
  if (!std::isfinite(time.tdbSeconds())) {
    return;
  }
  time_ = time;
  travelSeconds_ = 0.0;
}

void Clock::interpolateTime(Time time, double seconds) {
  if (!(seconds > 0.0)) {
    setTime(time);
  } else if (std::isfinite(time.tdbSeconds()) && std::isfinite(seconds)) {
    travelFrom_ = time_;
    travelTo_ = time;
    travelStartRate_ = rate();
    travelElapsed_ = 0.0;
    travelSeconds_ = seconds;
  }
}

void Clock::interpolateDeltaTime(double simulationSecondsPerSecond, double seconds) {
  if (!std::isfinite(simulationSecondsPerSecond)) {
    return;
  }
  deltaTime_ = simulationSecondsPerSecond;
  if (!paused_) {
    rampTo(deltaTime_, seconds);
  }
}

void Clock::interpolatePause(bool paused, double seconds) {
  paused_ = paused;
  rampTo(paused ? 0.0 : deltaTime_, seconds);
}

void Clock::rampTo(double target, double seconds) {
  rampFrom_ = rate();
  rampTo_ = target;
  rampElapsed_ = 0.0;
  rampSeconds_ = std::isfinite(seconds) ? std::max(0.0, seconds) : 0.0;
}

void Clock::setDeltaTimeSteps(std::vector<double> steps) {
  std::erase_if(steps, [](double step) { return !std::isfinite(step); });
  std::sort(steps.begin(), steps.end());
  steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
  steps_ = std::move(steps);
}

double Clock::nextDeltaTimeStep() const {
  const auto above = std::upper_bound(steps_.begin(), steps_.end(), deltaTime_);
  return above == steps_.end() ? deltaTime_ : *above;
}

double Clock::previousDeltaTimeStep() const {
  const auto notBelow = std::lower_bound(steps_.begin(), steps_.end(), deltaTime_);
  return notBelow == steps_.begin() ? deltaTime_ : *std::prev(notBelow);
}

double Clock::advanceRamp(double seconds) {
  if (rampSeconds_ <= 0.0) {
    return rampTo_ * seconds;
  }
  const double inside = std::min(seconds, rampSeconds_ - rampElapsed_);
  const double before = rate();
  rampElapsed_ += inside;
  const double after = rate();
  if (rampElapsed_ >= rampSeconds_) {
    rampSeconds_ = 0.0;
  }
  return (before + after) / 2.0 * inside + rampTo_ * (seconds - inside);
}

void Clock::advance(double seconds) {
  if (!(seconds > 0.0) || !std::isfinite(seconds)) {
    return;
  }
  const double inside = std::min(seconds, std::max(0.0, travelSeconds_ - travelElapsed_));
  advanceRamp(inside);
  if (travelSeconds_ > 0.0) {
    travelElapsed_ += inside;
    if (travelElapsed_ >= travelSeconds_) {
      time_ = travelTo_;
      travelSeconds_ = 0.0;
    } else {
      // Cubic Hermite: the times at both ends, and the clock's speeds there.
      const double s = travelElapsed_ / travelSeconds_;
      const double rest = 1.0 - s;
      time_ =
          travelFrom_ + ((travelTo_ - travelFrom_) * s * s * (3.0 - 2.0 * s) +
                         travelStartRate_ * travelSeconds_ * s * rest * rest - rampTo_ * travelSeconds_ * s * s * rest);
    }
  }
  time_ = time_ + advanceRamp(seconds - inside);
}

}  // namespace meridian::scripting
