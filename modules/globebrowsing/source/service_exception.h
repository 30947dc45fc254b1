#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace meridian::globebrowsing {

/// What a service says in place of what was asked for: the text of an OGC ServiceExceptionReport or ExceptionReport, of
/// an ArcGIS error in JSON, or the title of a page in HTML; shortened to a line. Nothing where the bytes are none of
/// these. Never fails: what cannot be read any further is quoted as it is.
[[nodiscard]] std::optional<std::string> exceptionText(std::span<const std::uint8_t> bytes);

}  // namespace meridian::globebrowsing
