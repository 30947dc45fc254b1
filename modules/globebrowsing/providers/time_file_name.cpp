#include "globebrowsing/providers/time_file_name.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "globebrowsing/providers/date_fields.h"

namespace meridian::globebrowsing {

namespace {

/// What stands for several conversions, and other letters for one.
constexpr std::array<std::pair<char, std::string_view>, 14> combinations{{{'F', "%Y-%m-%d"},
                                                                          {'T', "%H:%M:%S"},
                                                                          {'X', "%H:%M:%S"},
                                                                          {'D', "%m/%d/%y"},
                                                                          {'x', "%m/%d/%y"},
                                                                          {'R', "%H:%M"},
                                                                          {'r', "%I:%M:%S %p"},
                                                                          {'c', "%a %b %d %H:%M:%S %Y"},
                                                                          {'B', "%b"},
                                                                          {'h', "%b"},
                                                                          {'A', "%a"},
                                                                          {'e', "%d"},
                                                                          {'P', "%p"},
                                                                          {'n', " "}}};

/// With E and O left out, which only locales tell apart.
std::string expanded(std::string_view format) {
  std::string text;
  for (std::size_t i = 0; i < format.size(); ++i) {
    if (format[i] != '%') {
      text += format[i];
      continue;
    }
    if (format.substr(i + 1, 1) == "E" || format.substr(i + 1, 1) == "O") {
      ++i;
    }
    const char letter = ++i < format.size() ? format[i] : '\0';
    const auto found =
        std::find_if(combinations.begin(), combinations.end(), [&](const auto& one) { return letter == one.first; });
    if (found != combinations.end()) {
      text += found->second;
    } else if (letter == 't') {
      text += ' ';
    } else {
      text += '%';
      text.append(letter == '\0' ? 0 : 1, letter);
    }
  }
  return text;
}

char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

bool isSpace(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

void dropSpace(std::string_view& name) {
  while (!name.empty() && isSpace(name.front())) {
    name.remove_prefix(1);
  }
}

struct Number {
  char conversion;
  std::size_t mostDigits;
  std::int64_t least;
  std::int64_t most;
  char field;
  bool maySpace = false;  ///< before it, instead of a digit
};
constexpr std::array<Number, 19> numbers{{{'Y', 4, 0, 9999, 'Y'},
                                          {'y', 2, 0, 99, 'y'},
                                          {'C', 2, 0, 99, 'C'},
                                          {'G', 4, 0, 9999, 'G'},
                                          {'g', 2, 0, 99, 'g'},
                                          {'m', 2, 1, 12, 'm'},
                                          {'d', 2, 1, 31, 'd', true},
                                          {'H', 2, 0, 23, 'H'},
                                          {'k', 2, 0, 23, 'H', true},
                                          {'I', 2, 1, 12, 'I'},
                                          {'l', 2, 1, 12, 'I', true},
                                          {'M', 2, 0, 59, 'M'},
                                          {'S', 2, 0, 60, 'S'},
                                          {'j', 3, 1, 366, 'j'},
                                          {'U', 2, 0, 53, 'U'},
                                          {'W', 2, 0, 53, 'W'},
                                          {'V', 2, 1, 53, 'V'},
                                          {'w', 1, 0, 6, 'w'},
                                          {'u', 1, 1, 7, 'u'}}};
/// To the end of the year 9999.
constexpr Number epochSeconds{'s', 12, 0, 253'402'300'799, 's'};

const Number* numberOf(char conversion) {
  const auto found =
      std::find_if(numbers.begin(), numbers.end(), [&](const Number& one) { return one.conversion == conversion; });
  return found != numbers.end() ? &*found : conversion == 's' ? &epochSeconds : nullptr;
}

/// Digits from the front of the name.
std::optional<std::int64_t> takeNumber(std::string_view& name, const Number& number) {
  if (number.maySpace && !name.empty() && isSpace(name.front())) {
    name.remove_prefix(1);
  }
  std::size_t count = 0;
  std::int64_t value = 0;
  while (count < number.mostDigits && count < name.size() && isDigit(name[count])) {
    value = 10 * value + (name[count++] - '0');
  }
  if (count == 0 || value < number.least || value > number.most) {
    return std::nullopt;
  }
  name.remove_prefix(count);
  return value;
}

constexpr std::array<std::string_view, 12> months{"january",   "february", "march",    "april",
                                                  "may",       "june",     "july",     "august",
                                                  "september", "october",  "november", "december"};
constexpr std::array<std::string_view, 7> weekdays{"sunday",   "monday", "tuesday", "wednesday",
                                                   "thursday", "friday", "saturday"};
constexpr std::array<std::string_view, 2> halves{"am", "pm"};

/// Which of the words the name begins with, whole or by its first three letters, in any case.
std::optional<std::int64_t> takeWord(std::string_view& name, std::span<const std::string_view> words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    for (const std::string_view word : {words[i], words[i].substr(0, 3)}) {
      const bool fits = name.size() >= word.size() && std::equal(word.begin(), word.end(), name.begin(),
                                                                 [](char a, char b) { return a == lower(b); });
      if (fits) {
        name.remove_prefix(word.size());
        return static_cast<std::int64_t>(i);
      }
    }
  }
  return std::nullopt;
}

/// A zone by its name, in capitals, or by its hours: "UTC", "Z", "+02", "-0330", "+05:45".
bool dropZone(std::string_view& name, bool isNamed) {
  if (!name.empty() && std::isupper(static_cast<unsigned char>(name.front())) != 0) {
    do {
      name.remove_prefix(1);
    } while (isNamed && !name.empty() && std::isupper(static_cast<unsigned char>(name.front())) != 0);
    return true;
  }
  const auto areDigits = [&](std::size_t at) {
    return name.size() >= at + 2 && isDigit(name[at]) && isDigit(name[at + 1]);
  };
  if (isNamed || name.empty() || (name.front() != '+' && name.front() != '-') || !areDigits(1)) {
    return false;
  }
  name.remove_prefix(3);
  const std::size_t colon = name.starts_with(':') ? 1 : 0;
  name.remove_prefix(areDigits(colon) ? colon + 2 : 0);
  return true;
}

/// Whether the name begins with what that conversion reads, which is then taken off.
bool take(std::string_view& name, char conversion, DateFields& fields) {
  if (conversion == 'z' || conversion == 'Z') {
    return dropZone(name, conversion == 'Z');
  }
  if (const Number* number = numberOf(conversion)) {
    const std::optional<std::int64_t> value = takeNumber(name, *number);
    if (value) {
      fields.put(number->field, *value);
    }
    return value.has_value();
  }
  const bool isMonth = conversion == 'b';
  const std::optional<std::int64_t> index = isMonth             ? takeWord(name, months)
                                            : conversion == 'a' ? takeWord(name, weekdays)
                                                                : takeWord(name, halves);
  if (index) {
    fields.put(isMonth ? 'm' : conversion == 'a' ? 'w' : 'p', *index + (isMonth ? 1 : 0));
  }
  return index.has_value();
}

bool isConversion(char letter) {
  return numberOf(letter) != nullptr ||
         (letter != '\0' && std::string_view("bapzZ").find(letter) != std::string_view::npos);
}

}  // namespace

Result<TimeFileName> TimeFileName::create(std::string_view format) {
  constexpr const char* remedy =
      "use %Y %y %m %b %d %j %U %W %H %I %p %M %S as std::get_time has them, and %% for a percent sign";
  if (format.empty()) {
    return failure("the format is empty", {}, remedy);
  }
  const std::string text = expanded(format);
  std::vector<Part> parts;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      parts.push_back({false, isSpace(text[i]) ? '\0' : text[i]});
      continue;
    }
    const char letter = i + 1 < text.size() ? text[++i] : '\0';
    if (letter == '\0') {
      return failure(fmt::format("the format \"{}\" ends within a conversion", format), {}, remedy);
    }
    if (letter != '%' && !isConversion(letter)) {
      return failure(fmt::format("the format \"{}\" has an unknown conversion %{}", format, letter), {}, remedy);
    }
    parts.push_back({letter != '%', letter});
  }
  const auto has = [&](std::string_view letters) {
    return std::any_of(parts.begin(), parts.end(), [letters](const Part& part) {
      return part.isConversion && letters.find(part.text) != std::string_view::npos;
    });
  };
  if (has("Yy") && has("M") && has("H") && !has("mdjUWVbs")) {
    for (Part& part : parts) {
      if (part.isConversion && (part.text == 'M' || part.text == 'H')) {
        part.text = part.text == 'M' ? 'm' : 'd';
      }
    }
  }
  return TimeFileName(std::move(parts));
}

std::optional<Time::UtcInstant> TimeFileName::read(std::string_view name) const {
  DateFields fields;
  dropSpace(name);
  for (const Part& part : parts_) {
    if (part.isConversion) {
      if (!take(name, part.text, fields)) {
        return std::nullopt;
      }
    } else if (part.text == '\0') {
      dropSpace(name);
    } else if (!name.empty() && lower(name.front()) == lower(part.text)) {
      name.remove_prefix(1);
    } else {
      return std::nullopt;
    }
  }
  return fields.instant();
}

}  // namespace meridian::globebrowsing
