#include "globebrowsing/providers/date_text.h"

#include <chrono>
#include <optional>
#include <string>

#include "globebrowsing/network/header_fields.h"
#include "globebrowsing/providers/time_file_name.h"
#include "globebrowsing/source/calendar.h"

namespace meridian::globebrowsing {

namespace {

using namespace std::chrono;

/// "2004", "2004-03".
std::optional<Time::UtcInstant> readMonth(std::string_view text) {
  const std::optional<CalendarInstant> read = readInstant(text);
  const bool isMonth = read && !read->style.isBasic && read->style.parts < 3;
  return isMonth ? std::optional(Time::UtcInstant(milliseconds(read->at))) : std::nullopt;
}

/// "2004-061", "2004-061T12:30".
std::optional<Time::UtcInstant> readDayOfYear(std::string_view text) {
  constexpr std::size_t length = 8;
  const std::string_view date = text.substr(0, text.find('T'));
  const auto day = date.size() == length ? TimeFileName::create("%Y-%j")->read(date) : std::nullopt;
  if (!day || date.size() == text.size()) {
    return day;
  }
  // The time of day is read by the one who knows all its forms.
  const Result<Time> timeOfDay = Time::fromUtc("2000-01-01" + std::string(text.substr(length)));
  return timeOfDay ? std::optional(*day + (timeOfDay->utcInstant() - sys_days(year(2000) / 1 / 1))) : std::nullopt;
}

}  // namespace

Result<Time::UtcInstant> readDate(std::string_view text) {
  const std::string_view date = trimmed(text);
  const Result<Time> time = Time::fromUtc(date);
  if (time) {
    return time->utcInstant();
  }
  for (const auto read : {readMonth, readDayOfYear}) {
    if (const std::optional<Time::UtcInstant> instant = read(date)) {
      return *instant;
    }
  }
  return tl::make_unexpected(time.error());
}

}  // namespace meridian::globebrowsing
