#include "globebrowsing/network/retry_policy.h"

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

using std::chrono::milliseconds;

TEST(RetryPolicy, SortsStatuses) {
  struct Case {
    int status;
    Outcome outcome;
  };
  for (const Case& test :
       {Case{200, Outcome::Done},        Case{204, Outcome::Done},        Case{304, Outcome::Done},
        Case{301, Outcome::Final},       Case{400, Outcome::Final},       Case{401, Outcome::Final},
        Case{403, Outcome::Final},       Case{404, Outcome::Final},       Case{408, Outcome::ServerError},
        Case{425, Outcome::ServerError}, Case{429, Outcome::Unavailable}, Case{500, Outcome::ServerError},
        Case{501, Outcome::ServerError}, Case{502, Outcome::Unavailable}, Case{503, Outcome::Unavailable},
        Case{504, Outcome::Unavailable}, Case{522, Outcome::Unavailable}, Case{524, Outcome::Unavailable},
        Case{599, Outcome::ServerError}, Case{100, Outcome::Final}}) {
    EXPECT_EQ(outcomeOfStatus(test.status), test.outcome) << test.status;
  }
}

TEST(RetryPolicy, WaitsTwiceAsLongEachTimeUpToTheMaximum) {
  const RetryOptions options{.firstDelay = milliseconds(100), .maximumDelay = milliseconds(1000)};
  const double nearlyOne = 1.0 - 1e-12;
  EXPECT_EQ(retryDelay(options, 1, nearlyOne).count(), 99);
  EXPECT_EQ(retryDelay(options, 2, nearlyOne).count(), 199);
  EXPECT_EQ(retryDelay(options, 4, nearlyOne).count(), 799);
  EXPECT_EQ(retryDelay(options, 5, nearlyOne).count(), 999);
  EXPECT_EQ(retryDelay(options, 1'000'000, nearlyOne).count(), 999);
  EXPECT_EQ(retryDelay(options, 4, 0.0).count(), 0) << "full jitter begins at nothing";
  EXPECT_EQ(retryDelay(options, 4, 0.5).count(), 400);
  EXPECT_EQ(retryDelay({.firstDelay = milliseconds(0)}, 3, 0.9).count(), 0);
}

TEST(RetryPolicy, ReadsRetryAfter) {
  const RetryOptions options{.maximumRetryAfter = milliseconds(60'000)};
  constexpr UnixTime now = 784111777;
  EXPECT_EQ(retryAfter(options, "7", now), milliseconds(7000));
  EXPECT_EQ(retryAfter(options, " 0 ", now), milliseconds(0));
  EXPECT_EQ(retryAfter(options, "86400", now), milliseconds(60'000));
  EXPECT_EQ(retryAfter(options, "99999999999999999999999", now), milliseconds(60'000));
  EXPECT_EQ(retryAfter(options, "Sun, 06 Nov 1994 08:49:47 GMT", now), milliseconds(10'000));
  EXPECT_EQ(retryAfter(options, "Sun, 06 Nov 1994 08:49:27 GMT", now), milliseconds(0));
  for (const char* text : {"", "soon", "-1", "1.5"}) {
    EXPECT_EQ(retryAfter(options, text, now), std::nullopt) << text;
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
