#pragma once

#include <chrono>
#include <compare>
#include <string>
#include <string_view>

#include "host/api/error.h"

namespace meridian {

/// An instant, as the host counts them: TDB seconds past J2000 (2000-01-01T12:00:00 TDB), like SPICE's ephemeris time.
/// Calendar text is UTC; the difference (leap seconds and TDB - TT) is ERFA's (eraDat, eraDtdb at the geocentre).
class Time {
 public:
  Time() = default;
  explicit constexpr Time(double tdbSecondsPastJ2000) : seconds_(tdbSecondsPastJ2000) {}

  /// Reads whole dates in any form of readCalendarText but the basic one: "2026-11-22", "2026-11-22T21:17:05",
  /// "2026-11-22 23:17:05.250+02:00", "2026 NOV 22 21:17:05". Without a zone it is UTC.
  /// Errors: anything else, an hour without minutes; a date that the calendar does not have; a year outside
  /// -4000..9999.
  [[nodiscard]] static Result<Time> fromUtc(std::string_view text);
  /// The machine's clock.
  [[nodiscard]] static Time now();

  /// UTC's calendar without its leap seconds, for arithmetic with days, months and years; to the nearest millisecond. A
  /// leap second is its minute's last millisecond. Outside the years -4000..9999 it is that range's end.
  using UtcInstant = std::chrono::sys_time<std::chrono::milliseconds>;
  [[nodiscard]] UtcInstant utcInstant() const;
  [[nodiscard]] static Time fromUtcInstant(UtcInstant instant);

  [[nodiscard]] constexpr double tdbSeconds() const { return seconds_; }
  /// "2026-11-22T21:17:05.250", rounded to the millisecond.
  [[nodiscard]] std::string utc() const;

  [[nodiscard]] constexpr Time operator+(double seconds) const { return Time(seconds_ + seconds); }
  [[nodiscard]] constexpr double operator-(const Time& other) const { return seconds_ - other.seconds_; }
  auto operator<=>(const Time&) const = default;

  /// A date in two parts whose sum is a Julian date, as ERFA takes them.
  struct JulianDate {
    double day;
    double fraction;
  };
  [[nodiscard]] JulianDate julianDateTdb() const;
  [[nodiscard]] JulianDate julianDateUtc() const;  ///< ERFA's quasi-JD of UTC

 private:
  double seconds_ = 0.0;
};

}  // namespace meridian
