#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "host/api/time.h"

namespace meridian::globebrowsing {

/// The parts of a date and a time as they are read one after the other, by the letters of strptime's conversions:
/// Y y C G g (years), m d j, U W V (weeks from Sunday, from Monday, ISO's), w u (days of the week, Sunday being 0 and
/// Monday 1 and 7 respectively), H I M S, p (1: afternoon), s (seconds since 1970).
///
/// Whatever is put twice counts as put last. What nothing is put for is 1900, January, the first, and midnight, as
/// std::get_time leaves it.
class DateFields {
 public:
  /// `value` is within that conversion's range.
  void put(char conversion, std::int64_t value);

  /// The day by the first of these that are there: month and day; the day of the year; week and day of the week; month
  /// or day; the first day of the week. Nothing if the calendar has no such day.
  [[nodiscard]] std::optional<Time::UtcInstant> instant() const;

 private:
  enum class WeekKind { FromSunday, FromMonday, Iso };

  [[nodiscard]] int wholeYear() const;
  [[nodiscard]] std::optional<std::chrono::sys_days> date() const;
  [[nodiscard]] std::chrono::sys_days dateOfWeek() const;

  std::optional<int> year_;
  std::optional<int> yearOfCentury_;
  std::optional<int> century_;
  std::optional<int> isoYear_;
  std::optional<int> month_;
  std::optional<int> day_;
  std::optional<int> dayOfYear_;
  std::optional<int> week_;
  WeekKind weekKind_ = WeekKind::FromSunday;
  std::optional<int> weekday_;  ///< Sunday is 0
  int hour_ = 0;
  bool isTwelveHours_ = false;
  bool isAfternoon_ = false;
  int minute_ = 0;
  int second_ = 0;
  std::optional<std::chrono::seconds> sinceEpoch_;
};

}  // namespace meridian::globebrowsing
