#include "globebrowsing/providers/time_quantizer.h"

#include <charconv>

#include <fmt/format.h>

namespace meridian::globebrowsing {

namespace {

using namespace std::chrono;
using Unit = TimeResolution::Unit;

struct Rule {
  Unit unit;
  std::string_view counts;
  bool (*allows)(int count);
};

constexpr Rule rules[] = {
    {Unit::Years, "any number of years from 1", [](int count) { return count >= 1; }},
    {Unit::Months, "1 to 6 months", [](int count) { return count >= 1 && count <= 6; }},
    {Unit::Days, "1 to 28 days", [](int count) { return count >= 1 && count <= 28; }},
    {Unit::Hours, "1, 2, 3, 4, 6 or 12 hours",
     [](int count) { return count == 1 || count == 2 || count == 3 || count == 4 || count == 6 || count == 12; }},
    {Unit::Minutes, "15 or 30 minutes", [](int count) { return count == 15 || count == 30; }},
};

year_month_day dateOf(TimeQuantizer::Instant instant) {
  return floor<days>(instant);
}

bool isByCalendar(Unit unit) {
  return unit == Unit::Years || unit == Unit::Months;
}

int monthsOf(const TimeResolution& resolution) {
  return resolution.unit == Unit::Years ? 12 * resolution.count : resolution.count;
}

milliseconds lengthOf(const TimeResolution& resolution) {
  switch (resolution.unit) {
    case Unit::Days:
      return days(resolution.count);
    case Unit::Hours:
      return hours(resolution.count);
    default:
      return minutes(resolution.count);
  }
}

std::int64_t floorDivide(std::int64_t value, std::int64_t by) {
  return value / by - (value % by < 0 ? 1 : 0);
}

std::string text(TimeQuantizer::Instant instant) {
  return Time::fromUtcInstant(instant).utc();
}

}  // namespace

Result<TimeResolution> TimeResolution::read(std::string_view text) {
  TimeResolution resolution;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, resolution.count);
  constexpr int mostYears = 10000;
  for (const Rule& rule : rules) {
    if (error == std::errc() && rest + 1 == end && *rest == static_cast<char>(rule.unit)) {
      resolution.unit = rule.unit;
      if (rule.allows(resolution.count) && resolution.count <= mostYears) {
        return resolution;
      }
      return failure(fmt::format("\"{}\" is no resolution: there are {}", text, rule.counts), {},
                     "choose one of those");
    }
  }
  return failure(fmt::format("\"{}\" is no resolution", text.substr(0, 64)), {},
                 "write a number and a unit: y, M (months), d, h or m (minutes), as in 1d");
}

Result<TimeQuantizer> TimeQuantizer::create(Instant start, Instant end, const TimeResolution& resolution) {
  if (end < start) {
    return failure(fmt::format("the end {} is before the start {}", text(end), text(start)), {}, "exchange them");
  }
  if (start != floor<days>(start)) {
    return failure(fmt::format("the start {} is not at midnight", text(start)), {}, "begin at 00:00:00");
  }
  const year_month_day date = dateOf(start);
  // The series must not come to a 30th of February.
  const day last = resolution.unit == Unit::Months  ? day(28)
                   : resolution.unit == Unit::Years ? (year(2001) / date.month() / std::chrono::last).day()
                                                    : day(31);
  if (date.day() > last) {
    return failure(fmt::format("a series of {} cannot start on the {}.",
                               resolution.unit == Unit::Months ? "months" : "years", static_cast<unsigned>(date.day())),
                   {}, fmt::format("start on a day up to {}", static_cast<unsigned>(last)));
  }
  return TimeQuantizer(start, end, resolution);
}

TimeQuantizer::Instant TimeQuantizer::step(std::int64_t number) const {
  if (isByCalendar(resolution_.unit)) {
    return sys_days(dateOf(start_) + months(number * monthsOf(resolution_)));
  }
  return start_ + number * lengthOf(resolution_);
}

std::int64_t TimeQuantizer::numberAt(Instant instant) const {
  if (!isByCalendar(resolution_.unit)) {
    return floorDivide((instant - start_).count(), lengthOf(resolution_).count());
  }
  const year_month_day from = dateOf(start_);
  const year_month_day to = dateOf(instant);
  std::int64_t passed = (to.year() / to.month() - from.year() / from.month()).count();
  passed -= to.day() < from.day() ? 1 : 0;
  return floorDivide(passed, monthsOf(resolution_));
}

TimeQuantizer::Instant TimeQuantizer::quantize(Instant instant) const {
  if (instant < start_) {
    return start_;
  }
  return instant > end_ ? end_ : step(numberAt(instant));
}

std::optional<TimeQuantizer::Instant> TimeQuantizer::following(Instant quantized) const {
  if (quantized >= end_) {
    return std::nullopt;
  }
  const Instant next = step(numberAt(quantized) + 1);
  return next <= end_ ? next : end_ + milliseconds(1);
}

}  // namespace meridian::globebrowsing
