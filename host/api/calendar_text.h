#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>

namespace meridian {

/// Of dates in ISO 8601: 2024-01-31, 2024-W05-3 (the Wednesday of the fifth week), 2024-031 (the day of the year).
enum class CalendarForm : std::uint8_t { MonthAndDay, WeekAndDay, DayOfYear };

/// How an instant is written, so that others can be written as it is.
struct CalendarStyle {
  /// Parts that are written: 1 year, 2 month or week, 3 day, 4 hour, 5 minute, 6 second, 7 fraction of a second.
  int parts = 3;
  int fractionDigits = 3;  ///< 1 to 3; of more, the first three
  bool isBasic = false;    ///< 20110805T1200 rather than 2011-08-05T12:00
  bool hasZone = false;    ///< ends in Z
  char separator = 'T';
  CalendarForm form = CalendarForm::MonthAndDay;
};

/// Weeks, and days of the year, are counted up to there on either side of 0; std::chrono's years end at 32767.
constexpr int furthestCalendarYear = 20'000;

/// An instant as its numbers stand in a text, by month and day whatever its form; parts that are left out are the first
/// of their kind. But for weeks and days of the year only the form was looked at: whether the calendar has such an
/// instant, leap seconds among them, is for those to say who count it.
struct CalendarText {
  int year = 0;
  int month = 1;
  int day = 1;
  int hour = 0;
  int minute = 0;
  int second = 0;
  std::int64_t nanoseconds = 0;
  int zoneMinutes = 0;  ///< that its zone is east of UTC; 0 without a zone
  bool isIso = true;    ///< as ISO 8601 has it
  CalendarStyle style{};
};

/// Reads ISO 8601, extended and basic, cut short after any part, with a zone or without: "2011-08-05T12:00:15.5Z",
/// "20110805T1200+02", "2007-05", "2024-W05-3", "2024-031". Years may have five digits and a minus. And as people and
/// SPICE write dates, which isIso tells apart: numbers of one digit, blanks or slashes in the date, the month as an
/// English word or its first three letters, blanks before a Z: "2026 NOV 22 9:17 Z". Nothing for anything else; white
/// space around it is left out.
[[nodiscard]] std::optional<CalendarText> readCalendarText(std::string_view text);

/// Of the year's first week by ISO 8601, which is the one with January 4. Years that std::chrono has.
[[nodiscard]] std::chrono::sys_days firstMonday(int year);

}  // namespace meridian
