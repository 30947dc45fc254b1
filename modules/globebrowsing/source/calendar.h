#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host/api/calendar_text.h"
#include "host/api/time.h"

namespace meridian::globebrowsing {

/// A date and time of day in the proleptic Gregorian calendar, UTC, without leap seconds: milliseconds from
/// 1970-01-01T00:00:00, as services count theirs. Those of Time::UtcInstant; 23:59:60 in a text is the next midnight.
using CalendarMilliseconds = std::int64_t;

/// A period of ISO 8601: "P1Y2M3DT4H5M6.5S", "P2W". Years and months are the calendar's, all else has a length.
struct CalendarPeriod {
  std::int64_t months = 0;
  CalendarMilliseconds milliseconds = 0;

  [[nodiscard]] bool isZero() const { return months == 0 && milliseconds == 0; }
  bool operator==(const CalendarPeriod&) const = default;
};

struct CalendarInstant {
  CalendarMilliseconds at = 0;
  CalendarStyle style{};  ///< how a service writes its instants, so that we ask for them as it does
};

/// Reads ISO 8601 by readCalendarText; without a zone it is UTC. Nothing for anything else, and for dates that the
/// calendar does not have.
[[nodiscard]] std::optional<CalendarInstant> readInstant(std::string_view text);
[[nodiscard]] std::optional<CalendarPeriod> readPeriod(std::string_view text);
[[nodiscard]] std::string writeInstant(CalendarMilliseconds at, const CalendarStyle& style);

/// `count` periods later. Months are added first; the day is the last of the month where that is shorter.
[[nodiscard]] CalendarMilliseconds later(CalendarMilliseconds from, const CalendarPeriod& period, std::int64_t count);
/// The greatest count, 0 or more, with later(from, period, count) <= at; `at` is not before `from`, the period is
/// positive. Takes no longer for many periods than for few.
[[nodiscard]] std::int64_t periodsUntil(CalendarMilliseconds from, const CalendarPeriod& period,
                                        CalendarMilliseconds at);

[[nodiscard]] inline CalendarMilliseconds calendarOf(const Time& time) {
  return time.utcInstant().time_since_epoch().count();
}

}  // namespace meridian::globebrowsing
