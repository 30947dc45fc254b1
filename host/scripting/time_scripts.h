#pragma once

#include <functional>
#include <string_view>

#include "host/api/script_library.h"
#include "host/api/time.h"
#include "host/scripting/clock.h"

namespace meridian::scripting {

/// `openspace.time.*`. `applicationSeconds` gives the seconds since the program began; clock must outlive the library.
[[nodiscard]] ScriptLibrary timeLibrary(Clock& clock, std::function<double()> applicationSeconds);

/// `base` moved by "[-]N" and a unit: s, m, h, d (of 86400 s), M and y. Months and years move on the UTC calendar, the
/// day cut to the month's last. Errors: any other text; months or years that are no whole number or leave the calendar.
[[nodiscard]] Result<Time> advanced(Time base, std::string_view change);

}  // namespace meridian::scripting
