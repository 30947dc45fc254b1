#pragma once

#include <chrono>
#include <optional>

namespace meridian::scripting {

/// How long each frame lasts: measured, or the same for all so that a film comes out alike on any machine.
class FrameTimer {
 public:
  [[nodiscard]] static FrameTimer realTime() { return FrameTimer(0.0); }
  /// `framesPerSecond` is more than 0.
  [[nodiscard]] static FrameTimer fixedStep(double framesPerSecond);

  /// The seconds since the last call; 0 at the first. In real time at most a quarter of a second, so that a pause in
  /// the debugger is no leap.
  double tick();
  [[nodiscard]] bool isFixed() const { return step_ > 0.0; }
  /// All seconds that tick() gave out.
  [[nodiscard]] double total() const;

 private:
  explicit FrameTimer(double step) : step_(step) {}

  double step_;
  std::optional<std::chrono::steady_clock::time_point> last_;
  double total_ = 0.0;
  long frames_ = 0;
};

}  // namespace meridian::scripting
