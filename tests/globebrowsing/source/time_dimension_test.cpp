#include "globebrowsing/source/time_dimension.h"

#include <chrono>

#include "globebrowsing/source/service_text.h"
#include "service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

const Time now = *Time::fromUtc("2026-11-25T12:00:00");

TimeDimension dimension(std::string_view values, std::string_view standard = {}) {
  return TimeDimension::parse(values, standard, now);
}

CalendarMilliseconds at(std::string_view text) {
  const auto time = Time::fromUtc(text);
  EXPECT_TRUE(time) << text;
  return calendarOf(time.value_or(Time()));
}

std::string textOf(const TimeDimension::Found& value) {
  return value ? writeInstant(value->at, value->style) : "nothing";
}

TEST(Calendar, ReadsWhatServicesWrite) {
  struct Case {
    const char* text;
    const char* utc;  ///< null: no time
  };
  for (const Case& test : std::initializer_list<Case>{{"1990", "1990-01-01T00:00:00"},
                                                      {"2007-05", "2007-05-01T00:00:00"},
                                                      {"2012-02-29", "2012-02-29T00:00:00"},
                                                      {"20110805", "2011-08-05T00:00:00"},
                                                      {"20110805T1230", "2011-08-05T12:30:00"},
                                                      {"20110805T123015Z", "2011-08-05T12:30:15"},
                                                      {"2012-02-29T12", "2012-02-29T12:00:00"},
                                                      {"2012-02-29T12:30", "2012-02-29T12:30:00"},
                                                      {"2012-02-29T12:30Z", "2012-02-29T12:30:00"},
                                                      {"2012-02-29T12:30:15.250Z", "2012-02-29T12:30:15.250"},
                                                      {"2012-02-29 12:30:15", "2012-02-29T12:30:15"},
                                                      {"2012-02-29T12:30:15+02:00", "2012-02-29T10:30:15"},
                                                      {"2012-02-29T00:30:15-0130", "2012-02-29T02:00:15"},
                                                      {"2012-02-28T24:00:00Z", "2012-02-29T00:00:00"},
                                                      {" 2012-02-29 ", "2012-02-29T00:00:00"},
                                                      // Weeks and days of the year, by Python's date.isocalendar.
                                                      {"2024-W05-3", "2024-01-31T00:00:00"},
                                                      {"2024W053", "2024-01-31T00:00:00"},
                                                      {"2024-W05", "2024-01-29T00:00:00"},
                                                      {"2024W05", "2024-01-29T00:00:00"},
                                                      {"2024-W05-3T12:30Z", "2024-01-31T12:30:00"},
                                                      {"2025-W01-1", "2024-12-30T00:00:00"},
                                                      {"2020-W53-7", "2021-01-03T00:00:00"},
                                                      {"2023-W01-1", "2023-01-02T00:00:00"},
                                                      {"2024-031", "2024-01-31T00:00:00"},
                                                      {"2024031", "2024-01-31T00:00:00"},
                                                      {"2024-366", "2024-12-31T00:00:00"},
                                                      {"2023365T23", "2023-12-31T23:00:00"},
                                                      {"2024-02-03-0130", "2024-02-03T01:30:00"},
                                                      {"20240203-0130", "2024-02-03T01:30:00"},
                                                      {"2024-W00-1", nullptr},
                                                      {"2024-W53-1", nullptr},
                                                      {"2024-W05-0", nullptr},
                                                      {"2024-W05-8", nullptr},
                                                      {"2024-W5-3", nullptr},
                                                      {"2024-W", nullptr},
                                                      {"2024-000", nullptr},
                                                      {"2023-366", nullptr},
                                                      {"2024-0311", nullptr},
                                                      {"99999-W01", nullptr},
                                                      {"99999-001", nullptr},
                                                      {"2011-02-29", nullptr},
                                                      {"2011-13-01", nullptr},
                                                      {"2011-1-1", nullptr},
                                                      {"2011-01-01T25:00", nullptr},
                                                      {"2011-01-01T12:61", nullptr},
                                                      {"2011-01-01x", nullptr},
                                                      {"20", nullptr},
                                                      {"-", nullptr},
                                                      {"", nullptr},
                                                      {"default", nullptr}}) {
    const auto instant = readInstant(test.text);
    ASSERT_EQ(instant.has_value(), test.utc != nullptr) << test.text;
    if (instant) {
      EXPECT_EQ(instant->at, at(test.utc)) << test.text;
    }
  }
}

TEST(Calendar, WritesInstantsAsTheyWereWritten) {
  for (const char* text : {"1990",
                           "2007-05",
                           "2012-02-29",
                           "20110805",
                           "2012-02-29T12",
                           "2012-02-29T12:30Z",
                           "2012-02-29T12:30:15",
                           "2012-02-29T12:30:15.250Z",
                           "2012-02-29 12:30:15",
                           "20110805T123015Z",
                           "1969-12-31T23:59:59.999Z",
                           "0001-01-01",
                           "2024-W05-3",
                           "2024W053",
                           "2024-W05",
                           "2025-W01-1",
                           "2020-W53-7",
                           "2024-W05-3T12:30Z",
                           "2024-031",
                           "2024366",
                           "1969-365T23:59"}) {
    const auto instant = readInstant(text);
    ASSERT_TRUE(instant) << text;
    EXPECT_EQ(writeInstant(instant->at, instant->style), text);
  }
}

TEST(Calendar, ReadsPeriods) {
  EXPECT_EQ(readPeriod("P1Y"), (CalendarPeriod{12, 0}));
  EXPECT_EQ(readPeriod("P1Y6M"), (CalendarPeriod{18, 0}));
  EXPECT_EQ(readPeriod("P1M2DT3H4M5S"), (CalendarPeriod{1, ((2 * 24 + 3) * 60 + 4) * 60'000 + 5000}));
  EXPECT_EQ(readPeriod("P2W"), (CalendarPeriod{0, 14 * 86'400'000LL}));
  EXPECT_EQ(readPeriod("PT0.5S"), (CalendarPeriod{0, 500}));
  EXPECT_EQ(readPeriod("PT1,5H"), (CalendarPeriod{0, 5'400'000}));
  EXPECT_EQ(readPeriod("p6817d"), (CalendarPeriod{0, 6817 * 86'400'000LL}));
  for (const char* bad : {"PBAD", "P", "PT", "P1", "1D", "P1H", "PT1D", "P1.5M", "P-1D", "P1DT", "P99999999999D", ""}) {
    EXPECT_FALSE(readPeriod(bad)) << bad;
  }
}

TEST(TimeDimension, StepsThroughLists) {
  const TimeDimension list = dimension("2001-01-01, 2003-01-01,2002-01-01,\n2010-06-30");
  EXPECT_EQ(list.count(), 4U);
  EXPECT_EQ(textOf(list.first()), "2001-01-01");
  EXPECT_EQ(textOf(list.last()), "2010-06-30");
  EXPECT_FALSE(list.defaultValue());
  EXPECT_EQ(textOf(list.atOrBefore(at("2002-12-31T23:59:59"))), "2002-01-01");
  EXPECT_EQ(textOf(list.atOrBefore(at("2003-01-01"))), "2003-01-01");
  EXPECT_EQ(textOf(list.atOrBefore(at("2000-12-31"))), "nothing");
  EXPECT_EQ(textOf(list.nearest(at("2000-12-31"))), "2001-01-01");
  EXPECT_EQ(textOf(list.nearest(at("2002-11-01"))), "2003-01-01");
  EXPECT_EQ(textOf(list.nearest(at("2099-11-01"))), "2010-06-30");
  EXPECT_EQ(textOf(list.next(at("2001-01-01"))), "2002-01-01");
  EXPECT_EQ(textOf(list.previous(at("2001-01-01"))), "nothing");
  EXPECT_EQ(textOf(list.next(at("2010-06-30"))), "nothing");
}

TEST(TimeDimension, WhiteSpacePartsValuesAsWell) {
  for (const char* text : {"2000-01-01 2000-01-02 2000-01-03", "\n  2000-01-01\n  2000-01-02\n\t2000-01-03\n",
                           "2000-01-01,\n2000-01-02 , 2000-01-03", "2000-01-01\n2000-01-02/\n2000-01-03 / P1D\r\n"}) {
    EXPECT_EQ(dimension(text).count(), 3U) << text;
    EXPECT_EQ(textOf(dimension(text).next(at("2000-01-01"))), "2000-01-02") << text;
    EXPECT_TRUE(dimension(text).problems().empty()) << text;
  }
  // Of a value with a blank of its own.
  EXPECT_EQ(textOf(dimension("2000-01-01 12:00\n2000-01-02 12:00").last()), "2000-01-02 12:00");
  EXPECT_EQ(dimension("2000-01-01 12:00:00").count(), 1U);
  EXPECT_EQ(dimension("2000-01-01 00:00/2000-01-02 00:00/PT1H").count(), 25U);
  EXPECT_EQ(dimension("20000101 1200/20000102 1200/PT1H").count(), 25U);
  EXPECT_EQ(dimension("2000-01-01 12:00:00 UTC").count(), 0U);
}

TEST(TimeDimension, StepsThroughMonthsByTheCalendar) {
  const TimeDimension months = dimension("1948-01-01/1948-03-01/P1M,2015-01-31/2016-01-31/P1M");
  EXPECT_EQ(months.count(), 3U + 13U);
  EXPECT_EQ(textOf(months.atOrBefore(at("1948-02-15"))), "1948-02-01");
  EXPECT_EQ(textOf(months.atOrBefore(at("2000-02-15"))), "1948-03-01");
  EXPECT_EQ(textOf(months.next(at("1948-03-01"))), "2015-01-31");
  EXPECT_EQ(textOf(months.next(at("2015-01-31"))), "2015-02-28");  // and not further from there
  EXPECT_EQ(textOf(months.next(at("2015-02-28"))), "2015-03-31");
  EXPECT_EQ(textOf(months.last()), "2016-01-31");
  EXPECT_EQ(dimension("1990/2000/P1Y").count(), 11U);
  EXPECT_EQ(textOf(dimension("1990/2000/P1Y").next(at("1993-06-01"))), "1994");
}

TEST(TimeDimension, NeverExpandsIntervals) {
  // The oracle is std::chrono.
  using namespace std::chrono;
  const auto minutes = duration_cast<std::chrono::minutes>(sys_days(2013y / 12 / 31) - sys_days(1995y / 1 / 1)).count();
  const TimeDimension radar = dimension("1995-01-01/2013-12-31/PT5M", "2006-06-23T03:10:00Z");
  EXPECT_EQ(radar.count(), static_cast<std::uint64_t>(minutes / 5 + 1));
  EXPECT_EQ(textOf(radar.atOrBefore(at("2006-06-23T03:14:59"))), "2006-06-23T03:10:00");
  EXPECT_EQ(textOf(radar.next(at("2006-06-23T03:14:59"))), "2006-06-23T03:15:00");
  EXPECT_EQ(textOf(radar.defaultValue()), "2006-06-23T03:10:00Z");
  const TimeDimension milliseconds = dimension("0001-01-01/9999-12-31/PT0.001S");
  EXPECT_GT(milliseconds.count(), 300'000'000'000'000U);
  EXPECT_EQ(textOf(milliseconds.atOrBefore(at("2006-06-23T03:14:59.5"))), "2006-06-23T03:14:59.500");
}

TEST(TimeDimension, LeapSecondsDoNotShiftSteps) {
  const TimeDimension steps = dimension("2015-06-30T23:00:00Z/2015-07-01T01:00:00Z/PT15M");
  EXPECT_EQ(steps.count(), 9U);
  EXPECT_EQ(textOf(steps.atOrBefore(at("2015-06-30T23:59:60"))), "2015-06-30T23:45:00Z");
  EXPECT_EQ(textOf(steps.next(at("2015-06-30T23:45:00"))), "2015-07-01T00:00:00Z");
}

TEST(TimeDimension, ContinuousIntervalsAreTakenInWholeUnits) {
  for (const char* text :
       {"2000-01-01T00:00:00Z/2001-01-01T00:00:00Z", "2000-01-01T00:00:00Z/2001-01-01T00:00:00Z/0",
        "2000-01-01T00:00:00Z/2001-01-01T00:00:00Z/PT0S", "2000-01-01T00:00:00Z/2001-01-01T00:00:00Z/P"}) {
    const TimeDimension days = dimension(text);
    EXPECT_EQ(days.count(), 367U) << text;
    EXPECT_EQ(textOf(days.atOrBefore(at("2000-05-05T05:05:05"))), "2000-05-05T00:00:00Z");
    EXPECT_EQ(textOf(days.atOrBefore(at("2005-05-05"))), "2001-01-01T00:00:00Z");
    EXPECT_EQ(textOf(days.next(at("2000-05-05T05:05:05"))), "2000-05-06T00:00:00Z");
    EXPECT_EQ(textOf(days.previous(at("2000-05-05"))), "2000-05-04T00:00:00Z");
    EXPECT_EQ(textOf(days.previous(at("2000-01-01"))), "nothing");
    EXPECT_EQ(textOf(days.next(at("2001-01-01"))), "nothing");
  }
  EXPECT_EQ(textOf(dimension("2000/2001").next(at("2000-05-05T05:05:05"))), "2000-05-06");
  EXPECT_EQ(textOf(dimension("2000-01-01T01:00Z/2000-01-02T23:00Z").last()), "2000-01-02T23:00:00Z");
  EXPECT_EQ(dimension("2000-01-01T01:00Z/2000-01-02T23:00Z").count(), 47U);
  EXPECT_EQ(dimension("2000-01-01T01:00Z/2000-01-01T01:30Z").count(), 31U);
  EXPECT_EQ(dimension("2000-01-01T01:00:00Z/2000-01-01T01:00:30Z").count(), 31U);
  EXPECT_EQ(textOf(dimension("2026-11-01/present").last()), "2026-11-25");
}

TEST(TimeDimension, FractionsOfASecondAreWritten) {
  const TimeDimension halves = dimension("2000-01-01T00:00:00Z/2000-01-01T00:00:02Z/PT0.5S");
  EXPECT_EQ(halves.count(), 5U);
  EXPECT_EQ(textOf(halves.next(at("2000-01-01T00:00:00"))), "2000-01-01T00:00:00.5Z");
  EXPECT_EQ(textOf(dimension("2000-01-01T00:00:00.5Z/2000-01-01T00:00:02Z/PT0.125S").next(at("2000-01-01T00:00:00.5"))),
            "2000-01-01T00:00:00.625Z");
}

TEST(TimeDimension, ValuesAreAskedForAsTheyAreListed) {
  // Finer than a millisecond, in a zone: neither is written so here.
  const TimeDimension list = dimension("2000-01-01T00:00:00.123456Z,2000-01-02T00:00:00+02:00,2000-01-03T00:00:00Z");
  EXPECT_EQ(list.text(*list.first()), "2000-01-01T00:00:00.123456Z");
  EXPECT_EQ(list.text(*list.next(at("2000-01-01T12:00:00"))), "2000-01-02T00:00:00+02:00");
  EXPECT_EQ(list.text(*list.last()), "2000-01-03T00:00:00Z");
}

TEST(TimeDimension, StepsAreWrittenInTheFormOfTheirBeginning) {
  EXPECT_EQ(textOf(dimension("2024-W05/2024-W20/P1W").next(at("2024-01-29"))), "2024-W06");
  EXPECT_EQ(textOf(dimension("2024-W52/2025-W20/P2W").next(at("2024-12-23"))), "2025-W02");
  EXPECT_EQ(textOf(dimension("2024-W05/2024-W20/P1M").next(at("2024-01-29"))), "2024-W09-4");
  EXPECT_EQ(textOf(dimension("2024W053/2024W207/P1D").next(at("2024-01-31"))), "2024W054");
  EXPECT_EQ(textOf(dimension("2023-364/2024-020/P8D").next(at("2023-12-30"))), "2024-007");
  EXPECT_EQ(textOf(dimension("2024001/2024020/PT6H").next(at("2024-01-01"))), "2024001T060000");
}

TEST(TimeDimension, RepeatsAreTheBeginningsOfAll) {
  for (const char* text : {"R5/2024-01-01/P1D", "R5/2024-01-01/2024-01-02", "r5/2024-01-01/P1D", "R5/2024-001/P1D"}) {
    const TimeDimension five = dimension(text);
    EXPECT_EQ(five.count(), 5U) << text;
    EXPECT_TRUE(five.problems().empty()) << text;
    EXPECT_EQ(five.first()->at, at("2024-01-01")) << text;
    EXPECT_EQ(five.last()->at, at("2024-01-05")) << text;
  }
  EXPECT_EQ(textOf(dimension("R4/2024-01-31/P1M").last()), "2024-04-30");
  EXPECT_EQ(textOf(dimension("R36/2018-03-15T12:00:00Z/PT6H").last()), "2018-03-24T06:00:00Z");
  EXPECT_EQ(dimension("R1/2024-01-01/P1D").count(), 1U);
  EXPECT_EQ(dimension("R2/2024-01-01/P1D R3/2025-01-01/P1D").count(), 5U);
  EXPECT_EQ(dimension("R5/20240101 1200/P1D").count(), 5U);
  // Without a number there is no last one but the present's.
  EXPECT_EQ(textOf(dimension("R/2024-01-01/P1D").last()), "2026-11-25");
  EXPECT_EQ(textOf(dimension("R/2024-01-01T00:00:00Z/PT7H").last()), "2026-11-25T08:00:00Z");
}

TEST(TimeDimension, RepeatsWithoutMeaningAreTold) {
  for (const auto& [text, why] : std::initializer_list<std::pair<const char*, const char*>>{
           {"R0/2024-01-01/P1D", "does not begin or end with a time"},
           {"R-1/2024-01-01/P1D", "does not begin or end with a time"},
           {"R5/2024-01-01", "does not begin or end with a time"},
           {"R5/P1D/2024-01-01", "does not begin or end with a time"},
           {"Rx/2024-01-01/P1D", "does not begin or end with a time"},
           {"R5/2024-01-01/2024-02-01/P1D", "has not the form start/end/period"},
           {"R5/2024-01-01/PT0S", "has no period that can be read"},
           {"R5/2024-01-01/rubbish", "has no period that can be read"},
           {"R5/2024-01-02/2024-01-01", "has no period that can be read"},
           {"R/2030-01-01/P1D", "ends before it begins"},
           {"R9000/2024-01-01/P1Y", "lies beyond the years"},
           {"R999999999999999/2024-01-01/P16384Y", "lies beyond the years"},
           {"R5/19999-01-01/P16384Y", "lies beyond the years"}}) {
    const TimeDimension none = dimension(text);
    EXPECT_TRUE(none.isEmpty()) << text;
    ASSERT_EQ(none.problems().size(), 1U) << text;
    EXPECT_NE(none.problems()[0].find(why), std::string::npos) << none.problems()[0];
  }
}

TEST(TimeDimension, ThePresentIsWhatItIsTold) {
  const TimeDimension running = dimension("2026-11-20T00:00:00Z/PRESENT/PT6H", "current");
  EXPECT_EQ(textOf(running.last()), "2026-11-25T12:00:00Z");
  EXPECT_EQ(textOf(running.defaultValue()), "2026-11-25T12:00:00Z");
  EXPECT_EQ(textOf(dimension("2026-11-20/now/P1D").last()), "2026-11-25");
  EXPECT_EQ(textOf(dimension("2020-01-01/P1Y/P1M").last()), "2021-01-01");
}

TEST(TimeDimension, KeepsTheRestOfWhatIsMalformed) {
  const TimeDimension mixed = dimension(
      "2015-04-27T16:15:00/2015-04-27T18:45:00/PBAD,2015-05-01,rubbish,2016-01-01/2015-01-01/P1D,1/2/3/4,"
      "2017-01-01/2017-01-03/P1D",
      "never");
  EXPECT_EQ(mixed.count(), 4U);
  EXPECT_EQ(mixed.problems().size(), 5U);
  EXPECT_NE(mixed.problems()[0].find("PBAD"), std::string::npos);
  EXPECT_FALSE(mixed.defaultValue());
  EXPECT_TRUE(dimension("").isEmpty());
  EXPECT_TRUE(dimension(",,,").isEmpty());
  EXPECT_EQ(textOf(dimension("").nearest(at("2026-11-25"))), "nothing");
  EXPECT_FALSE(dimension("", "current").defaultValue());
}

TEST(TimeDimension, IntervalsBeyondTheCalendarAreRefused) {
  for (const char* values :
       {"19999-01-01/20000-01-01/P16384Y", "2000-01-01/P20000Y/P1Y", "-9999-01-01/2000-01-01/P1Y"}) {
    const TimeDimension beyond = dimension(values);
    EXPECT_TRUE(beyond.isEmpty()) << values;
    EXPECT_EQ(beyond.problems().size(), 1U) << values;
  }
  EXPECT_EQ(dimension("-4000-01-01/9999-12-31/P20000Y").count(), 1U);
}

TEST(TimeDimension, RealOnesAreUnderstood) {
  const std::string path = sharedData("time_dimensions.tsv");
  MERIDIAN_NEEDS(path);
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  int count = 0;
  while (std::getline(file, line)) {
    const std::size_t tab = line.find('\t');
    const std::string values = line.substr(0, tab);
    const TimeDimension real = dimension(values, line.substr(tab + 1, line.find('\t', tab + 1) - tab - 1));
    if (values.find("PBAD") != std::string::npos) {
      EXPECT_TRUE(real.isEmpty());
      continue;
    }
    ++count;
    EXPECT_TRUE(real.problems().empty()) << line << ": " << real.problems().front();
    ASSERT_FALSE(real.isEmpty()) << line;
    // From the last to the one before and back; at a value, the value; values lie where their texts say.
    const CalendarInstant last = *real.last();
    EXPECT_EQ(textOf(real.nearest(last.at)), textOf(last)) << line;
    EXPECT_EQ(textOf(real.atOrBefore(last.at)), textOf(last)) << line;
    EXPECT_EQ(textOf(real.atOrBefore(last.at + 1'000'000'000'000)), textOf(last)) << line;
    EXPECT_FALSE(real.next(last.at)) << line;
    EXPECT_EQ(readInstant(real.text(last))->at, last.at) << line;
    if (const auto before = real.previous(last.at)) {
      EXPECT_LT(before->at, last.at) << line;
      EXPECT_EQ(textOf(real.next(before->at)), textOf(last)) << line;
    }
    if (values.find('/') == std::string::npos) {
      EXPECT_EQ(real.count(), split(values, ",").size()) << line;
    }
  }
  EXPECT_GE(count, 330);
}

}  // namespace
}  // namespace meridian::globebrowsing
