#pragma once

#include <optional>
#include <string_view>

#include "host/api/error.h"
#include "host/api/time.h"

namespace meridian::globebrowsing {

/// The distance between the steps of a series: a whole number of one unit of the calendar.
struct TimeResolution {
  enum class Unit : char { Years = 'y', Months = 'M', Days = 'd', Hours = 'h', Minutes = 'm' };
  Unit unit = Unit::Days;
  int count = 1;

  /// Reads "1d", "3M", "15m". Years: any count of at least 1; months 1 to 6; days 1 to 28; hours 1, 2, 3, 4, 6 or 12;
  /// minutes 15 or 30 (OpenSpace's rules). Errors: anything else.
  [[nodiscard]] static Result<TimeResolution> read(std::string_view text);
};

/// The steps of a regular series in time, and which of them holds an instant.
///
/// Calendar arithmetic in UTC: steps of months and years go by the calendar, the others by days of 24 hours. Within
/// start..end an instant goes to the latest step not after it; outside, to the start or to the end, and that end need
/// not be a step. Immutable. A closed form: no search.
class TimeQuantizer {
 public:
  using Instant = Time::UtcInstant;

  /// Errors: an end before the start; a start that is not at midnight; a day that not every month of the series has.
  [[nodiscard]] static Result<TimeQuantizer> create(Instant start, Instant end, const TimeResolution& resolution);

  /// Which step is shown then.
  [[nodiscard]] Instant quantize(Instant instant) const;
  /// The first instant after `quantized` (a result of quantize) that goes elsewhere; nothing after the last.
  [[nodiscard]] std::optional<Instant> following(Instant quantized) const;
  [[nodiscard]] Instant start() const { return start_; }
  [[nodiscard]] Instant end() const { return end_; }

 private:
  TimeQuantizer(Instant start, Instant end, const TimeResolution& resolution)
      : start_(start), end_(end), resolution_(resolution) {}
  [[nodiscard]] Instant step(std::int64_t number) const;
  [[nodiscard]] std::int64_t numberAt(Instant instant) const;

  Instant start_;
  Instant end_;
  TimeResolution resolution_;
};

}  // namespace meridian::globebrowsing
