#include "host/api/calendar_text.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <string>

namespace meridian {

namespace {

/// Takes the text from its front, part by part; each step is false where that cannot be.
class CalendarReader {
 public:
  explicit CalendarReader(std::string_view text) {
    constexpr std::string_view white = " \t\r\n";
    const std::size_t first = std::min(text.find_first_not_of(white), text.size());
    rest_ = text.substr(first, text.find_last_not_of(white) + 1 - first);
  }

  std::optional<CalendarText> read() {
    return readDate() && readTimeOfDay() && readZone() && rest_.empty() ? std::optional(found_) : std::nullopt;
  }

 private:
  bool take(std::string_view any) {
    const bool isThere = !rest_.empty() && any.find(rest_.front()) != std::string_view::npos;
    rest_.remove_prefix(isThere ? 1 : 0);
    return isThere;
  }
  /// How many there were.
  std::size_t takeBlanks() {
    const std::size_t count = std::min(rest_.find_first_not_of(' '), rest_.size());
    rest_.remove_prefix(count);
    return count;
  }
  [[nodiscard]] std::size_t digitsAhead() const {
    return std::min(rest_.find_first_not_of("0123456789"), rest_.size());
  }
  bool readNumber(int& number, std::size_t mostDigits, std::size_t isoDigits = 2) {
    const std::size_t count = std::min(digitsAhead(), mostDigits);
    std::from_chars(rest_.data(), rest_.data() + count, number);
    rest_.remove_prefix(count);
    require(count >= isoDigits);
    return count > 0;
  }
  /// The next part of the instant.
  bool readPart(int& part, std::size_t mostDigits = 2) {
    ++found_.style.parts;
    return readNumber(part, mostDigits);
  }
  /// ISO 8601 has it so.
  void require(bool isIso) { found_.isIso = found_.isIso && isIso; }

  bool readDate() {
    const bool isNegative = take("-");
    const std::size_t ahead = digitsAhead();
    found_.style.parts = 0;
    found_.style.isBasic = ahead >= 6 && ahead <= 8;
    if (!found_.style.isBasic && ahead != 4 && ahead != 5) {
      return false;
    }
    readPart(found_.year, found_.style.isBasic ? 4 : ahead);
    found_.year *= isNegative ? -1 : 1;
    const bool isSeparated = takesDateSeparator();
    if (take("Ww")) {
      found_.style.isBasic = !isSeparated;
      return readWeek();
    }
    if (!isSeparated) {
      return true;
    }
    if (digitsAhead() == 3) {
      return readDayOfYear();
    }
    if (!readMonth() && !readPart(found_.month)) {
      return false;
    }
    return !takesDateSeparator() || readPart(found_.day);
  }

  /// What follows the W.
  bool readWeek() {
    found_.style.form = CalendarForm::WeekAndDay;
    int week = 0;
    int ofWeek = 1;
    if (!readPart(week)) {
      return false;
    }
    if (found_.style.isBasic ? digitsAhead() > 0 : take("-")) {
      ++found_.style.parts;
      if (!readNumber(ofWeek, 1, 1)) {
        return false;
      }
    }
    if (week < 1 || ofWeek < 1 || ofWeek > 7 || std::abs(found_.year) > furthestCalendarYear) {
      return false;
    }
    using namespace std::chrono;
    const sys_days monday = firstMonday(found_.year) + weeks(week - 1);
    const bool isOfYear = monday < firstMonday(found_.year + 1);
    setDate(monday + days(ofWeek - 1));
    return isOfYear;
  }

  bool readDayOfYear() {
    found_.style.form = CalendarForm::DayOfYear;
    found_.style.parts = 3;
    int ofYear = 0;
    if (!readNumber(ofYear, 3) || ofYear < 1 || std::abs(found_.year) > furthestCalendarYear) {
      return false;
    }
    const int year = found_.year;
    using namespace std::chrono;
    setDate(sys_days(std::chrono::year(year) / 1 / 1) + days(ofYear - 1));
    return found_.year == year;
  }

  void setDate(std::chrono::sys_days at) {
    const std::chrono::year_month_day date(at);
    found_.year = static_cast<int>(date.year());
    found_.month = static_cast<int>(static_cast<unsigned>(date.month()));
    found_.day = static_cast<int>(static_cast<unsigned>(date.day()));
  }

  /// Whether another part of the date follows.
  bool takesDateSeparator() {
    if (found_.style.isBasic) {
      return digitsAhead() >= 2;
    }
    if (take("-")) {
      return true;
    }
    const bool isThere = take("/") || takeBlanks() > 0;
    require(!isThere);
    return isThere;
  }

  /// The first letters of an English month, and the rest of the word.
  bool readMonth() {
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
    require(false);
    found_.month = static_cast<int>(found / 3) + 1;
    ++found_.style.parts;
    return true;
  }

  bool readTimeOfDay() {
    CalendarStyle& style = found_.style;
    if (style.parts < 3) {
      return true;
    }
    if (!take("Tt")) {
      const std::size_t blanks = takeBlanks();
      const bool isTime = blanks > 0 && digitsAhead() > 0;
      require(blanks == (isTime ? 1U : 0U));
      if (!isTime) {
        return true;
      }
      style.separator = ' ';
    }
    for (int* part : {&found_.hour, &found_.minute, &found_.second}) {
      if (part != &found_.hour && !(style.isBasic ? digitsAhead() >= 2 : take(":"))) {
        return true;
      }
      if (!readPart(*part)) {
        return false;
      }
    }
    return !take(".,") || readFraction();
  }

  bool readFraction() {
    const std::size_t count = digitsAhead();
    std::int64_t unit = 1'000'000'000;
    for (std::size_t i = 0; i < count; ++i) {
      unit /= 10;
      found_.nanoseconds += unit * (rest_[i] - '0');
    }
    rest_.remove_prefix(count);
    found_.style.parts = 7;
    found_.style.fractionDigits = static_cast<int>(std::min<std::size_t>(count, 3));
    return count > 0;
  }

  bool readZone() {
    require(takeBlanks() == 0);
    found_.style.hasZone = take("Zz");
    const bool isEast = !found_.style.hasZone && take("+");
    if (found_.style.hasZone || (!isEast && !take("-"))) {
      return true;
    }
    found_.style.hasZone = true;  // it is written back in UTC
    int hours = 0;
    int minutes = 0;
    if (!readNumber(hours, 2)) {
      return false;
    }
    take(":");
    if (!rest_.empty() && !readNumber(minutes, 2)) {
      return false;
    }
    if (hours > 23 || minutes > 59) {
      return false;
    }
    found_.zoneMinutes = (hours * 60 + minutes) * (isEast ? 1 : -1);
    return true;
  }

  std::string_view rest_;
  CalendarText found_;
};

}  // namespace

std::chrono::sys_days firstMonday(int year) {
  using namespace std::chrono;
  const sys_days fourth = std::chrono::year(year) / 1 / 4;
  return fourth - (weekday(fourth) - Monday);
}

std::optional<CalendarText> readCalendarText(std::string_view text) {
  return CalendarReader(text).read();
}

}  // namespace meridian
