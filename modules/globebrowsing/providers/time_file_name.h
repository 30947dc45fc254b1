#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"
#include "host/api/time.h"

namespace meridian::globebrowsing {

/// Reads the time that a file's name begins with, by a format like that of std::get_time, without a locale:
/// %Y %y %m %d %H %M %S %j (day of the year, from 1) %U (week of the year, from its first Sunday) %b %B (English
/// months) %e %F %T %D %R %n %t %%, literal text, and white space for any amount of it.
///
/// What the format leaves out is the first of its kind: of a year and a week, the week's Sunday. A field that is
/// repeated counts as written last. Formats with %M and %H but neither month nor day mean month and day: a slip of
/// several published assets. Two-digit years are 1969 to 2068 (POSIX).
class TimeFileName {
 public:
  /// Errors: an unknown conversion; no year.
  [[nodiscard]] static Result<TimeFileName> create(std::string_view format);

  /// Nothing when the name does not begin like that, or the calendar has no such time.
  [[nodiscard]] std::optional<Time::UtcInstant> read(std::string_view name) const;

 private:
  /// A conversion, its letter in `text`; or a literal character, '\0' for white space.
  struct Part {
    bool isConversion = false;
    char text = '\0';
  };
  explicit TimeFileName(std::vector<Part> parts) : parts_(std::move(parts)) {}

  std::vector<Part> parts_;
};

}  // namespace meridian::globebrowsing
