#include "globebrowsing/providers/time_quantizer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;

Time::UtcInstant at(const char* text) {
  return Time::fromUtc(text)->utcInstant();
}

TimeQuantizer quantizer(const char* start, const char* end, const char* resolution) {
  return *TimeQuantizer::create(at(start), at(end), *TimeResolution::read(resolution));
}

struct Case {
  const char* start;
  const char* end;
  const char* resolution;
  const char* instant;
  const char* quantized;
};

void check(const Case& c) {
  EXPECT_EQ(Time::fromUtcInstant(quantizer(c.start, c.end, c.resolution).quantize(at(c.instant))).utc(),
            std::string(c.quantized) + ".000")
      << c.start << ' ' << c.resolution << ' ' << c.instant;
}

TEST(TimeQuantizer, GoesWhereOpenSpacesDoes) {
  // The facts of OpenSpace's own tests (openspace-formats.md, d.3).
  constexpr const char* midnight = "T00:00:00";
  struct Vector {
    const char* instant;
    std::string quantized;
  };
  struct Series {
    const char* start;
    const char* end;
    const char* resolution;
    std::vector<Vector> vectors;
  };
  const auto day = [&](const char* date) { return std::string(date) + midnight; };
  const std::vector<Series> table{
      {"2019-12-09",
       "2030-03-01",
       "1y",
       {{"2020-12-08T23:59:59", day("2019-12-09")},
        {"2020-12-09T00:00:00", day("2020-12-09")},
        {"2021-12-08T23:59:58", day("2020-12-09")},
        {"2022-11-08T13:00:15", day("2021-12-09")},
        {"2024-12-08T23:59:59", day("2023-12-09")},
        {"2020-12-31T23:59:59", day("2020-12-09")},
        {"2021-01-01T00:00:00", day("2020-12-09")}}},
      {"2019-12-09",
       "2030-03-01",
       "3y",
       {{"2020-12-08T23:59:59", day("2019-12-09")},
        {"2022-12-09T00:00:00", day("2022-12-09")},
        {"2028-12-08T23:59:59", day("2025-12-09")},
        {"2028-12-09T00:00:01", day("2028-12-09")}}},
      {"2019-12-09",
       "2020-03-01",
       "1d",
       {{"2020-01-07T05:15:45", day("2020-01-07")},
        {"2020-01-06T23:59:59", day("2020-01-06")},
        {"2020-02-29T00:00:02", day("2020-02-29")},
        {"2020-03-02T14:00:00", day("2020-03-01")},
        {"2019-12-08T23:59:00", day("2019-12-09")},
        {"2019-12-05T14:29:00", day("2019-12-09")}}},
      {"2016-05-28",
       "2021-09-01",
       "4d",
       {{"2016-06-01T00:00:01", day("2016-06-01")},
        {"2016-07-03T10:00:00", day("2016-07-03")},
        {"2016-07-07T00:00:00", day("2016-07-07")},
        {"2021-11-07T00:00:00", day("2021-09-01")}}},
      {"2017-01-28",
       "2020-09-01",
       "1M",
       {{"2017-03-03T05:15:45", day("2017-02-28")}, {"2017-03-29T00:15:45", day("2017-03-28")}}},
      {"2016-01-17",
       "2020-09-01",
       "2M",
       {{"2016-03-16T08:15:45", day("2016-01-17")},
        {"2016-03-17T18:00:02", day("2016-03-17")},
        {"2016-11-17T10:15:45", day("2016-11-17")},
        {"2017-01-18T05:15:45", day("2017-01-17")}}},
      {"2016-01-17",
       "2020-09-01",
       "3M",
       {{"2016-04-16T05:15:45", day("2016-01-17")}, {"2017-10-17T00:01:00", day("2017-10-17")}}},
      {"2016-05-28",
       "2021-09-01",
       "6M",
       {{"2016-11-28T00:00:05", day("2016-11-28")}, {"2017-10-17T05:01:00", day("2017-05-28")}}},
      {"2019-02-21", "2021-09-01", "2h", {{"2019-02-28T16:10:00", "2019-02-28T16:00:00"}}},
      {"2019-02-21", "2021-09-01", "3h", {{"2019-02-28T21:10:00", "2019-02-28T21:00:00"}}},
      {"2019-02-21", "2021-09-01", "30m", {{"2019-02-28T21:29:59", "2019-02-28T21:00:00"}}},
      {"2019-02-21", "2021-09-01", "15m", {{"2019-02-28T22:59:59", "2019-02-28T22:45:00"}}},
      {"1000-01-01",
       "2001-01-01",
       "1d",
       {{"1900-11-30T20:11:07", day("1900-11-30")},
        {"1799-07-31T02:13:17", day("1799-07-31")},
        {"2000-01-01T11:59:59", day("2000-01-01")},
        {"1999-12-31T23:59:59", day("1999-12-31")}}}};
  for (const Series& series : table) {
    for (const Vector& vector : series.vectors) {
      check({series.start, series.end, series.resolution, vector.instant, vector.quantized.c_str()});
    }
  }
}

TEST(TimeQuantizer, GoesWhereAnotherCalendarSays) {
  // From Python's datetime, stepping from the start.
  for (const Case& c : {
           Case{"1871-12-31", "2104-12-31", "7y", "1956-10-10T14:40:05", "1955-12-31T00:00:00"},
           Case{"1871-12-31", "2104-12-31", "7y", "1972-12-15T10:21:13", "1969-12-31T00:00:00"},
           Case{"1871-12-31", "2104-12-31", "7y", "2012-01-18T03:03:11", "2011-12-31T00:00:00"},
           Case{"1999-01-28", "2031-06-28", "5M", "2014-12-01T13:21:58", "2014-11-28T00:00:00"},
           Case{"1999-01-28", "2031-06-28", "5M", "2025-06-23T06:39:25", "2025-04-28T00:00:00"},
           Case{"1999-01-28", "2031-06-28", "5M", "2031-03-04T15:06:05", "2031-02-28T00:00:00"},
           Case{"1996-02-29", "2026-01-01", "28d", "2004-08-20T02:50:53", "2004-08-05T00:00:00"},
           Case{"1996-02-29", "2026-01-01", "28d", "2018-03-30T04:12:05", "2018-03-29T00:00:00"},
           Case{"1996-02-29", "2026-01-01", "28d", "1997-12-04T09:50:06", "1997-12-04T00:00:00"},
           Case{"1972-06-30", "1973-01-02", "12h", "1972-12-21T22:30:02", "1972-12-21T12:00:00"},
           Case{"1972-06-30", "1973-01-02", "12h", "1972-07-21T23:34:40", "1972-07-21T12:00:00"},
           Case{"2016-12-31", "2017-01-03", "15m", "2017-01-01T03:04:23", "2017-01-01T03:00:00"},
           Case{"2016-12-31", "2017-01-03", "15m", "2017-01-02T15:14:17", "2017-01-02T15:00:00"},
           Case{"1582-10-01", "1583-01-01", "3d", "1582-10-24T22:33:22", "1582-10-22T00:00:00"},
           Case{"1582-10-01", "1583-01-01", "3d", "1582-11-22T19:03:16", "1582-11-21T00:00:00"},
           // The leap second before 2017 belongs to the last step of 2016.
           Case{"2016-12-31", "2017-01-03", "15m", "2016-12-31T23:59:60", "2016-12-31T23:45:00"},
       }) {
    check(c);
  }
}

TEST(TimeQuantizer, EachStepEndsWhereTheNextBegins) {
  for (const auto& [start, end, resolution] :
       {std::tuple("2000-01-01", "2003-01-15", "1M"), std::tuple("2000-01-01", "2000-01-09", "1d"),
        std::tuple("2000-01-31", "2040-05-01", "3y"), std::tuple("2000-02-28", "2000-02-28", "15m")}) {
    const TimeQuantizer series = quantizer(start, end, resolution);
    TimeQuantizer::Instant step = series.quantize(series.start());
    EXPECT_EQ(step, series.start());
    int count = 0;
    while (const auto next = series.following(step)) {
      ASSERT_GT(*next, step);
      EXPECT_EQ(series.quantize(*next - std::chrono::milliseconds(1)), step) << start << ' ' << resolution;
      EXPECT_NE(series.quantize(*next), step);
      step = series.quantize(*next);
      ASSERT_LT(++count, 50);
    }
    EXPECT_EQ(step, series.end());
    EXPECT_EQ(series.quantize(series.end() + std::chrono::days(1000)), series.end());
  }
}

TEST(TimeQuantizer, RefusesWhatIsNoResolution) {
  for (const char* good : {"1y", "78y", "1M", "6M", "1d", "28d", "12h", "15m", "30m"}) {
    EXPECT_TRUE(TimeResolution::read(good)) << good;
  }
  for (const char* bad : {"",   "d",  "1",   "0y",  "-1d",  "7M",  "0d",  "29d",          "5h",       "11h", "12m",
                          "1m", "0m", "31m", "10s", "1.5d", " 1d", "1d ", "99999999999d", "2000000y", "1D"}) {
    const auto read = TimeResolution::read(bad);
    ASSERT_FALSE(read) << bad;
    EXPECT_FALSE(read.error().remedy.empty());
  }
}

TEST(TimeQuantizer, RefusesSeriesThatTheCalendarDoesNotHave) {
  struct Bad {
    const char* start;
    const char* end;
    const char* resolution;
    const char* what;
  };
  for (const Bad& c : {Bad{"2020-01-02", "2020-01-01", "1d", "before the start"},
                       Bad{"2020-01-02T00:00:01", "2020-01-03", "1d", "midnight"},
                       Bad{"2017-01-30", "2020-09-01", "1M", "months cannot start on the 30"},
                       Bad{"2020-02-29", "2030-02-28", "1y", "years cannot start on the 29"}}) {
    const auto made = TimeQuantizer::create(at(c.start), at(c.end), *TimeResolution::read(c.resolution));
    ASSERT_FALSE(made) << c.what;
    EXPECT_THAT(made.error().what, HasSubstr(c.what));
  }
  EXPECT_TRUE(TimeQuantizer::create(at("2020-02-29"), at("2021-02-28"), *TimeResolution::read("1d")));
  EXPECT_TRUE(TimeQuantizer::create(at("2020-01-31"), at("2021-02-28"), *TimeResolution::read("1y")));
}

}  // namespace
}  // namespace meridian::globebrowsing
