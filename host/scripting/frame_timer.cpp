#include "host/scripting/frame_timer.h"

#include <algorithm>
#include <cassert>

namespace meridian::scripting {

namespace {

constexpr double longestFrame = 0.25;

}  // namespace

FrameTimer FrameTimer::fixedStep(double framesPerSecond) {
  assert(framesPerSecond > 0.0);
  return FrameTimer(1.0 / framesPerSecond);
}

double FrameTimer::tick() {
  const auto now = std::chrono::steady_clock::now();
  if (!last_) {
    last_ = now;
    return 0.0;
  }
  ++frames_;
  if (isFixed()) {
    return step_;
  }
  const double seconds = std::min(std::chrono::duration<double>(now - *last_).count(), longestFrame);
  last_ = now;
  total_ += seconds;
  return seconds;
}

double FrameTimer::total() const {
  return isFixed() ? step_ * static_cast<double>(frames_) : total_;
}

}  // namespace meridian::scripting
