#include "host/scripting/clock.h"

#include <cmath>

#include <gtest/gtest.h>

#include "host/scripting/frame_timer.h"
#include "host/scripting/script_engine.h"
#include "host/scripting/time_scripts.h"

namespace meridian::scripting {
namespace {

TEST(Clock, RunsAtItsSpeedAndStandsWhenPaused) {
  Clock clock(Time(100.0));
  clock.advance(0.5);
  EXPECT_DOUBLE_EQ(clock.time().tdbSeconds(), 100.5);
  clock.setDeltaTime(-3600.0);
  clock.advance(2.0);
  EXPECT_DOUBLE_EQ(clock.time().tdbSeconds(), 100.5 - 7200.0);
  clock.setPause(true);
  clock.setDeltaTime(5.0);
  clock.advance(2.0);
  EXPECT_DOUBLE_EQ(clock.time().tdbSeconds(), 100.5 - 7200.0);
  clock.setPause(false);
  clock.advance(1.0);
  EXPECT_DOUBLE_EQ(clock.time().tdbSeconds(), 105.5 - 7200.0);
}

TEST(Clock, IntegratesASpeedRampWhateverTheFrames) {
  for (const int frames : {1, 3, 100}) {
    Clock clock;
    clock.interpolateDeltaTime(11.0, 2.0);
    for (int i = 0; i < frames; ++i) {
      clock.advance(4.0 / frames);
    }
    // The mean of 1 and 11 for two seconds, then 11 for two.
    EXPECT_NEAR(clock.time().tdbSeconds(), 12.0 + 22.0, 1e-9) << frames;
    EXPECT_DOUBLE_EQ(clock.rate(), 11.0);
  }
}

TEST(Clock, PausesGently) {
  Clock clock;
  clock.interpolatePause(true, 1.0);
  EXPECT_TRUE(clock.isPaused());
  clock.advance(0.5);
  EXPECT_DOUBLE_EQ(clock.rate(), 0.5);
  clock.advance(9.0);
  EXPECT_DOUBLE_EQ(clock.time().tdbSeconds(), 0.5);
}

TEST(Clock, ArrivesAtATimeAndGoesOnWithoutAJerk) {
  Clock clock;
  clock.interpolateTime(Time(1000.0), 2.0);
  clock.advance(1e-4);
  EXPECT_NEAR(clock.time().tdbSeconds(), 1e-4, 1e-4);
  clock.advance(1.0 - 1e-4);
  EXPECT_NEAR(clock.time().tdbSeconds(), 500.0, 1e-9);
  clock.advance(1.5);
  EXPECT_FALSE(clock.isInterpolatingTime());
  EXPECT_NEAR(clock.time().tdbSeconds(), 1000.5, 1e-9);
}

TEST(Clock, IgnoresWhatIsNotFinite) {
  Clock clock;
  clock.setTime(Time(std::nan("")));
  clock.setDeltaTime(INFINITY);
  clock.interpolateTime(Time(INFINITY), 1.0);
  clock.advance(std::nan(""));
  clock.advance(-1.0);
  EXPECT_EQ(clock.time().tdbSeconds(), 0.0);
  EXPECT_EQ(clock.deltaTime(), 1.0);
}

TEST(FrameTimer, FixedStepsAddUpExactly) {
  FrameTimer timer = FrameTimer::fixedStep(30.0);
  EXPECT_EQ(timer.tick(), 0.0);
  for (int i = 0; i < 3000; ++i) {
    EXPECT_EQ(timer.tick(), 1.0 / 30.0);
  }
  EXPECT_DOUBLE_EQ(timer.total(), 100.0);
}

TEST(TimeScripts, MoveTimesByText) {
  const Time leapDay = *Time::fromUtc("2024-02-29T10:00:00");
  const std::pair<const char*, const char*> cases[] = {
      {"90s", "2024-02-29T10:01:30.000"}, {"-2h", "2024-02-29T08:00:00.000"}, {"1.5d", "2024-03-01T22:00:00.000"},
      {"12M", "2025-02-28T10:00:00.000"}, {"-1M", "2024-01-29T10:00:00.000"}, {"-26M", "2021-12-29T10:00:00.000"},
      {"4y", "2028-02-29T10:00:00.000"},  {"-1y", "2023-02-28T10:00:00.000"}, {"30m", "2024-02-29T10:30:00.000"}};
  for (const auto& [change, expected] : cases) {
    const Result<Time> moved = advanced(leapDay, change);
    ASSERT_TRUE(moved) << change << moved.error().message();
    EXPECT_EQ(moved->utc(), expected) << change;
  }
  for (const char* change : {"", "d", "3", "3w", "1.5M", "9999999y", "nand", "3 d", "99999y"}) {
    EXPECT_FALSE(advanced(leapDay, change)) << change;
  }
}

TEST(TimeScripts, WorkOnTheClock) {
  Clock clock;
  ScriptEngine engine;
  engine.registerLibrary(timeLibrary(clock, [] { return 7.0; }));
  const Result<void> result = engine.run(
      "local t = openspace.time\n"
      "t.setTime('2000-01-01T12:00:00') assert(math.abs(t.currentTime() - 64.184) < 0.01)\n"
      "assert(t.UTC() == '2000-01-01T12:00:00.000')\n"
      "t.setDeltaTime(60) assert(t.deltaTime() == 60) t.setNextDeltaTimeStep() assert(t.deltaTime() == 300)\n"
      "t.setPreviousDeltaTimeStep() assert(t.deltaTime() == 60)\n"
      "t.togglePause() assert(t.isPaused()) t.setPause(false) assert(not t.isPaused())\n"
      "t.setDeltaTimeSteps({1, 2}) t.setNextDeltaTimeStep() assert(t.deltaTime() == 60)\n"
      "assert(t.duration('2016-12-31T23:59:59', '2017-01-01T00:00:00') > 1.9)\n"
      "assert(t.advancedTime('2020-01-31T00:00:00', '1M') == '2020-02-29T00:00:00.000')\n"
      "assert(t.advancedTime(10, -4) == 6 and t.convertTime(t.convertTime(0)) < 0.001)\n"
      "assert(t.secondsPerDay() == 86400 and t.currentApplicationTime() == 7)",
      "test");
  EXPECT_TRUE(result) << result.error().message();
  for (const char* text :
       {"openspace.time.setTime('yesterday')", "openspace.time.setTime(0/0)", "openspace.time.setPause(1)",
        "openspace.time.setDeltaTime('x')", "openspace.time.setDeltaTimeSteps({})"}) {
    EXPECT_FALSE(engine.run(text, "test")) << text;
  }
}

}  // namespace
}  // namespace meridian::scripting
