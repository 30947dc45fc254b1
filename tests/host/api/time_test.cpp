#include "host/api/time.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace meridian {
namespace {

/// TDB seconds past J2000 of calendar instants. TT is UTC + leap seconds + 32.184 s by definition; TDB differs from it
/// by less than 1.7 ms. Leap seconds are those of IERS Bulletin C.
TEST(Time, KnowsTheLeapSeconds) {
  const struct {
    const char* utc;
    double daysPastJ2000;  ///< of the calendar alone
    double leapSeconds;
  } cases[] = {{"2000-01-01T12:00:00", 0.0, 32.0},    {"2005-12-31T23:59:59", 2191.5 - 1.0 / 86400.0, 32.0},
               {"2006-01-01T00:00:00", 2191.5, 33.0}, {"2009-01-01T00:00:00", 3287.5, 34.0},
               {"2012-07-01", 4564.5, 35.0},          {"2015-07-01", 5659.5, 36.0},
               {"2016-12-31T00:00:00", 6208.5, 36.0}, {"2017-01-01T00:00:00", 6209.5, 37.0},
               {"1972-01-01", -10227.5, 10.0},        {"1999-01-01", -365.5, 32.0}};
  for (const auto& each : cases) {
    const Result<Time> time = Time::fromUtc(each.utc);
    ASSERT_TRUE(time) << each.utc;
    EXPECT_NEAR(time->tdbSeconds(), each.daysPastJ2000 * 86400.0 + each.leapSeconds + 32.184, 0.0018) << each.utc;
  }
}

TEST(Time, CountsTheLeapSecondItself) {
  const Time before = *Time::fromUtc("2016-12-31T23:59:59");
  EXPECT_NEAR(*Time::fromUtc("2016-12-31T23:59:60") - before, 1.0, 1e-6);
  EXPECT_NEAR(*Time::fromUtc("2017-01-01T00:00:00") - before, 2.0, 1e-6);
  EXPECT_NEAR(*Time::fromUtc("2016-12-31T18:59:60-05:00") - before, 1.0, 1e-6);
  EXPECT_NEAR(*Time::fromUtc("2016-12-31T19:00:00-05:00") - before, 2.0, 1e-6);
  EXPECT_EQ((before + 1.0).utc(), "2016-12-31T23:59:60.000");
  EXPECT_EQ((before + 2.0).utc(), "2017-01-01T00:00:00.000");
}

TEST(Time, WritesWhatItReads) {
  for (const char* text :
       {"2026-11-22T21:17:05.250", "1969-07-20T20:17:40.000", "2100-02-28T23:59:59.999", "2000-02-29T00:00:00.000"}) {
    EXPECT_EQ(Time::fromUtc(text)->utc(), text);
  }
  EXPECT_EQ(Time::fromUtc("2026-11-22 21:17Z")->utc(), "2026-11-22T21:17:00.000");
  EXPECT_EQ(Time::fromUtc("2026-1-2")->utc(), "2026-01-02T00:00:00.000");
  EXPECT_EQ(Time::fromUtc("2026-11-22T01:17:05.5+02:00")->utc(), "2026-11-21T23:17:05.500");
  EXPECT_EQ(Time::fromUtc("2026-326T21:17")->utc(), "2026-11-22T21:17:00.000");
  // As SPICE writes dates.
  EXPECT_EQ(Time::fromUtc("2018 NOV 26 19:39:01.68")->utc(), "2018-11-26T19:39:01.680");
  EXPECT_EQ(Time::fromUtc("2000-JUL-14 10:03:00.000")->utc(), "2000-07-14T10:03:00.000");
  EXPECT_EQ(Time::fromUtc("1850 jan 01")->utc(), "1850-01-01T00:00:00.000");
  EXPECT_EQ(Time::fromUtc("2026/11/22 21:17:05 Z")->utc(), "2026-11-22T21:17:05.000");
  EXPECT_EQ(Time::fromUtc("2026 November 22")->utc(), "2026-11-22T00:00:00.000");
}

TEST(Time, RefusesWhatTheCalendarDoesNotHave) {
  for (const char* text : {"",
                           "today",
                           "2026-02-29",
                           "2026-13-01",
                           "2026-00-10",
                           "2026-01-01T25:00:00",
                           "2026-01-01T00:60:00",
                           "2026-01-01T00:00:61",
                           "99999-01-01",
                           "2026-01-01T00:00:00 x",
                           "2026 NOX 01",
                           "2026 NO 01",
                           "2026 NOV",
                           "2026NOV01",
                           "2026",
                           "2026-11",
                           "20261122",
                           "2026-11-22T21",
                           "2026-11-22+21:17",
                           "2026-11-22T21:17+99",
                           "2026-11-22T24:00+01"}) {
    EXPECT_FALSE(Time::fromUtc(text)) << text;
  }
  EXPECT_FALSE(Time::fromUtc(std::string(1000, '1')));
}

TEST(Time, NeverFailsToWrite) {
  EXPECT_NE(Time(std::nan("")).utc().find("TDB"), std::string::npos);
  EXPECT_NE(Time(1e300).utc(), "");
}

TEST(Time, GoesToTheCalendarAndBack) {
  using namespace std::chrono;
  struct Case {
    const char* text;
    Time::UtcInstant instant;
  };
  for (const Case& c : {Case{"2016-02-29T12:30:15.250", sys_days(2016y / 2 / 29) + 12h + 30min + 15'250ms},
                        Case{"1969-12-31T23:59:59.999", sys_days(1970y / 1 / 1) - 1ms},
                        Case{"0001-01-01T00:00:00.000", sys_days(1y / 1 / 1)},
                        Case{"2017-01-01T00:00:00.000", sys_days(2017y / 1 / 1)}}) {
    EXPECT_EQ(Time::fromUtc(c.text)->utcInstant(), c.instant) << c.text;
    EXPECT_EQ(Time::fromUtcInstant(c.instant).utc(), c.text);
  }
  EXPECT_EQ(Time::fromUtc("2016-12-31T23:59:60.5")->utcInstant(), sys_days(2017y / 1 / 1) - 1ms) << "a leap second";
  EXPECT_EQ(Time(1e300).utcInstant(), sys_days(10000y / 1 / 1) - 1ms);
  EXPECT_EQ(Time(-1e300).utcInstant(), sys_days(-4000y / 1 / 1));
  EXPECT_EQ(Time::fromUtcInstant(Time::UtcInstant::max()).utc(), "9999-12-31T23:59:59.999");
}

TEST(Time, GivesJulianDates) {
  const Time::JulianDate date = Time(0.0).julianDateTdb();
  EXPECT_EQ(date.day + date.fraction, 2451545.0);
  const Time::JulianDate earlier = Time(-43200.0).julianDateTdb();
  EXPECT_EQ(earlier.day + earlier.fraction, 2451544.5);
}

}  // namespace
}  // namespace meridian
