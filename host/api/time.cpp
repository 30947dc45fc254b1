#include "host/api/time.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <regex>

#include <erfa.h>
#include <fmt/format.h>

namespace meridian {

namespace {

constexpr double j2000 = 2451545.0;
constexpr double secondsPerDay = 86400.0;

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

}  // namespace

Result<Time> Time::fromUtc(std::string_view text) {
  static const std::regex pattern(
      R"(\s*(-?\d{4,5})-(\d{1,2})-(\d{1,2})(?:[T ](\d{1,2}):(\d{2})(?::(\d{2}(?:\.\d*)?))?)?\s*Z?\s*)");
  std::match_results<std::string_view::const_iterator> parts;
  const auto bad = [&](std::string_view why) {
    return failure(fmt::format("\"{}\" is not a UTC time: {}", text, why), {}, "write it as 2026-11-22T21:17:05");
  };
  if (text.size() > 64 || !std::regex_match(text.begin(), text.end(), parts, pattern)) {
    return bad("it is not of the form YYYY-MM-DDThh:mm:ss");
  }
  const auto number = [&](std::size_t i) { return parts[i].matched ? std::stod(parts[i].str()) : 0.0; };
  const int year = static_cast<int>(number(1));
  if (year < -4000 || year > 9999) {
    return bad("the year is outside -4000..9999");
  }
  JulianDate utc{};
  const int status =
      eraDtf2d("UTC", year, static_cast<int>(number(2)), static_cast<int>(number(3)), static_cast<int>(number(4)),
               static_cast<int>(number(5)), number(6), &utc.day, &utc.fraction);
  if (status < 0 || status == 2 || status == 3) {
    return bad("the calendar has no such date or time of day");
  }
  JulianDate tai{};
  JulianDate tt{};
  eraUtctai(utc.day, utc.fraction, &tai.day, &tai.fraction);
  eraTaitt(tai.day, tai.fraction, &tt.day, &tt.fraction);
  return Time((tt.day - j2000) * secondsPerDay + tt.fraction * secondsPerDay + tdbMinusTt(tt));
}

Time Time::now() {
  using namespace std::chrono;
  const auto instant = floor<milliseconds>(system_clock::now());
  const auto days = floor<std::chrono::days>(instant);
  const year_month_day date(days);
  const hh_mm_ss clock(instant - days);
  const std::string text =
      fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}", static_cast<int>(date.year()),
                  static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()), clock.hours().count(),
                  clock.minutes().count(), clock.seconds().count(), clock.subseconds().count());
  return fromUtc(text).value_or(Time());
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
