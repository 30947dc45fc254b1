#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "globebrowsing/source/calendar.h"
#include "host/api/error.h"
#include "host/api/time.h"

namespace meridian::globebrowsing {

/// The instants that a service has: WMS 1.1.1 and 1.3.0, annex C and D, WMTS 1.0.0 section 7.1.1. A list of values and
/// of intervals "start/end/period". An interval without period (or with an empty or zero one) has every instant in it;
/// of those, whole days are taken, or hours, minutes or seconds where its ends are no whole days.
/// ISO 8601's repeated intervals "R5/start/period" and "R5/start/end" are the beginnings of the five; without a number
/// they go on until now, since no service has maps of all times to come.
/// An end cut short means its beginning ("2013-12-31" is that midnight): what lies after it might be refused.
/// Intervals are never expanded: a century of five-minute steps costs what one step costs.
///
/// Steps are UTC's calendar: months and years as the calendar has them, and no leap seconds, as no service counts them.
/// Immutable; safe from any thread. Nothing but parse() and text() allocates.
class TimeDimension {
 public:
  using Found = std::optional<CalendarInstant>;

  TimeDimension() = default;
  /// `values` is the text of a Dimension or Extent element, or the values of a WMTS dimension joined by commas;
  /// `defaultValue` may be empty, "current" or a value. `now` is what "present", "now" and "current" mean. Parts that
  /// are not understood are left out and told in problems().
  [[nodiscard]] static TimeDimension parse(std::string_view values, std::string_view defaultValue, const Time& now);

  [[nodiscard]] bool isEmpty() const { return instants_.empty() && intervals_.empty(); }
  [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }
  /// Values in all; values that two parts share count twice.
  [[nodiscard]] std::uint64_t count() const;

  [[nodiscard]] Found first() const;
  [[nodiscard]] Found last() const;
  /// The service's own, which need not be one of its values; nothing where it names none.
  [[nodiscard]] Found defaultValue() const { return default_; }
  /// The latest value not after `at`; nothing before the first.
  [[nodiscard]] Found atOrBefore(CalendarMilliseconds at) const;
  /// The value nearest to `at`, the earlier of two.
  [[nodiscard]] Found nearest(CalendarMilliseconds at) const;
  /// Strictly after and before.
  [[nodiscard]] Found next(CalendarMilliseconds at) const { return atOrAfter(at + 1); }
  [[nodiscard]] Found previous(CalendarMilliseconds at) const { return atOrBefore(at - 1); }

  /// One of its values as the service wants it back: in its own style.
  [[nodiscard]] std::string text(const CalendarInstant& value) const;

 private:
  struct Interval {
    CalendarMilliseconds start = 0;
    CalendarMilliseconds end = 0;  ///< the last value
    CalendarPeriod period{};
    std::uint64_t count = 1;
    CalendarStyle style{};
  };

  void addPart(std::string_view part, CalendarMilliseconds now);
  /// Values that only white space parts, as some servers write them; false where it is one value.
  bool addApart(std::string_view part, CalendarMilliseconds now);
  void addInterval(std::string_view part, CalendarMilliseconds now);
  using Understood = tl::expected<Interval, std::string_view>;  ///< or why it is none
  [[nodiscard]] static Understood intervalOf(const std::vector<std::string>& pieces, CalendarMilliseconds now);
  [[nodiscard]] static Understood repeatOf(const std::vector<std::string>& pieces, CalendarMilliseconds now);
  [[nodiscard]] static Understood stepsOf(const CalendarInstant& start, CalendarMilliseconds end,
                                          const CalendarPeriod& period);
  [[nodiscard]] Found atOrAfter(CalendarMilliseconds at) const;

  std::vector<CalendarInstant> instants_;  ///< sorted
  std::vector<Interval> intervals_;
  Found default_;
  std::map<CalendarMilliseconds, std::string> odd_;  ///< values that we would write in another way
  std::vector<std::string> problems_;
};

}  // namespace meridian::globebrowsing
