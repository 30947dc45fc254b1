#include "globebrowsing/providers/date_text.h"

#include <array>
#include <chrono>
#include <optional>
#include <string>

#include "globebrowsing/providers/time_file_name.h"

namespace meridian::globebrowsing {

namespace {

using namespace std::chrono;

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  const std::size_t last = text.find_last_not_of(" \t\r\n");
  return first == std::string_view::npos ? std::string_view() : text.substr(first, last + 1 - first);
}

/// A form of a date, and how many characters it takes (0: any number): a time of day may follow.
struct Form {
  const char* format;
  std::size_t length;
};
constexpr std::array<Form, 4> forms{{{"%Y", 4}, {"%Y-%m", 7}, {"%Y-%j", 8}, {"%Y %b %d", 0}}};

/// Where the time of day begins, if there is one: after a T, or after the third word.
std::size_t clockOf(const Form& form, std::string_view text) {
  if (form.length != 0) {
    return text.find('T');
  }
  std::size_t blank = text.find(' ');
  for (int words = 1; words < 3 && blank != std::string_view::npos; ++words) {
    blank = text.find(' ', blank + 1);
  }
  return blank;
}

std::optional<Time::UtcInstant> readForm(const Form& form, std::string_view text) {
  const std::size_t clock = clockOf(form, text);
  const std::string_view date = text.substr(0, clock);
  if (form.length != 0 ? date.size() != form.length : date.empty() || date.back() < '0' || date.back() > '9') {
    return std::nullopt;
  }
  const std::optional<Time::UtcInstant> day = TimeFileName::create(form.format)->read(date);
  if (!day || clock == std::string_view::npos) {
    return day;
  }
  // The time of day is read by the one who knows all its forms.
  const Result<Time> timeOfDay = Time::fromUtc("2000-01-01T" + std::string(trimmed(text.substr(clock + 1))));
  return timeOfDay ? std::optional(*day + (timeOfDay->utcInstant() - sys_days(year(2000) / 1 / 1))) : std::nullopt;
}

}  // namespace

Result<Time::UtcInstant> readDate(std::string_view text) {
  const std::string_view date = trimmed(text);
  const Result<Time> time = Time::fromUtc(date);
  if (time) {
    return time->utcInstant();
  }
  for (const Form& form : forms) {
    if (const std::optional<Time::UtcInstant> read = readForm(form, date)) {
      return *read;
    }
  }
  return tl::make_unexpected(time.error());
}

}  // namespace meridian::globebrowsing
