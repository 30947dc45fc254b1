#include "host/api/calendar_text.h"

#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace meridian {
namespace {

/// Everything that was read: numbers, zone in minutes, parts, and what of the style is not the default.
std::string readOf(std::string_view text) {
  const auto read = readCalendarText(text);
  if (!read) {
    return "nothing";
  }
  std::string all = fmt::format("{}/{}/{} {}:{}:{}.{:09} {:+} {}", read->year, read->month, read->day, read->hour,
                                read->minute, read->second, read->nanoseconds, read->zoneMinutes, read->style.parts);
  for (const auto& [is, word] : {std::pair(read->style.isBasic, " basic"), std::pair(read->style.hasZone, " zone"),
                                 std::pair(read->style.separator == ' ', " blank"), std::pair(!read->isIso, " free")}) {
    all += is ? word : "";
  }
  return all;
}

TEST(CalendarText, TellsFormsApart) {
  for (const auto& [text, read] :
       {std::pair("1990", "1990/1/1 0:0:0.000000000 +0 1"),
        std::pair("-0044-03", "-44/3/1 0:0:0.000000000 +0 2"),
        std::pair("12345-03-15", "12345/3/15 0:0:0.000000000 +0 3"),
        std::pair("200705", "2007/5/1 0:0:0.000000000 +0 2 basic"),
        std::pair("20110805T1230Z", "2011/8/5 12:30:0.000000000 +0 5 basic zone"),
        std::pair("2011-08-05t12", "2011/8/5 12:0:0.000000000 +0 4"),
        std::pair("2011-08-05 12:30:60,25-0330", "2011/8/5 12:30:60.250000000 -210 7 zone blank"),
        std::pair("2011-08-05T12:30:15.1234567891+02", "2011/8/5 12:30:15.123456789 +120 7 zone"),
        std::pair("2011-99-99T99:99:99", "2011/99/99 99:99:99.000000000 +0 6"),
        std::pair("\t2011-08-05\r\n", "2011/8/5 0:0:0.000000000 +0 3"),
        std::pair("2011217", "2011/8/5 0:0:0.000000000 +0 3 basic"),
        std::pair("2011-217T12:30Z", "2011/8/5 12:30:0.000000000 +0 5 zone"),
        std::pair("2012-366", "2012/12/31 0:0:0.000000000 +0 3"),
        std::pair("2011-W31-5", "2011/8/5 0:0:0.000000000 +0 3"),
        std::pair("2011W315T12", "2011/8/5 12:0:0.000000000 +0 4 basic"),
        std::pair("2020-W53-7", "2021/1/3 0:0:0.000000000 +0 3"),
        std::pair("2011-8-05", "2011/8/5 0:0:0.000000000 +0 3 free"),
        std::pair("2011-08-05T9:30", "2011/8/5 9:30:0.000000000 +0 5 free"),
        std::pair("2011/08/05", "2011/8/5 0:0:0.000000000 +0 3 free"),
        std::pair("2011  august 5   9:07", "2011/8/5 9:7:0.000000000 +0 5 blank free"),
        std::pair("2011-08-05 Z", "2011/8/5 0:0:0.000000000 +0 3 zone free"),
        std::pair("2011-08-05T12:30 +01:00", "2011/8/5 12:30:0.000000000 +60 5 zone free"),
        std::pair("2011 AUG", "2011/8/1 0:0:0.000000000 +0 2 free")}) {
    EXPECT_EQ(readOf(text), read) << text;
  }
}

TEST(CalendarText, RefusesWhatHasNoFormOfADate) {
  for (const char* text : {"",
                           " ",
                           "-",
                           "+2011",
                           "today",
                           "11",
                           "201",
                           "2011-366",
                           "2011-000",
                           "2011W",
                           "2011-W00-1",
                           "2011-W53-1",
                           "2011-W05-8",
                           "99999-W05-1",
                           "2011080512",
                           "1234567890123456789012345",
                           "2011-",
                           "2011-x",
                           "2011-AUX-01",
                           "2011AUG05",
                           "2011-08-05T",
                           "2011-08-05T12:",
                           "2011-08-05T12:30:",
                           "2011-08-05T12:30:1.",
                           "2011-08-05T1230",
                           "20110805T12:30",
                           "2011-08-0512:30",
                           "2011-08T12:30",
                           "2011-08-05x",
                           "2011-08-05Z Z",
                           "2011-08-05T12:30+",
                           "2011-08-05T12:30+x",
                           "2011-08-05T12:30+01:00:00",
                           "2011-08-05T12:30+24:00",
                           "2011-08-05T12:30-01:60",
                           "2011-08-05T12:30:15:20"}) {
    EXPECT_EQ(readOf(text), "nothing") << text;
  }
}

}  // namespace
}  // namespace meridian
