#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"
#include "host/api/time.h"

namespace meridian::globebrowsing {

/// Reads the time that a file's name begins with, by a format like that of std::get_time, without a locale: its
/// conversions %Y %y %C %m %b %B %h %d %e %j %U %W %w %a %A %H %I %p %M %S %D %T %R %r %c %x %X %n %t %%, with E or O
/// before the letter as well, those that strptime of glibc has besides (%F %G %g %V %u %k %l %P %s), and %z and %Z,
/// which are read over. Names are English. Other text stands for itself, in upper or lower case, and white space for
/// any amount of it.
///
/// DateFields tells what becomes of them, and of what the format leaves out. Formats with a year, %M and %H but nothing
/// that says the day mean month and day by these: a slip of several published assets. %y takes two digits, whatever
/// follows.
class TimeFileName {
 public:
  /// Errors: no text at all; an unknown conversion, and one without its letter.
  [[nodiscard]] static Result<TimeFileName> create(std::string_view format);

  /// Nothing when the name does not begin with all of it, or the calendar has no such time.
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
