#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "globebrowsing/source/calendar.h"
#include "host/api/time.h"

namespace meridian::globebrowsing {

/// A value of a time dimension.
struct TimeValue {
  Time time{};
  std::string text{};  ///< as the service wants it back: in its own style
};

/// The instants that a service has: WMS 1.1.1 and 1.3.0, annex C and D, WMTS 1.0.0 section 7.1.1. A list of values and
/// of intervals "start/end/period"; an interval without period (or with an empty or zero one) has every instant in it.
/// An end cut short means its beginning ("2013-12-31" is that midnight): what lies after it might be refused.
/// Intervals are never expanded: a century of five-minute steps costs what one step costs.
///
/// Steps are UTC's calendar: months and years as the calendar has them, and no leap seconds, as no service counts them.
/// Immutable; safe from any thread.
class TimeDimension {
 public:
  TimeDimension() = default;
  /// `values` is the text of a Dimension or Extent element, or the values of a WMTS dimension joined by commas;
  /// `defaultValue` may be empty, "current" or a value. `now` is what "present", "now" and "current" mean. Parts that
  /// are not understood are left out and told in problems().
  [[nodiscard]] static TimeDimension parse(std::string_view values, std::string_view defaultValue, const Time& now);

  [[nodiscard]] bool isEmpty() const { return instants_.empty() && intervals_.empty(); }
  [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }
  /// Values in all, a continuous interval counted as one; values that two parts share count twice.
  [[nodiscard]] std::uint64_t count() const;

  [[nodiscard]] std::optional<TimeValue> first() const;
  [[nodiscard]] std::optional<TimeValue> last() const;
  /// The service's own; the last one where it names none.
  [[nodiscard]] std::optional<TimeValue> defaultValue() const;
  /// The latest value not after `time`; nothing before the first.
  [[nodiscard]] std::optional<TimeValue> atOrBefore(const Time& time) const;
  /// The value nearest to `time`, the earlier of two.
  [[nodiscard]] std::optional<TimeValue> nearest(const Time& time) const;
  /// Strictly after and before. In a continuous interval: the next and last whole second.
  [[nodiscard]] std::optional<TimeValue> next(const Time& time) const;
  [[nodiscard]] std::optional<TimeValue> previous(const Time& time) const;

 private:
  struct Interval {
    CalendarMilliseconds start = 0;
    CalendarMilliseconds end = 0;  ///< the last value, but for continuous ones
    CalendarPeriod period{};
    std::uint64_t count = 1;
    CalendarStyle style{};
  };
  using Found = std::optional<CalendarInstant>;

  void addPart(std::string_view part, CalendarMilliseconds now);
  void addInterval(std::string_view part, CalendarMilliseconds now);
  [[nodiscard]] Found latest(CalendarMilliseconds at) const;    ///< not after
  [[nodiscard]] Found earliest(CalendarMilliseconds at) const;  ///< not before

  std::vector<CalendarInstant> instants_;  ///< sorted
  std::vector<Interval> intervals_;
  std::optional<CalendarInstant> default_;
  std::vector<std::string> problems_;
};

}  // namespace meridian::globebrowsing
