#include "globebrowsing/source/time_dimension.h"

#include <algorithm>
#include <limits>

#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

constexpr std::size_t mostProblems = 20;

bool isNow(std::string_view text) {
  const std::string word = lowerCase(trimmed(text));
  return word == "present" || word == "current" || word == "now";
}

std::optional<CalendarInstant> readEnd(std::string_view text, CalendarMilliseconds now) {
  if (isNow(text)) {
    return CalendarInstant{now, {6, 3, false, true, 'T'}};
  }
  return readInstant(text);
}

/// Of milliseconds: the whole second not after them.
CalendarMilliseconds wholeSecond(CalendarMilliseconds at) {
  return (at >= 0 ? at / 1000 : -((999 - at) / 1000)) * 1000;
}

std::optional<TimeValue> toValue(const std::optional<CalendarInstant>& found) {
  if (!found) {
    return std::nullopt;
  }
  const Result<Time> time = timeOf(found->at);
  return time ? std::optional(TimeValue{*time, writeInstant(found->at, found->style)}) : std::nullopt;
}

}  // namespace

TimeDimension TimeDimension::parse(std::string_view values, std::string_view defaultValue, const Time& now) {
  TimeDimension result;
  const CalendarMilliseconds present = calendarOf(now);
  for (const std::string& part : split(values, ",")) {
    result.addPart(part, present);
  }
  std::stable_sort(result.instants_.begin(), result.instants_.end(),
                   [](const CalendarInstant& a, const CalendarInstant& b) { return a.at < b.at; });
  if (isNow(defaultValue)) {
    result.default_ = result.latest(present);
  } else if (!trimmed(defaultValue).empty()) {
    result.default_ = readInstant(defaultValue);
    if (!result.default_) {
      result.problems_.push_back("the default '" + std::string(trimmed(defaultValue).substr(0, 60)) + "' is no time");
    }
  }
  return result;
}

void TimeDimension::addPart(std::string_view part, CalendarMilliseconds now) {
  if (part.find('/') != std::string_view::npos) {
    addInterval(part, now);
    return;
  }
  const std::optional<CalendarInstant> instant = readEnd(part, now);
  if (instant && timeOf(instant->at)) {
    instants_.push_back(*instant);
  } else if (problems_.size() < mostProblems) {
    problems_.push_back("'" + std::string(part.substr(0, 60)) + "' is no time");
  }
}

void TimeDimension::addInterval(std::string_view part, CalendarMilliseconds now) {
  const auto refuse = [&](std::string_view why) {
    if (problems_.size() < mostProblems) {
      problems_.push_back("the interval '" + std::string(part.substr(0, 80)) + "' " + std::string(why));
    }
  };
  const std::vector<std::string> pieces = split(part, "/");
  if (pieces.size() < 2 || pieces.size() > 3) {
    return refuse("has not the form start/end/period");
  }
  const std::optional<CalendarInstant> start = readEnd(pieces[0], now);
  std::optional<CalendarInstant> end = readEnd(pieces[1], now);
  if (start && !end) {
    if (const std::optional<CalendarPeriod> length = readPeriod(pieces[1])) {  // ISO 8601 has start/length as well
      end = CalendarInstant{later(start->at, *length, 1), {6, 3, false, false, 'T'}};
    }
  }
  if (!start || !end) {
    return refuse("does not begin or end with a time");
  }
  CalendarPeriod period;
  if (pieces.size() == 3 && pieces[2] != "0") {
    const std::optional<CalendarPeriod> read = readPeriod(pieces[2]);
    if (!read) {
      return refuse("has no period that can be read");
    }
    period = *read;
  }
  if (start->at > end->at || !timeOf(start->at) || !timeOf(end->at)) {
    return refuse("ends before it begins, or lies beyond the calendar");
  }
  Interval interval{start->at, end->at, period, 1, start->style};
  if (!period.isZero()) {
    // A value is written with as many parts as its steps need: hours of "1990/2000/PT6H" are no years.
    const bool hasTime = period.milliseconds % 86'400'000 != 0;
    const int needed = hasTime ? 6 : period.milliseconds != 0 ? 3 : period.months % 12 != 0 ? 2 : 1;
    interval.style.parts = std::max(interval.style.parts, needed);
    const std::int64_t steps = periodsUntil(interval.start, period, interval.end);
    interval.end = later(interval.start, period, steps);
    interval.count = static_cast<std::uint64_t>(steps) + 1;
  }
  intervals_.push_back(interval);
}

TimeDimension::Found TimeDimension::latest(CalendarMilliseconds at) const {
  Found found;
  const auto offer = [&](const CalendarInstant& instant) {
    if (!found || instant.at > found->at) {
      found = instant;
    }
  };
  const auto after =
      std::upper_bound(instants_.begin(), instants_.end(), at,
                       [](CalendarMilliseconds value, const CalendarInstant& i) { return value < i.at; });
  if (after != instants_.begin()) {
    offer(*std::prev(after));
  }
  for (const Interval& interval : intervals_) {
    if (at < interval.start) {
      continue;
    }
    const CalendarMilliseconds within = std::min(at, interval.end);
    if (interval.period.isZero()) {
      CalendarStyle style = interval.style;
      style.parts = std::max(style.parts, within == interval.start || within == interval.end ? 1 : 6);
      offer({within, style});
    } else {
      const std::int64_t steps = periodsUntil(interval.start, interval.period, within);
      offer({later(interval.start, interval.period, steps), interval.style});
    }
  }
  return found;
}

TimeDimension::Found TimeDimension::earliest(CalendarMilliseconds at) const {
  Found found;
  const auto offer = [&](const CalendarInstant& instant) {
    if (!found || instant.at < found->at) {
      found = instant;
    }
  };
  const auto there =
      std::lower_bound(instants_.begin(), instants_.end(), at,
                       [](const CalendarInstant& i, CalendarMilliseconds value) { return i.at < value; });
  if (there != instants_.end()) {
    offer(*there);
  }
  for (const Interval& interval : intervals_) {
    if (at > interval.end) {
      continue;
    }
    const CalendarMilliseconds within = std::max(at, interval.start);
    if (interval.period.isZero()) {
      CalendarStyle style = interval.style;
      style.parts = std::max(style.parts, within == interval.start || within == interval.end ? 1 : 6);
      offer({within, style});
    } else {
      const std::int64_t steps = periodsUntil(interval.start, interval.period, within);
      const CalendarMilliseconds step = later(interval.start, interval.period, steps);
      offer({step == within ? step : later(interval.start, interval.period, steps + 1), interval.style});
    }
  }
  return found;
}

std::uint64_t TimeDimension::count() const {
  std::uint64_t sum = instants_.size();
  for (const Interval& interval : intervals_) {
    sum += interval.count;
  }
  return sum;
}

std::optional<TimeValue> TimeDimension::first() const {
  return toValue(earliest(std::numeric_limits<CalendarMilliseconds>::min()));
}

std::optional<TimeValue> TimeDimension::last() const {
  return toValue(latest(std::numeric_limits<CalendarMilliseconds>::max()));
}

std::optional<TimeValue> TimeDimension::defaultValue() const {
  return default_ ? toValue(default_) : last();
}

std::optional<TimeValue> TimeDimension::atOrBefore(const Time& time) const {
  return toValue(latest(calendarOf(time)));
}

std::optional<TimeValue> TimeDimension::nearest(const Time& time) const {
  const CalendarMilliseconds at = calendarOf(time);
  const Found before = latest(at);
  const Found after = earliest(at);
  if (before && after) {
    return toValue(at - before->at <= after->at - at ? before : after);
  }
  return toValue(before ? before : after);
}

std::optional<TimeValue> TimeDimension::next(const Time& time) const {
  const CalendarMilliseconds at = calendarOf(time);
  Found found = earliest(at + 1);
  if (found && found->at == at + 1) {  // continuous, or a step that the whole second finds again
    found = earliest(wholeSecond(at) + 1000);
    found = found ? found : latest(std::numeric_limits<CalendarMilliseconds>::max());
  }
  return found && found->at > at ? toValue(found) : std::nullopt;
}

std::optional<TimeValue> TimeDimension::previous(const Time& time) const {
  const CalendarMilliseconds at = calendarOf(time);
  Found found = latest(at - 1);
  if (found && found->at == at - 1) {
    found = latest(wholeSecond(at - 1));
    found = found ? found : earliest(std::numeric_limits<CalendarMilliseconds>::min());
  }
  return found && found->at < at ? toValue(found) : std::nullopt;
}

}  // namespace meridian::globebrowsing
