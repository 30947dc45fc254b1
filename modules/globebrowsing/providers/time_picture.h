#pragma once

#include <string>
#include <string_view>

#include "host/api/error.h"
#include "host/api/time.h"

namespace meridian::globebrowsing {

/// Writes an instant as a picture says, like SPICE's timout_c (NAIF, TIMOUT, "The format picture"): YYYY, YR, MM, DD,
/// DOY, HR, MN, SC, AP, JULIAND, MONTH, MON, WEEKDAY, WKD and AMPM (names in the case of the picture: MON, Mon, mon), a
/// fraction .### after SC (cut, not rounded); all else stands for itself. Modifiers ::UTC, ::TRNC and ::RND change
/// nothing here. What is written may be longer than the picture.
///
/// Errors: other modifiers (time zones and scales).
[[nodiscard]] Result<std::string> writeTime(std::string_view picture, Time::UtcInstant instant);

}  // namespace meridian::globebrowsing
