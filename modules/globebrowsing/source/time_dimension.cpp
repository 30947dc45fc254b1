#include "globebrowsing/source/time_dimension.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

/// As for Time; with steps as long as periods may be, no year then leaves what std::chrono::year holds.
constexpr CalendarMilliseconds startOfYear(int year) {
  return std::chrono::milliseconds(std::chrono::sys_days(std::chrono::year(year) / 1 / 1).time_since_epoch()).count();
}
constexpr CalendarMilliseconds firstOfCalendar = startOfYear(-4000);
constexpr CalendarMilliseconds lastOfCalendar = startOfYear(10'000) - 1;

constexpr std::size_t mostProblems = 20;

// Why an interval is none.
constexpr std::string_view noTimes = "does not begin or end with a time";
constexpr std::string_view beyondCalendar = "lies beyond the years -4000 to 9999";
constexpr std::string_view noPeriod = "has no period that can be read";

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

constexpr std::int64_t endless = std::numeric_limits<std::int64_t>::max();

/// Of ISO 8601's repeated interval, "R5/start/period": how often it comes. "R" alone is endless.
std::optional<std::int64_t> readRepeats(std::string_view text) {
  if (text.empty() || (text.front() != 'R' && text.front() != 'r')) {
    return std::nullopt;
  }
  text.remove_prefix(1);
  if (text.empty()) {
    return endless;
  }
  const bool isCount = text.find_first_not_of("0123456789") == std::string_view::npos;
  const std::optional<long long> count = isCount ? integer(text) : std::nullopt;
  return count && *count > 0 ? std::optional<std::int64_t>(*count) : std::nullopt;
}

/// Of an interval that has every instant in it: the longest of these that its ends are whole ones of.
CalendarPeriod wholePeriod(CalendarMilliseconds start, CalendarMilliseconds end) {
  for (const CalendarMilliseconds unit : {86'400'000, 3'600'000, 60'000}) {
    if (start % unit == 0 && end % unit == 0) {
      return {0, unit};
    }
  }
  return {0, 1000};
}

/// As many parts as such steps need: hours of "1990/2000/PT6H" are no years.
CalendarStyle styleOfSteps(CalendarStyle style, const CalendarPeriod& period) {
  const CalendarMilliseconds fraction = period.milliseconds % 1000;
  int needed = fraction != 0                           ? 7
               : period.milliseconds % 86'400'000 != 0 ? 6
               : period.milliseconds != 0              ? 3
               : period.months % 12 != 0               ? 2
                                                       : 1;
  if (fraction != 0) {
    const int digits = fraction % 100 == 0 ? 1 : fraction % 10 == 0 ? 2 : 3;
    style.fractionDigits = style.parts < 7 ? digits : std::max(style.fractionDigits, digits);
  }
  if (style.form != CalendarForm::MonthAndDay) {  // where months and years begin amid a week
    const bool isWholeWeeks = period.months == 0 && period.milliseconds % (7 * 86'400'000LL) == 0;
    needed = isWholeWeeks ? 2 : std::max(needed, 3);
  }
  style.parts = std::max(style.parts, needed);
  return style;
}

}  // namespace

TimeDimension TimeDimension::parse(std::string_view values, std::string_view defaultValue, const Time& now) {
  TimeDimension result;
  const CalendarMilliseconds present = calendarOf(now) / 1000 * 1000;
  for (const std::string& part : split(values, ",")) {
    result.addPart(part, present);
  }
  std::stable_sort(result.instants_.begin(), result.instants_.end(),
                   [](const CalendarInstant& a, const CalendarInstant& b) { return a.at < b.at; });
  if (isNow(defaultValue)) {
    result.default_ = result.atOrBefore(present);
  } else if (!trimmed(defaultValue).empty()) {
    result.default_ = readInstant(defaultValue);
    if (!result.default_) {
      result.problems_.push_back("the default '" + std::string(trimmed(defaultValue).substr(0, 60)) + "' is no time");
    }
  }
  return result;
}

void TimeDimension::addPart(std::string_view part, CalendarMilliseconds now) {
  if (part.find_first_of(" \t\r\n") != std::string_view::npos && addApart(part, now)) {
    return;
  }
  if (part.find('/') != std::string_view::npos) {
    addInterval(part, now);
    return;
  }
  const std::optional<CalendarInstant> instant = readEnd(part, now);
  if (instant) {
    instants_.push_back(*instant);
    if (!isNow(part) && writeInstant(instant->at, instant->style) != part) {
      odd_.emplace(instant->at, part);
    }
  } else if (problems_.size() < mostProblems) {
    problems_.push_back("'" + std::string(part.substr(0, 60)) + "' is no time");
  }
}

bool TimeDimension::addApart(std::string_view part, CalendarMilliseconds now) {
  const std::vector<std::string> sides = split(part, "/");
  std::string tight;  // white space beside a slash parts nothing
  for (const std::string& side : sides) {
    tight += (tight.empty() ? "" : "/") + side;
  }
  std::vector<std::string> values = split(tight, "\r\n");
  if (values.size() < 2) {
    // A blank may stand between day and hour as well, so only where every piece is a value of its own.
    values = split(tight, " \t");
    const auto isBegin = [&](const std::string& side) { return readEnd(side, now) || readRepeats(side); };
    const auto isValue = [&](const std::string& value) { return isBegin(value.substr(0, value.find('/'))); };
    const auto isSide = [&](const std::string& side) { return isBegin(side) || readPeriod(side); };
    if (values.size() < 2 || !std::all_of(values.begin(), values.end(), isValue) ||
        std::all_of(sides.begin(), sides.end(), isSide)) {
      return false;
    }
  }
  for (const std::string& value : values) {
    addPart(value, now);
  }
  return true;
}

void TimeDimension::addInterval(std::string_view part, CalendarMilliseconds now) {
  const std::vector<std::string> pieces = split(part, "/");
  const bool isRepeat = pieces.size() == 3 && readRepeats(pieces[0]);
  const Understood interval = isRepeat ? repeatOf(pieces, now) : intervalOf(pieces, now);
  if (interval) {
    intervals_.push_back(*interval);
  } else if (problems_.size() < mostProblems) {
    problems_.push_back("the interval '" + std::string(part.substr(0, 80)) + "' " + std::string(interval.error()));
  }
}

TimeDimension::Understood TimeDimension::intervalOf(const std::vector<std::string>& pieces, CalendarMilliseconds now) {
  if (pieces.size() < 2 || pieces.size() > 3) {
    return tl::make_unexpected(std::string_view("has not the form start/end/period"));
  }
  const std::optional<CalendarInstant> start = readEnd(pieces[0], now);
  std::optional<CalendarInstant> end = readEnd(pieces[1], now);
  if (start && !end) {
    if (const std::optional<CalendarPeriod> length = readPeriod(pieces[1])) {  // ISO 8601 has start/length as well
      end = CalendarInstant{later(start->at, *length, 1), {6, 3, false, false, 'T'}};
    }
  }
  if (!start || !end) {
    return tl::make_unexpected(noTimes);
  }
  CalendarPeriod period;
  if (pieces.size() == 3 && pieces[2] != "0" && pieces[2] != "P" && pieces[2] != "PT") {
    const std::optional<CalendarPeriod> read = readPeriod(pieces[2]);
    if (!read) {
      return tl::make_unexpected(noPeriod);
    }
    period = *read;
  }
  if (period.isZero()) {
    period = wholePeriod(start->at, isNow(pieces[1]) ? start->at : end->at);
  }
  return stepsOf(*start, end->at, period);
}

TimeDimension::Understood TimeDimension::repeatOf(const std::vector<std::string>& pieces, CalendarMilliseconds now) {
  const std::optional<CalendarInstant> start = readEnd(pieces[1], now);
  const std::optional<CalendarInstant> second = readEnd(pieces[2], now);
  if (!start) {
    return tl::make_unexpected(noTimes);
  }
  const CalendarPeriod period =
      second ? CalendarPeriod{0, second->at - start->at} : readPeriod(pieces[2]).value_or(CalendarPeriod());
  if (period.isZero() || period.milliseconds < 0) {
    return tl::make_unexpected(noPeriod);
  }
  const std::int64_t times = *readRepeats(pieces[0]);
  Understood steps = stepsOf(*start, times == endless ? now : lastOfCalendar, period);
  if (!steps || times == endless) {
    return steps;
  }
  if (static_cast<std::uint64_t>(times) > steps->count) {
    return tl::make_unexpected(beyondCalendar);
  }
  steps->count = static_cast<std::uint64_t>(times);
  steps->end = later(start->at, period, times - 1);
  return steps;
}

TimeDimension::Understood TimeDimension::stepsOf(const CalendarInstant& start, CalendarMilliseconds end,
                                                 const CalendarPeriod& period) {
  if (start.at < firstOfCalendar || std::max(start.at, end) > lastOfCalendar) {
    return tl::make_unexpected(beyondCalendar);
  }
  if (start.at > end) {
    return tl::make_unexpected(std::string_view("ends before it begins"));
  }
  const std::int64_t steps = periodsUntil(start.at, period, end);
  return Interval{start.at, later(start.at, period, steps), period, static_cast<std::uint64_t>(steps) + 1,
                  styleOfSteps(start.style, period)};
}

TimeDimension::Found TimeDimension::atOrBefore(CalendarMilliseconds at) const {
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
    if (at >= interval.end) {
      offer({interval.end, interval.style});
    } else if (at >= interval.start) {
      const std::int64_t steps = periodsUntil(interval.start, interval.period, at);
      offer({later(interval.start, interval.period, steps), interval.style});
    }
  }
  return found;
}

TimeDimension::Found TimeDimension::atOrAfter(CalendarMilliseconds at) const {
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
    if (at <= interval.start) {
      offer({interval.start, interval.style});
    } else if (at <= interval.end) {
      const std::int64_t steps = periodsUntil(interval.start, interval.period, at);
      const CalendarMilliseconds step = later(interval.start, interval.period, steps);
      offer({step == at ? step : later(interval.start, interval.period, steps + 1), interval.style});
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

TimeDimension::Found TimeDimension::first() const {
  return atOrAfter(std::numeric_limits<CalendarMilliseconds>::min());
}

TimeDimension::Found TimeDimension::last() const {
  return atOrBefore(std::numeric_limits<CalendarMilliseconds>::max());
}

TimeDimension::Found TimeDimension::nearest(CalendarMilliseconds at) const {
  const Found before = atOrBefore(at);
  const Found after = atOrAfter(at);
  if (before && after) {
    return at - before->at <= after->at - at ? before : after;
  }
  return before ? before : after;
}

std::string TimeDimension::text(const CalendarInstant& value) const {
  const auto odd = odd_.find(value.at);
  return odd == odd_.end() ? writeInstant(value.at, value.style) : odd->second;
}

}  // namespace meridian::globebrowsing
