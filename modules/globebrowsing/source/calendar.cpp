#include "globebrowsing/source/calendar.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

#include <fmt/format.h>

#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

constexpr CalendarMilliseconds second = 1000;
constexpr CalendarMilliseconds minute = 60 * second;
constexpr CalendarMilliseconds hour = 60 * minute;
constexpr CalendarMilliseconds day = 24 * hour;
// Far beyond any service, and far from where sums overflow.
constexpr CalendarMilliseconds longest = 20'000 * 366 * day;

CalendarMilliseconds fromDate(std::int64_t year, std::int64_t month, std::int64_t dayOfMonth) {
  using namespace std::chrono;
  const sys_days days =
      std::chrono::year(static_cast<int>(year)) / static_cast<int>(month) / static_cast<int>(dayOfMonth);
  return days.time_since_epoch().count() * day;
}

struct Date {
  std::int64_t year = 1970;
  std::int64_t month = 1;
  std::int64_t day = 1;
};

Date dateOf(CalendarMilliseconds at) {
  using namespace std::chrono;
  const year_month_day date(floor<days>(sys_time<milliseconds>(milliseconds(at))));
  return {static_cast<int>(date.year()), static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day())};
}

std::int64_t daysOfMonth(std::int64_t year, std::int64_t month) {
  using namespace std::chrono;
  const year_month_day_last last =
      std::chrono::year(static_cast<int>(year)) / static_cast<int>(month) / std::chrono::last;
  return static_cast<unsigned>(last.day());
}

/// Takes text from its front.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  bool take(std::string_view any) {
    if (rest_.empty() || any.find(rest_.front()) == std::string_view::npos) {
      return false;
    }
    rest_.remove_prefix(1);
    return true;
  }
  std::optional<std::int64_t> digits(std::size_t count) {
    std::int64_t value = 0;
    if (rest_.size() < count) {
      return std::nullopt;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (rest_[i] < '0' || rest_[i] > '9') {
        return std::nullopt;
      }
      value = 10 * value + (rest_[i] - '0');
    }
    rest_.remove_prefix(count);
    return value;
  }
  [[nodiscard]] std::size_t digitsAhead() const {
    return std::min(rest_.find_first_not_of("0123456789"), rest_.size());
  }
  [[nodiscard]] bool atEnd() const { return rest_.empty(); }

 private:
  std::string_view rest_;
};

/// The parts of an instant as they stand in the text.
struct Parts {
  std::int64_t year = 0;
  std::int64_t month = 1;
  std::int64_t day = 1;
  std::int64_t hour = 0;
  std::int64_t minute = 0;
  std::int64_t second = 0;
  std::int64_t milliseconds = 0;
  std::int64_t zoneMinutes = 0;
};

constexpr std::int64_t furthestYear = 20'000;

/// The Monday of a year's first week, which is the one with January 4.
CalendarMilliseconds firstMonday(std::int64_t year) {
  using namespace std::chrono;
  const sys_days fourth = std::chrono::year(static_cast<int>(year)) / 1 / 4;
  return (fourth - (weekday(fourth) - Monday)).time_since_epoch().count() * day;
}

void setDate(Parts& parts, CalendarMilliseconds at) {
  const Date date = dateOf(at);
  parts.year = date.year;
  parts.month = date.month;
  parts.day = date.day;
}

/// What follows the W.
bool readWeek(Reader& reader, Parts& parts, CalendarStyle& style) {
  style.form = CalendarForm::WeekAndDay;
  style.parts = 2;
  const auto week = reader.digits(2);
  std::optional<std::int64_t> ofWeek = 1;
  if (style.isBasic ? reader.digitsAhead() > 0 : reader.take("-")) {
    ofWeek = reader.digits(1);
    style.parts = 3;
  }
  if (!week || *week < 1 || !ofWeek || *ofWeek < 1 || *ofWeek > 7 || std::abs(parts.year) > furthestYear) {
    return false;
  }
  const CalendarMilliseconds monday = firstMonday(parts.year) + (*week - 1) * 7 * day;
  const bool hasWeek = monday < firstMonday(parts.year + 1);
  setDate(parts, monday + (*ofWeek - 1) * day);
  return hasWeek;
}

bool readDayOfYear(Reader& reader, Parts& parts, CalendarStyle& style) {
  style.form = CalendarForm::DayOfYear;
  style.parts = 3;
  const std::int64_t year = parts.year;
  const auto ofYear = reader.digits(3);
  if (!ofYear || *ofYear < 1 || std::abs(year) > furthestYear) {
    return false;
  }
  setDate(parts, fromDate(year, 1, 1) + (*ofYear - 1) * day);
  return parts.year == year;
}

bool readDate(Reader& reader, Parts& parts, CalendarStyle& style) {
  const bool isNegative = reader.take("-");
  const std::size_t ahead = reader.digitsAhead();
  style.isBasic = (ahead >= 6 && ahead <= 8) || (ahead > 8 && !isNegative);
  const auto year = reader.digits(style.isBasic || ahead < 4 ? 4 : ahead);
  if (!year || (ahead != 4 && ahead != 5 && !style.isBasic)) {
    return false;
  }
  parts.year = isNegative ? -*year : *year;
  style.parts = 1;
  const bool hasDash = !style.isBasic && reader.take("-");
  if (!style.isBasic && reader.take("Ww")) {
    style.isBasic = !hasDash;
    return readWeek(reader, parts, style);
  }
  if ((style.isBasic || hasDash) && reader.digitsAhead() == 3) {
    return readDayOfYear(reader, parts, style);
  }
  for (std::int64_t* part : {&parts.month, &parts.day}) {
    const bool isFirst = part == &parts.month;
    if (style.isBasic ? reader.digitsAhead() < 2 : !(isFirst ? hasDash : reader.take("-"))) {
      return true;
    }
    const auto value = reader.digits(2);
    if (!value) {
      return false;
    }
    *part = *value;
    ++style.parts;
  }
  return true;
}

bool readFraction(Reader& reader, Parts& parts, CalendarStyle& style) {
  const std::size_t count = reader.digitsAhead();
  if (count == 0) {
    return false;
  }
  std::int64_t unit = second;
  for (std::size_t i = 0; i < count; ++i) {
    unit /= 10;
    parts.milliseconds += unit * *reader.digits(1);
  }
  style.parts = 7;
  style.fractionDigits = static_cast<int>(std::min<std::size_t>(count, 3));
  return true;
}

bool readTimeOfDay(Reader& reader, Parts& parts, CalendarStyle& style) {
  bool isFirst = true;
  for (std::int64_t* part : {&parts.hour, &parts.minute, &parts.second}) {
    if (!isFirst && (style.isBasic ? reader.digitsAhead() < 2 : !reader.take(":"))) {
      break;
    }
    const auto value = reader.digits(2);
    if (!value) {
      return false;
    }
    *part = *value;
    ++style.parts;
    isFirst = false;
  }
  return style.parts < 6 || !reader.take(".,") || readFraction(reader, parts, style);
}

bool readZone(Reader& reader, Parts& parts, CalendarStyle& style) {
  if (reader.take("Zz")) {
    style.hasZone = true;
    return true;
  }
  const bool isEast = reader.take("+");
  if (!isEast && !reader.take("-")) {
    return true;
  }
  const auto hours = reader.digits(2);
  reader.take(":");
  const auto minutes = reader.atEnd() ? std::optional<std::int64_t>(0) : reader.digits(2);
  if (!hours || !minutes) {
    return false;
  }
  parts.zoneMinutes = (*hours * 60 + *minutes) * (isEast ? 1 : -1);
  style.hasZone = true;  // it is written back in UTC
  return true;
}

bool isOfCalendar(const Parts& parts) {
  const bool isMidnight = parts.hour == 24 && parts.minute == 0 && parts.second == 0;
  return std::abs(parts.year) <= furthestYear && parts.month >= 1 && parts.month <= 12 && parts.day >= 1 &&
         parts.day <= daysOfMonth(parts.year, parts.month) && (parts.hour <= 23 || isMidnight) && parts.minute <= 59 &&
         parts.second <= 60;
}

std::string writeYear(std::int64_t year) {
  return fmt::format("{}{:04}", year < 0 ? "-" : "", std::abs(year));
}

std::string writeWeek(CalendarMilliseconds midnight, const CalendarStyle& style, std::string_view dash) {
  std::int64_t year = dateOf(midnight).year + 1;  // the first and the last days of a year may be another's
  while (firstMonday(year) > midnight) {
    --year;
  }
  const std::int64_t days = (midnight - firstMonday(year)) / day;
  std::string text = fmt::format("{}{}W{:02}", writeYear(year), dash, days / 7 + 1);
  return style.parts >= 3 ? text + fmt::format("{}{}", dash, days % 7 + 1) : text;
}

std::string writeDate(CalendarMilliseconds midnight, const CalendarStyle& style) {
  const Date date = dateOf(midnight);
  const std::string_view dash = style.isBasic ? "" : "-";
  if (style.form == CalendarForm::WeekAndDay) {
    return writeWeek(midnight, style, dash);
  }
  std::string text = writeYear(date.year);
  if (style.form == CalendarForm::DayOfYear) {
    return text + fmt::format("{}{:03}", dash, (midnight - fromDate(date.year, 1, 1)) / day + 1);
  }
  if (style.parts >= 2) {
    text += fmt::format("{}{:02}", dash, date.month);
  }
  if (style.parts >= 3) {
    text += fmt::format("{}{:02}", dash, date.day);
  }
  return text;
}

}  // namespace

std::optional<CalendarInstant> readInstant(std::string_view text) {
  text = trimmed(text);
  Reader reader(text);
  Parts parts;
  CalendarInstant instant;
  if (!readDate(reader, parts, instant.style)) {
    return std::nullopt;
  }
  if (!reader.atEnd() && instant.style.parts == 3) {
    const bool hasBlank = text.find(' ') != std::string_view::npos;
    if (reader.take("Tt ")) {
      instant.style.separator = hasBlank ? ' ' : 'T';
      if (!readTimeOfDay(reader, parts, instant.style)) {
        return std::nullopt;
      }
    }
  }
  if (!readZone(reader, parts, instant.style) || !reader.atEnd() || !isOfCalendar(parts)) {
    return std::nullopt;
  }
  instant.at = fromDate(parts.year, parts.month, parts.day) + parts.hour * hour +
               (parts.minute - parts.zoneMinutes) * minute + parts.second * second + parts.milliseconds;
  return instant;
}

std::optional<CalendarPeriod> readPeriod(std::string_view text) {
  text = trimmed(text);
  if (text.size() < 3 || (text.front() != 'P' && text.front() != 'p')) {
    return std::nullopt;
  }
  text.remove_prefix(1);
  CalendarPeriod period;
  bool isTime = false;
  bool hasAny = false;
  while (!text.empty()) {
    if (!isTime && (text.front() == 'T' || text.front() == 't')) {
      isTime = true;
      hasAny = false;
      text.remove_prefix(1);
      continue;
    }
    const std::size_t end = text.find_first_not_of("0123456789.,");
    if (end == 0 || end == std::string_view::npos) {
      return std::nullopt;
    }
    const std::optional<double> value = number(replaceAll(std::string(text.substr(0, end)), ",", "."));
    const char unit = lowerCase(text.substr(end, 1)).front();
    text.remove_prefix(end + 1);
    double length = 0.0;
    switch (unit) {
      case 'w':
        length = 7.0 * day;
        break;
      case 'd':
        length = day;
        break;
      case 'h':
        length = hour;
        break;
      case 's':
        length = second;
        break;
      case 'm':
        length = isTime ? minute : 0.0;
        break;
      case 'y':
        break;
      default:
        return std::nullopt;
    }
    const bool isMonths = (unit == 'y' || unit == 'm') && !isTime;
    const bool isTimeUnit = unit == 'h' || unit == 's' || (unit == 'm' && isTime);
    const double months = value.value_or(0.0) * (unit == 'y' ? 12.0 : 1.0);
    if (!value || isTimeUnit != isTime || *value * length > static_cast<double>(longest) ||
        (isMonths && (months != std::floor(months) || months > 240'000.0))) {
      return std::nullopt;
    }
    (isMonths ? period.months : period.milliseconds) += std::llround(isMonths ? months : *value * length);
    if (period.months > 240'000 || period.milliseconds > longest) {
      return std::nullopt;
    }
    hasAny = true;
  }
  return hasAny ? std::optional(period) : std::nullopt;
}

std::string writeInstant(CalendarMilliseconds at, const CalendarStyle& style) {
  const CalendarMilliseconds ofDay = (at % day + day) % day;
  const std::string_view colon = style.isBasic ? "" : ":";
  std::string text = writeDate(at - ofDay, style);
  if (style.parts >= 4) {
    text += fmt::format("{}{:02}", style.separator, ofDay / hour);
  }
  if (style.parts >= 5) {
    text += fmt::format("{}{:02}", colon, ofDay / minute % 60);
  }
  if (style.parts >= 6) {
    text += fmt::format("{}{:02}", colon, ofDay / second % 60);
  }
  if (style.parts >= 7) {
    text += "." + fmt::format("{:03}", ofDay % second).substr(0, static_cast<std::size_t>(style.fractionDigits));
  }
  return style.hasZone ? text + "Z" : text;
}

CalendarMilliseconds later(CalendarMilliseconds from, const CalendarPeriod& period, std::int64_t count) {
  CalendarMilliseconds result = from + count * period.milliseconds;
  if (period.months != 0) {
    const Date date = dateOf(from);
    const std::int64_t months = date.year * 12 + date.month - 1 + count * period.months;
    const std::int64_t year = months >= 0 ? months / 12 : -((11 - months) / 12);
    const std::int64_t month = months - year * 12 + 1;
    const std::int64_t dayOfMonth = std::min(date.day, daysOfMonth(year, month));
    result += fromDate(year, month, dayOfMonth) - fromDate(date.year, date.month, date.day);
  }
  return result;
}

std::int64_t periodsUntil(CalendarMilliseconds from, const CalendarPeriod& period, CalendarMilliseconds at) {
  // Months differ by less than a tenth from their mean; the guess is then walked to the answer.
  constexpr double meanMonth = 30.436875 * static_cast<double>(day);
  const double length = static_cast<double>(period.months) * meanMonth + static_cast<double>(period.milliseconds);
  std::int64_t count = std::max<std::int64_t>(0, static_cast<std::int64_t>(static_cast<double>(at - from) / length));
  while (count > 0 && later(from, period, count) > at) {
    --count;
  }
  while (later(from, period, count + 1) <= at) {
    ++count;
  }
  return count;
}

}  // namespace meridian::globebrowsing
