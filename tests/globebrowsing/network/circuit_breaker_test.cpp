#include "globebrowsing/network/circuit_breaker.h"

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

using std::chrono::milliseconds;
using State = CircuitBreaker::State;

constexpr RetryOptions options{
    .failuresUntilDown = 3, .firstPause = milliseconds(1000), .maximumPause = milliseconds(4000)};
constexpr CircuitBreaker::TimePoint start{};

CircuitBreaker downBreaker() {
  CircuitBreaker breaker(options);
  for (int i = 0; i < 3; ++i) {
    breaker.failed(false, start, 0.0);
  }
  return breaker;
}

TEST(CircuitBreaker, OnlyFailuresInARowBringItDown) {
  CircuitBreaker breaker(options);
  for (int i = 0; i < 10; ++i) {
    breaker.failed(false, start, 0.0);
    breaker.failed(false, start, 0.0);
    breaker.succeeded(start);
  }
  EXPECT_EQ(breaker.state(), State::Up);
  EXPECT_EQ(downBreaker().state(), State::Down);
}

TEST(CircuitBreaker, LetsOneThroughAfterThePause) {
  CircuitBreaker breaker = downBreaker();
  EXPECT_FALSE(breaker.mayProbe(start + milliseconds(999)));
  EXPECT_TRUE(breaker.mayProbe(start + milliseconds(1000)));
  breaker.beginProbe(start + milliseconds(1000));
  EXPECT_FALSE(breaker.mayProbe(start + milliseconds(4999)));
  EXPECT_TRUE(breaker.mayProbe(start + milliseconds(5000))) << "it hangs";
  breaker.succeeded(start + milliseconds(5000));
  EXPECT_EQ(breaker.state(), State::Up);
}

TEST(CircuitBreaker, PausesTwiceAsLongUpToTheMaximumAndForgetsWhenItIsUp) {
  CircuitBreaker breaker = downBreaker();
  auto now = start;
  for (const int expected : {1000, 2000, 4000, 4000, 4000}) {
    EXPECT_EQ(breaker.pauseEnd() - now, milliseconds(expected));
    now = breaker.pauseEnd();
    breaker.beginProbe(now);
    breaker.failed(true, now, 0.0);
  }
  breaker.succeeded(now);
  for (int i = 0; i < 3; ++i) {
    breaker.failed(false, now, 0.0);
  }
  EXPECT_EQ(breaker.pauseEnd() - now, milliseconds(1000));
}

TEST(CircuitBreaker, JitterShortensThePauseByAQuarterAtMost) {
  CircuitBreaker breaker(options);
  for (int i = 0; i < 3; ++i) {
    breaker.failed(false, start, 0.99);
  }
  EXPECT_GE(breaker.pauseEnd() - start, milliseconds(750));
  EXPECT_LT(breaker.pauseEnd() - start, milliseconds(760));
}

TEST(CircuitBreaker, WhatWasUnderWayWhenItWentDownSaysNothingNew) {
  CircuitBreaker breaker = downBreaker();
  const auto end = breaker.pauseEnd();
  breaker.failed(false, start + milliseconds(500), 0.0);
  EXPECT_EQ(breaker.pauseEnd(), end);
  breaker.beginProbe(start + milliseconds(1000));
  breaker.failed(false, start + milliseconds(1500), 0.0);
  EXPECT_EQ(breaker.state(), State::Probing);
  breaker.succeeded(start + milliseconds(1600));  // a late success is one
  EXPECT_EQ(breaker.state(), State::Up);
}

TEST(CircuitBreaker, PausesForAsLongAsTheServerAsks) {
  CircuitBreaker breaker(options);
  breaker.pauseFor(milliseconds(200), start);
  EXPECT_EQ(breaker.state(), State::Down);
  EXPECT_FALSE(breaker.mayProbe(start + milliseconds(199)));
  EXPECT_TRUE(breaker.mayProbe(start + milliseconds(200)));
  CircuitBreaker down = downBreaker();
  down.pauseFor(milliseconds(200), start);
  EXPECT_EQ(down.pauseEnd(), start + milliseconds(1000)) << "never shorter than its own pause";
}

TEST(CircuitBreaker, NothingEndsThePauseThatTheServerHasAskedFor) {
  CircuitBreaker breaker(options);
  breaker.pauseFor(milliseconds(9000), start);
  breaker.succeeded(start + milliseconds(5));
  breaker.pauseFor(milliseconds(100), start + milliseconds(6));
  EXPECT_EQ(breaker.state(), State::Down);
  EXPECT_EQ(breaker.pauseEnd(), start + milliseconds(9000));

  // Nor while a probe is under way, however that ends.
  breaker.beginProbe(start + milliseconds(9000));
  breaker.pauseFor(milliseconds(8000), start + milliseconds(9001));
  breaker.abandonProbe(start + milliseconds(9002));
  EXPECT_FALSE(breaker.mayProbe(start + milliseconds(17'000)));
  CircuitBreaker failing = breaker;
  failing.beginProbe(start + milliseconds(17'001));
  failing.pauseFor(milliseconds(8000), start + milliseconds(17'002));
  failing.failed(true, start + milliseconds(17'003), 0.0);
  EXPECT_EQ(failing.pauseEnd(), start + milliseconds(25'002));

  breaker.beginProbe(start + milliseconds(17'001));
  breaker.pauseFor(milliseconds(2000), start + milliseconds(17'002));
  breaker.succeeded(start + milliseconds(17'003));
  EXPECT_EQ(breaker.pauseEnd(), start + milliseconds(19'002)) << "and not the longer time that a probe may take";
  breaker.beginProbe(start + milliseconds(19'002));
  breaker.succeeded(start + milliseconds(19'003));
  EXPECT_EQ(breaker.state(), State::Up);
}

TEST(CircuitBreaker, AnAbandonedProbeMakesRoomForAnother) {
  CircuitBreaker breaker = downBreaker();
  breaker.beginProbe(start + milliseconds(1000));
  breaker.abandonProbe(start + milliseconds(1100));
  EXPECT_TRUE(breaker.mayProbe(start + milliseconds(1100)));
  breaker.succeeded(start + milliseconds(1150));
  breaker.abandonProbe(start + milliseconds(1200));
  EXPECT_EQ(breaker.state(), State::Up);
}

}  // namespace
}  // namespace meridian::globebrowsing
