#include "host/api/time.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>

#include <erfa.h>
#include <fmt/format.h>

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

struct CalendarTime {
  int year = 0;
  int month = 0;
  int day = 0;
  int hour = 0;
  int minute = 0;
  double second = 0.0;
};

/// Takes text from its front, piece by piece.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  bool take(char c) {
    const bool there = !rest_.empty() && rest_.front() == c;
    rest_.remove_prefix(there ? 1 : 0);
    return there;
  }
  /// A number of `least` to `most` digits, without sign.
  bool digits(std::size_t least, std::size_t most, int& number) {
    std::size_t count = 0;
    number = 0;
    while (count < most && count < rest_.size() && rest_[count] >= '0' && rest_[count] <= '9') {
      number = 10 * number + (rest_[count++] - '0');
    }
    rest_.remove_prefix(count);
    return count >= least;
  }
  /// The first letters of an English month, and the rest of the word.
  bool month(int& number) {
    static constexpr std::string_view months = "JANFEBMARAPRMAYJUNJULAUGSEPOCTNOVDEC";
    std::string word;
    while (word.size() < rest_.size() && std::isalpha(static_cast<unsigned char>(rest_[word.size()])) != 0) {
      word += static_cast<char>(std::toupper(static_cast<unsigned char>(rest_[word.size()])));
    }
    const std::size_t found = word.size() < 3 ? std::string_view::npos : months.find(word.substr(0, 3));
    if (found == std::string_view::npos || found % 3 != 0) {
      return false;
    }
    rest_.remove_prefix(word.size());
    number = static_cast<int>(found / 3) + 1;
    return true;
  }
  /// What follows a decimal point; 0 without one.
  double fraction() {
    double value = 0.0;
    if (take('.')) {
      for (double unit = 0.1; !rest_.empty() && rest_.front() >= '0' && rest_.front() <= '9'; unit /= 10.0) {
        value += unit * (rest_.front() - '0');
        rest_.remove_prefix(1);
      }
    }
    return value;
  }
  void blanks() {
    while (take(' ')) {
    }
  }
  [[nodiscard]] bool atEnd() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

bool readTimeOfDay(Reader& reader, CalendarTime& time) {
  if (!reader.digits(1, 2, time.hour) || !reader.take(':') || !reader.digits(1, 2, time.minute)) {
    return false;
  }
  int seconds = 0;
  if (reader.take(':')) {
    if (!reader.digits(1, 2, seconds)) {
      return false;
    }
    time.second = seconds + reader.fraction();
  }
  return true;
}

bool readSeparator(Reader& reader) {
  if (reader.take('-') || reader.take('/')) {
    return true;
  }
  const bool blank = reader.take(' ');
  reader.blanks();
  return blank;
}

/// "07-14" or "JUL 14".
bool readMonthAndDay(Reader& reader, CalendarTime& time) {
  return (reader.month(time.month) || reader.digits(1, 2, time.month)) && readSeparator(reader) &&
         reader.digits(1, 2, time.day);
}

std::optional<CalendarTime> readCalendar(std::string_view text) {
  Reader reader(text);
  CalendarTime time;
  reader.blanks();
  const bool negative = reader.take('-');
  if (!reader.digits(4, 5, time.year) || !readSeparator(reader) || !readMonthAndDay(reader, time)) {
    return std::nullopt;
  }
  time.year = negative ? -time.year : time.year;
  if (reader.take('T')) {
    if (!readTimeOfDay(reader, time)) {
      return std::nullopt;
    }
  } else {
    reader.blanks();
    if (!reader.atEnd() && !reader.take('Z') && !readTimeOfDay(reader, time)) {
      return std::nullopt;
    }
  }
  reader.blanks();
  reader.take('Z');
  reader.blanks();
  return reader.atEnd() ? std::optional(time) : std::nullopt;
}

}  // namespace

Result<Time> Time::fromUtc(std::string_view text) {
  const auto bad = [&](std::string_view why) {
    return failure(fmt::format("\"{}\" is not a UTC time: {}", text.substr(0, 64), why), {},
                   "write it as 2026-11-22T21:17:05");
  };
  const std::optional<CalendarTime> calendar = readCalendar(text);
  if (!calendar) {
    return bad("it is not of the form YYYY-MM-DDThh:mm:ss");
  }
  if (calendar->year < -4000 || calendar->year > 9999) {
    return bad("the year is outside -4000..9999");
  }
  JulianDate utc{};
  const int status = eraDtf2d("UTC", calendar->year, calendar->month, calendar->day, calendar->hour, calendar->minute,
                              calendar->second, &utc.day, &utc.fraction);
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
