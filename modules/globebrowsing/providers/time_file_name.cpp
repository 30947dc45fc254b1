#include "globebrowsing/providers/time_file_name.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include <fmt/format.h>

namespace meridian::globebrowsing {

namespace {

using namespace std::chrono;

/// What stands for several conversions.
constexpr std::array<std::pair<char, std::string_view>, 4> combinations{
    {{'F', "%Y-%m-%d"}, {'T', "%H:%M:%S"}, {'D', "%m/%d/%y"}, {'R', "%H:%M"}}};

std::string expanded(std::string_view format) {
  std::string text;
  for (std::size_t i = 0; i < format.size(); ++i) {
    const auto found = std::find_if(combinations.begin(), combinations.end(), [&](const auto& one) {
      return format[i] == '%' && i + 1 < format.size() && format[i + 1] == one.first;
    });
    if (found != combinations.end()) {
      text += found->second;
      ++i;
    } else if (format.substr(i, 2) == "%%") {
      text += "%%";
      ++i;
    } else {
      text += format[i];
    }
  }
  return text;
}

bool isSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

struct FieldRange {
  char conversion;
  std::size_t mostDigits;
  int least;
  int most;
};
constexpr std::array<FieldRange, 9> ranges{{{'Y', 4, 0, 9999},
                                            {'y', 2, 0, 99},
                                            {'m', 2, 1, 12},
                                            {'d', 2, 1, 31},
                                            {'H', 2, 0, 23},
                                            {'M', 2, 0, 59},
                                            {'S', 2, 0, 60},
                                            {'j', 3, 1, 366},
                                            {'U', 2, 0, 53}}};

/// What has been read; the defaults are the first of each kind.
struct Read {
  int year = 0;
  int month = 1;
  int day = 1;
  int hour = 0;
  int minute = 0;
  int second = 0;
  std::optional<int> dayOfYear;
  std::optional<int> week;

  void put(char conversion, int value);
  [[nodiscard]] std::optional<Time::UtcInstant> instant() const;
};

void Read::put(char conversion, int value) {
  switch (conversion) {
    case 'Y':
      year = value;
      break;
    case 'y':
      year = value < 69 ? 2000 + value : 1900 + value;
      break;
    case 'm':
      month = value;
      break;
    case 'd':
      day = value;
      break;
    case 'H':
      hour = value;
      break;
    case 'M':
      minute = value;
      break;
    case 'S':
      second = std::min(value, 59);  // a leap second
      break;
    case 'j':
      dayOfYear = value;
      break;
    default:
      week = value;
  }
}

std::optional<Time::UtcInstant> Read::instant() const {
  const std::chrono::year inYear(year);
  const sys_days newYear = inYear / 1 / 1;
  sys_days date;
  if (dayOfYear) {
    date = newYear + days(*dayOfYear - 1);
    if (*dayOfYear == 366 && !inYear.is_leap()) {
      return std::nullopt;
    }
  } else if (week) {
    // Week 1 begins on the first Sunday; the days before it are week 0.
    const sys_days firstSunday = newYear + (Sunday - weekday(newYear));
    date = *week == 0 ? newYear : firstSunday + weeks(*week - 1);
  } else {
    const year_month_day written = inYear / month / day;
    if (!written.ok()) {
      return std::nullopt;
    }
    date = written;
  }
  return date + hours(hour) + minutes(minute) + seconds(second);
}

/// Digits from the front of the name.
std::optional<int> takeNumber(std::string_view& name, const FieldRange& range) {
  std::size_t count = 0;
  int value = 0;
  while (count < range.mostDigits && count < name.size() && name[count] >= '0' && name[count] <= '9') {
    value = 10 * value + (name[count++] - '0');
  }
  if (count == 0 || value < range.least || value > range.most) {
    return std::nullopt;
  }
  name.remove_prefix(count);
  return value;
}

/// An English month, whole or its first three letters, in any case.
std::optional<int> takeMonth(std::string_view& name) {
  constexpr std::array<std::string_view, 12> months{"january",   "february", "march",    "april",
                                                    "may",       "june",     "july",     "august",
                                                    "september", "october",  "november", "december"};
  for (std::size_t i = 0; i < months.size(); ++i) {
    for (const std::string_view word : {months[i], months[i].substr(0, 3)}) {
      const bool fits =
          name.size() >= word.size() && std::equal(word.begin(), word.end(), name.begin(),
                                                   [](char a, unsigned char b) { return a == std::tolower(b); });
      if (fits) {
        name.remove_prefix(word.size());
        return static_cast<int>(i) + 1;
      }
    }
  }
  return std::nullopt;
}

}  // namespace

Result<TimeFileName> TimeFileName::create(std::string_view format) {
  const std::string text = expanded(format);
  std::vector<Part> parts;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      parts.push_back({false, isSpace(text[i]) ? '\0' : text[i]});
      continue;
    }
    const char letter = i + 1 < text.size() ? text[++i] : '\0';
    if (letter == '%' || letter == 'n' || letter == 't') {
      parts.push_back({false, letter == '%' ? '%' : '\0'});
    } else if (letter == 'e') {
      parts.push_back({false, '\0'});
      parts.push_back({true, 'd'});
    } else if (std::string_view("YymdHMSjUbBh").find(letter) != std::string_view::npos && letter != '\0') {
      parts.push_back({true, letter == 'B' || letter == 'h' ? 'b' : letter});
    } else {
      return failure(fmt::format("the format \"{}\" has an unknown conversion", format), {},
                     "use %Y %y %m %d %H %M %S %j %U %b, and %% for a percent sign");
    }
  }
  const auto has = [&](std::string_view letters) {
    return std::any_of(parts.begin(), parts.end(), [letters](const Part& part) {
      return part.isConversion && letters.find(part.text) != std::string_view::npos;
    });
  };
  if (!has("Yy")) {
    return failure(fmt::format("the format \"{}\" has no year", format), {}, "put %Y where the year stands");
  }
  if (has("M") && has("H") && !has("mdjUb")) {
    for (Part& part : parts) {
      if (part.isConversion && (part.text == 'M' || part.text == 'H')) {
        part.text = part.text == 'M' ? 'm' : 'd';
      }
    }
  }
  return TimeFileName(std::move(parts));
}

std::optional<Time::UtcInstant> TimeFileName::read(std::string_view name) const {
  Read found;
  for (const Part& part : parts_) {
    if (!part.isConversion && part.text == '\0') {
      while (!name.empty() && isSpace(name.front())) {
        name.remove_prefix(1);
      }
    } else if (!part.isConversion) {
      if (name.empty() || name.front() != part.text) {
        return std::nullopt;
      }
      name.remove_prefix(1);
    } else {
      const auto range = std::find_if(ranges.begin(), ranges.end(),
                                      [&](const FieldRange& one) { return one.conversion == part.text; });
      const std::optional<int> value = range == ranges.end() ? takeMonth(name) : takeNumber(name, *range);
      if (!value) {
        return std::nullopt;
      }
      found.put(part.text == 'b' ? 'm' : part.text, *value);
    }
  }
  return found.instant();
}

}  // namespace meridian::globebrowsing
