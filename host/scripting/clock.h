#pragma once

#include <vector>

#include "host/api/time.h"

namespace meridian::scripting {

/// The simulation's time: how fast it runs against frame time, and where it is. Whoever owns the frame calls advance()
/// once per frame with a FrameTimer's seconds.
class Clock {
 public:
  explicit Clock(Time start = {}) : time_(start) {}

  [[nodiscard]] Time time() const { return time_; }
  /// Simulation seconds per frame-time second when not paused; where an interpolation goes to while one runs.
  [[nodiscard]] double deltaTime() const { return deltaTime_; }
  [[nodiscard]] bool isPaused() const { return paused_; }
  /// The speed at this moment: between speeds while one is interpolated, 0 when paused.
  [[nodiscard]] double rate() const;

  /// At once; ends an interpolation of the time. Not finite: ignored.
  void setTime(Time time);
  /// At once. Not finite: ignored.
  void setDeltaTime(double simulationSecondsPerSecond) { interpolateDeltaTime(simulationSecondsPerSecond, 0.0); }
  void setPause(bool paused) { interpolatePause(paused, 0.0); }

  /// Over so many seconds of frame time, 0 or less meaning at once. The way to another time begins and ends with the
  /// speed the clock has then, so that nothing jerks.
  void interpolateTime(Time time, double seconds);
  void interpolateDeltaTime(double simulationSecondsPerSecond, double seconds);
  void interpolatePause(bool paused, double seconds);
  [[nodiscard]] bool isInterpolatingTime() const { return travelSeconds_ > 0.0; }

  /// The speeds that next and previous step through, kept in ascending order.
  void setDeltaTimeSteps(std::vector<double> steps);
  [[nodiscard]] const std::vector<double>& deltaTimeSteps() const { return steps_; }
  /// The nearest step above or below the present speed; the present one when there is none.
  [[nodiscard]] double nextDeltaTimeStep() const;
  [[nodiscard]] double previousDeltaTimeStep() const;

  void advance(double seconds);

 private:
  void rampTo(double rate, double seconds);
  /// Simulation seconds that the ramp yields in so many seconds.
  double advanceRamp(double seconds);

  Time time_;
  double deltaTime_ = 1.0;
  bool paused_ = false;

  double rampFrom_ = 1.0;
  double rampTo_ = 1.0;
  double rampElapsed_ = 0.0;
  double rampSeconds_ = 0.0;

  Time travelFrom_;
  Time travelTo_;
  double travelStartRate_ = 0.0;
  double travelElapsed_ = 0.0;
  double travelSeconds_ = 0.0;

  std::vector<double> steps_{1.0,     5.0,     30.0,     60.0,      300.0,     1800.0,    3600.0,
                             43200.0, 86400.0, 604800.0, 1209600.0, 2592000.0, 5184000.0, 31557600.0};
};

}  // namespace meridian::scripting
