#pragma once

#include <string_view>

#include "host/api/error.h"
#include "host/api/time.h"

namespace meridian::globebrowsing {

/// Reads a date as assets write them: what Time::fromUtc reads, and "2004", "2004-03".
[[nodiscard]] Result<Time::UtcInstant> readDate(std::string_view text);

}  // namespace meridian::globebrowsing
