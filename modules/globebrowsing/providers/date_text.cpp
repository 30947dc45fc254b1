#include "globebrowsing/providers/date_text.h"

#include <chrono>
#include <optional>

#include "globebrowsing/network/header_fields.h"
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

}  // namespace

Result<Time::UtcInstant> readDate(std::string_view text) {
  const std::string_view date = trimmed(text);
  const Result<Time> time = Time::fromUtc(date);
  if (time) {
    return time->utcInstant();
  }
  if (const std::optional<Time::UtcInstant> instant = readMonth(date)) {
    return *instant;
  }
  return tl::make_unexpected(time.error());
}

}  // namespace meridian::globebrowsing
