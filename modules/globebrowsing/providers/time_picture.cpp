#include "globebrowsing/providers/time_picture.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace meridian::globebrowsing {

namespace {

using namespace std::chrono;

constexpr std::array<std::string_view, 12> monthNames{"January",   "February", "March",    "April",
                                                      "May",       "June",     "July",     "August",
                                                      "September", "October",  "November", "December"};
constexpr std::array<std::string_view, 7> dayNames{"Sunday",   "Monday", "Tuesday", "Wednesday",
                                                   "Thursday", "Friday", "Saturday"};

struct Fields {
  explicit Fields(Time::UtcInstant instant)
      : midnight(floor<days>(instant)),
        date(midnight),
        clock(instant - midnight),
        julian(2440587.5 + duration<double, days::period>(instant.time_since_epoch()).count()) {}

  [[nodiscard]] int year() const { return static_cast<int>(date.year()); }
  [[nodiscard]] unsigned month() const { return static_cast<unsigned>(date.month()); }
  [[nodiscard]] std::string_view monthName() const { return monthNames[month() - 1]; }
  [[nodiscard]] std::string_view dayName() const { return dayNames[weekday(midnight).c_encoding()]; }
  [[nodiscard]] auto dayOfYear() const { return (midnight - sys_days(date.year() / 1 / 1)).count() + 1; }

  sys_days midnight;
  year_month_day date;
  hh_mm_ss<milliseconds> clock;
  double julian;
};

/// The name in the case of its placeholder: MON, Mon, mon.
std::string inCaseOf(std::string_view placeholder, std::string_view name) {
  std::string text(name);
  const auto isLower = [](char c) { return std::islower(static_cast<unsigned char>(c)) != 0; };
  const auto change = [&](int (*to)(int)) {
    std::transform(text.begin(), text.end(), text.begin(), [to](unsigned char c) { return static_cast<char>(to(c)); });
  };
  if (isLower(placeholder[0])) {
    change(&std::tolower);
  } else if (!isLower(placeholder[1])) {
    change(&std::toupper);
  }
  return text;
}

using Write = std::string (*)(const Fields& fields, std::string_view placeholder);
struct Placeholder {
  std::string_view name;
  bool anyCase;  ///< a name, written in the placeholder's case
  Write write;
};

/// A placeholder that begins like another stands before it.
constexpr std::array<Placeholder, 15> placeholders{{
    {"YYYY", false, [](const Fields& f, std::string_view) { return fmt::format("{:04}", f.year()); }},
    {"YR", false, [](const Fields& f, std::string_view) { return fmt::format("{:02}", (f.year() % 100 + 100) % 100); }},
    {"MONTH", true, [](const Fields& f, std::string_view p) { return inCaseOf(p, f.monthName()); }},
    {"MON", true, [](const Fields& f, std::string_view p) { return inCaseOf(p, f.monthName().substr(0, 3)); }},
    {"MM", false, [](const Fields& f, std::string_view) { return fmt::format("{:02}", f.month()); }},
    {"MN", false, [](const Fields& f, std::string_view) { return fmt::format("{:02}", f.clock.minutes().count()); }},
    {"DOY", false, [](const Fields& f, std::string_view) { return fmt::format("{:03}", f.dayOfYear()); }},
    {"DD", false,
     [](const Fields& f, std::string_view) { return fmt::format("{:02}", static_cast<unsigned>(f.date.day())); }},
    {"HR", false, [](const Fields& f, std::string_view) { return fmt::format("{:02}", f.clock.hours().count()); }},
    {"SC", false, [](const Fields& f, std::string_view) { return fmt::format("{:02}", f.clock.seconds().count()); }},
    {"AMPM", true,
     [](const Fields& f, std::string_view p) { return inCaseOf(p, is_am(f.clock.hours()) ? "A.M." : "P.M."); }},
    {"AP", false,
     [](const Fields& f, std::string_view) { return fmt::format("{:02}", make12(f.clock.hours()).count()); }},
    {"JULIAND", false, [](const Fields& f, std::string_view) { return fmt::format("{:.0f}", std::floor(f.julian)); }},
    {"WEEKDAY", true, [](const Fields& f, std::string_view p) { return inCaseOf(p, f.dayName()); }},
    {"WKD", true, [](const Fields& f, std::string_view p) { return inCaseOf(p, f.dayName().substr(0, 3)); }},
}};

bool isPrefix(std::string_view text, const Placeholder& placeholder) {
  const std::string_view head = text.substr(0, placeholder.name.size());
  if (!placeholder.anyCase) {
    return head == placeholder.name;
  }
  return head.size() == placeholder.name.size() &&
         std::equal(head.begin(), head.end(), placeholder.name.begin(),
                    [](unsigned char a, unsigned char b) { return std::toupper(a) == b; });
}

/// ".###": as many digits as there are signs, of which the instant has three.
std::size_t writeFraction(std::string_view rest, const Fields& fields, std::string& text) {
  std::size_t signs = 0;
  while (signs + 1 < rest.size() && rest[signs + 1] == '#') {
    ++signs;
  }
  const std::string digits = fmt::format("{:03}", fields.clock.subseconds().count());
  text += '.';
  for (std::size_t i = 0; i < signs; ++i) {
    text += i < digits.size() ? digits[i] : '0';
  }
  return signs + 1;
}

}  // namespace

Result<std::string> writeTime(std::string_view picture, Time::UtcInstant instant) {
  const Fields fields(instant);
  std::string text;
  for (std::size_t at = 0; at < picture.size();) {
    const std::string_view rest = picture.substr(at);
    const auto found = std::find_if(placeholders.begin(), placeholders.end(),
                                    [rest](const Placeholder& one) { return isPrefix(rest, one); });
    if (found != placeholders.end()) {
      text += found->write(fields, rest.substr(0, found->name.size()));
      at += found->name.size();
    } else if (rest.substr(0, 2) == ".#") {
      at += writeFraction(rest, fields, text);
    } else if (rest.substr(0, 2) == "::") {
      constexpr std::array<std::string_view, 3> idle{"::UTC", "::TRNC", "::RND"};
      const auto modifier = std::find_if(idle.begin(), idle.end(),
                                         [rest](std::string_view one) { return rest.substr(0, one.size()) == one; });
      const std::size_t after = modifier == idle.end() ? 0 : modifier->size();
      if (after == 0 || (rest.size() > after && (rest[after] == '+' || rest[after] == '-'))) {
        return failure(fmt::format("the time format \"{}\" asks for another time scale or zone", picture), {},
                       "take the modifier that begins with :: away; times are UTC");
      }
      at += after;
    } else {
      text += picture[at++];
    }
  }
  return text;
}

}  // namespace meridian::globebrowsing
