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
constexpr CalendarMilliseconds longest = day * 366 * 20'000;

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

bool isOfCalendar(const CalendarText& parts) {
  const bool isMidnight = parts.hour == 24 && parts.minute == 0 && parts.second == 0;
  return std::abs(parts.year) <= furthestCalendarYear && parts.month >= 1 && parts.month <= 12 && parts.day >= 1 &&
         parts.day <= daysOfMonth(parts.year, parts.month) && (parts.hour <= 23 || isMidnight) && parts.minute <= 59 &&
         parts.second <= 60;
}

std::string writeYear(std::int64_t year) {
  return fmt::format("{}{:04}", year < 0 ? "-" : "", std::abs(year));
}

std::string writeWeek(CalendarMilliseconds midnight, const CalendarStyle& style, std::string_view dash) {
  std::int64_t year = dateOf(midnight).year + 1;  // the first and the last days of a year may be another's
  const auto monday = [&] { return firstMonday(static_cast<int>(year)).time_since_epoch().count() * day; };
  while (monday() > midnight) {
    --year;
  }
  const std::int64_t days = (midnight - monday()) / day;
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
  const std::optional<CalendarText> read = readCalendarText(text);
  if (!read || !read->isIso || !isOfCalendar(*read)) {
    return std::nullopt;
  }
  return CalendarInstant{fromDate(read->year, read->month, read->day) + read->hour * hour +
                             (read->minute - read->zoneMinutes) * minute + read->second * second +
                             read->nanoseconds / 1'000'000,
                         read->style};
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
