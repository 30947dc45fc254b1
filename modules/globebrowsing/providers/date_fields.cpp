#include "globebrowsing/providers/date_fields.h"

#include <algorithm>
#include <cassert>
#include <chrono>

namespace meridian::globebrowsing {

namespace {

using namespace std::chrono;

constexpr int defaultYear = 1900;

/// Two digits, as POSIX has them: 1969 to 2068.
int ofTwoDigits(int value) {
  return value < 69 ? 2000 + value : 1900 + value;
}

}  // namespace

void DateFields::put(char conversion, std::int64_t wide) {
  const int value = static_cast<int>(wide);
  switch (conversion) {
    case 'Y':
      year_ = value;
      yearOfCentury_.reset();
      break;
    case 'y':
      yearOfCentury_ = value;
      year_.reset();
      break;
    case 'C':
      century_ = value;
      break;
    case 'G':
    case 'g':
      isoYear_ = conversion == 'G' ? value : ofTwoDigits(value);
      break;
    case 'm':
      month_ = value;
      break;
    case 'd':
      day_ = value;
      break;
    case 'j':
      dayOfYear_ = value;
      break;
    case 'U':
    case 'W':
    case 'V':
      week_ = value;
      weekKind_ = conversion == 'U' ? WeekKind::FromSunday : conversion == 'W' ? WeekKind::FromMonday : WeekKind::Iso;
      break;
    case 'w':
    case 'u':
      weekday_ = value % 7;
      break;
    case 'H':
    case 'I':
      hour_ = value;
      isTwelveHours_ = conversion == 'I';
      break;
    case 'p':
      isAfternoon_ = value != 0;
      break;
    case 'M':
      minute_ = value;
      break;
    case 'S':
      second_ = std::min(value, 59);  // a leap second
      break;
    case 's':
      sinceEpoch_ = seconds(wide);
      break;
    default:
      assert(false && "no conversion with a value");
  }
}

int DateFields::wholeYear() const {
  if (year_) {
    return *year_;
  }
  if (yearOfCentury_) {
    return century_ ? 100 * *century_ + *yearOfCentury_ : ofTwoDigits(*yearOfCentury_);
  }
  return century_ ? 100 * *century_ : isoYear_.value_or(defaultYear);
}

sys_days DateFields::dateOfWeek() const {
  const bool isFromSunday = weekKind_ == WeekKind::FromSunday;
  const weekday firstOfWeek = isFromSunday ? Sunday : Monday;
  const int ofYear = weekKind_ == WeekKind::Iso ? isoYear_.value_or(wholeYear()) : wholeYear();
  const sys_days newYear = std::chrono::year(ofYear) / 1 / 1;
  // Week 1 begins on the year's first Sunday or Monday, that of ISO holds the fourth of January.
  const sys_days fourth = newYear + days(3);
  const sys_days firstWeek =
      weekKind_ == WeekKind::Iso ? fourth - (weekday(fourth) - Monday) : newYear + (firstOfWeek - weekday(newYear));
  const sys_days begin = firstWeek + weeks(*week_ - 1);
  if (weekday_) {
    return begin + (weekday(static_cast<unsigned>(*weekday_)) - firstOfWeek);
  }
  return weekKind_ == WeekKind::Iso ? begin : std::max(begin, newYear);
}

std::optional<sys_days> DateFields::date() const {
  const std::chrono::year inYear(wholeYear());
  const bool isWritten = month_ && day_;
  if (!isWritten && dayOfYear_) {
    return *dayOfYear_ == 366 && !inYear.is_leap() ? std::nullopt
                                                   : std::optional(sys_days(inYear / 1 / 1) + days(*dayOfYear_ - 1));
  }
  if (!isWritten && week_ && (weekday_ || (!month_ && !day_))) {
    return dateOfWeek();
  }
  const year_month_day written = inYear / month_.value_or(1) / day_.value_or(1);
  return written.ok() ? std::optional(sys_days(written)) : std::nullopt;
}

std::optional<Time::UtcInstant> DateFields::instant() const {
  if (sinceEpoch_) {
    return Time::UtcInstant(*sinceEpoch_);
  }
  const std::optional<sys_days> day = date();
  if (!day) {
    return std::nullopt;
  }
  const int hour = isTwelveHours_ ? hour_ % 12 + (isAfternoon_ ? 12 : 0) : hour_;
  return *day + hours(hour) + minutes(minute_) + seconds(second_);
}

}  // namespace meridian::globebrowsing
