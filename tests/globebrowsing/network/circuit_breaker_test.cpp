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
    breaker.succeeded();
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
  breaker.succeeded();
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
  breaker.succeeded();
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
  breaker.succeeded();  // a late success is one
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

TEST(CircuitBreaker, AnAbandonedProbeMakesRoomForAnother) {
  CircuitBreaker breaker = downBreaker();
  breaker.beginProbe(start + milliseconds(1000));
  breaker.abandonProbe(start + milliseconds(1100));
  EXPECT_TRUE(breaker.mayProbe(start + milliseconds(1100)));
  breaker.succeeded();
  breaker.abandonProbe(start + milliseconds(1200));
  EXPECT_EQ(breaker.state(), State::Up);
}

}  // namespace
}  // namespace meridian::globebrowsing
