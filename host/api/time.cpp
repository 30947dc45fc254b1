#include "host/api/time.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <string_view>

#include <erfa.h>
#include <fmt/format.h>

#include "host/api/calendar_text.h"

namespace meridian {

namespace {

constexpr double j2000 = 2451545.0;
constexpr double secondsPerDay = 86400.0;
constexpr Time::UtcInstant firstInstant = std::chrono::sys_days(std::chrono::year(-4000) / 1 / 1);
constexpr Time::UtcInstant lastInstant =
    std::chrono::sys_days(std::chrono::year(10000) / 1 / 1) - std::chrono::milliseconds(1);

/// TDB - TT in seconds at the geocentre; the argument may be TT or TDB, the difference does not matter.
double tdbMinusTt(const Time::JulianDate& date) {
  return eraDtdb(date.day, date.fraction, 0.0, 0.0, 0.0, 0.0);
}

Time::JulianDate utcFromTdb(const Time::JulianDate& tdb) {
  Time::JulianDate tt{};
  Time::JulianDate tai{};
  Time::JulianDate utc{};
  eraTdbtt(tdb.day, tdb.fraction, tdbMinusTt(tdb), &tt.day, &tt.fraction);
  eraTttai(tt.day, tt.fraction, &tai.day, &tai.fraction);
  // A "dubious year" warning means that leap seconds are unknown there; the latest known ones are then used.
  eraTaiutc(tai.day, tai.fraction, &utc.day, &utc.fraction);
  return utc;
}

Time timeFromUtc(const Time::JulianDate& utc) {
  Time::JulianDate tai{};
  Time::JulianDate tt{};
  eraUtctai(utc.day, utc.fraction, &tai.day, &tai.fraction);
  eraTaitt(tai.day, tai.fraction, &tt.day, &tt.fraction);
  return Time((tt.day - j2000) * secondsPerDay + tt.fraction * secondsPerDay + tdbMinusTt(tt));
}

/// By the calendar, not by seconds: a leap second is the last of a day of UTC, wherever that ends. What the calendar
/// does not have stays as it is.
void moveToUtc(CalendarText& calendar) {
  using namespace std::chrono;
  const year_month_day local = year(calendar.year) / calendar.month / calendar.day;
  if (!local.ok() || calendar.hour > 23 || calendar.minute > 59) {
    return;
  }
  const auto moved = sys_days(local) + hours(calendar.hour) + minutes(calendar.minute - calendar.zoneMinutes);
  const auto midnight = floor<days>(moved);
  const year_month_day date(midnight);
  const hh_mm_ss clock(moved - midnight);
  calendar.year = static_cast<int>(date.year());
  calendar.month = static_cast<int>(static_cast<unsigned>(date.month()));
  calendar.day = static_cast<int>(static_cast<unsigned>(date.day()));
  calendar.hour = static_cast<int>(clock.hours().count());
  calendar.minute = static_cast<int>(clock.minutes().count());
}

}  // namespace

Result<Time> Time::fromUtc(std::string_view text) {
  const auto bad = [&](std::string_view why) {
    return failure(fmt::format("\"{}\" is not a UTC time: {}", text.substr(0, 64), why), {},
                   "write it as 2026-11-22T21:17:05");
  };
  std::optional<CalendarText> calendar = readCalendarText(text);
  constexpr int hourAlone = 4;
  if (!calendar || calendar->style.isBasic || calendar->style.parts < 3 || calendar->style.parts == hourAlone ||
      (calendar->style.parts == 3 && calendar->zoneMinutes != 0)) {
    return bad("it is not of the form YYYY-MM-DDThh:mm:ss");
  }
  if (calendar->year < -4000 || calendar->year > 9999) {
    return bad("the year is outside -4000..9999");
  }
  if (calendar->zoneMinutes != 0) {
    moveToUtc(*calendar);
  }
  JulianDate utc{};
  const int status =
      eraDtf2d("UTC", calendar->year, calendar->month, calendar->day, calendar->hour, calendar->minute,
               calendar->second + 1e-9 * static_cast<double>(calendar->nanoseconds), &utc.day, &utc.fraction);
  if (status < 0 || status == 2 || status == 3) {
    return bad("the calendar has no such date or time of day");
  }
  return timeFromUtc(utc);
}

Time Time::now() {
  return fromUtcInstant(std::chrono::floor<std::chrono::milliseconds>(std::chrono::system_clock::now()));
}

Time Time::fromUtcInstant(UtcInstant instant) {
  using namespace std::chrono;
  instant = std::clamp(instant, firstInstant, lastInstant);
  const auto days = floor<std::chrono::days>(instant);
  const year_month_day date(days);
  const hh_mm_ss clock(instant - days);
  JulianDate utc{};
  eraDtf2d("UTC", static_cast<int>(date.year()), static_cast<int>(static_cast<unsigned>(date.month())),
           static_cast<int>(static_cast<unsigned>(date.day())), static_cast<int>(clock.hours().count()),
           static_cast<int>(clock.minutes().count()),
           static_cast<double>(clock.seconds().count()) + 1e-3 * static_cast<double>(clock.subseconds().count()),
           &utc.day, &utc.fraction);
  return timeFromUtc(utc);
}

Time::UtcInstant Time::utcInstant() const {
  using namespace std::chrono;
  constexpr double tenThousandYears = 3.2e11;
  if (!(std::abs(seconds_) < tenThousandYears)) {
    return seconds_ < 0.0 ? firstInstant : lastInstant;
  }
  const JulianDate date = julianDateUtc();
  int year = 0;
  int month = 0;
  int day = 0;
  std::array<int, 4> clock{};
  if (eraD2dtf("UTC", 3, date.day, date.fraction, &year, &month, &day, clock.data()) < 0) {
    return seconds_ < 0.0 ? firstInstant : lastInstant;
  }
  const auto midnight = sys_days(std::chrono::year(year) / month / day);
  const bool isLeapSecond = clock[2] == 60;
  return std::clamp<UtcInstant>(midnight + hours(clock[0]) + minutes(clock[1]) +
                                    (isLeapSecond ? milliseconds(59'999) : seconds(clock[2]) + milliseconds(clock[3])),
                                firstInstant, lastInstant);
}

Time::JulianDate Time::julianDateTdb() const {
  const double days = std::floor(seconds_ / secondsPerDay);
  return {j2000 + days, (seconds_ - days * secondsPerDay) / secondsPerDay};
}

Time::JulianDate Time::julianDateUtc() const {
  return utcFromTdb(julianDateTdb());
}

std::string Time::utc() const {
  const JulianDate date = julianDateUtc();
  int year = 0;
  int month = 0;
  int day = 0;
  std::array<int, 4> clock{};
  if (!std::isfinite(seconds_) || eraD2dtf("UTC", 3, date.day, date.fraction, &year, &month, &day, clock.data()) < 0) {
    return fmt::format("{} s TDB past J2000", seconds_);
  }
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}", year, month, day, clock[0], clock[1], clock[2],
                     clock[3]);
}

}  // namespace meridian
