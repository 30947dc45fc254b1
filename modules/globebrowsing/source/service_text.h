#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "globebrowsing/network/header_fields.h"

namespace meridian::globebrowsing {

// What reading the documents of map services takes besides: ASCII text, whatever the locale.

[[nodiscard]] std::string lowerCase(std::string_view text);
[[nodiscard]] bool containsIgnoringCase(std::string_view text, std::string_view part);
/// The parts between separators, trimmed, empty ones left out.
[[nodiscard]] std::vector<std::string> split(std::string_view text, std::string_view separators);
[[nodiscard]] std::string replaceAll(std::string text, std::string_view from, std::string_view to);

/// A finite number that is the whole text but for white space around it.
[[nodiscard]] std::optional<double> number(std::string_view text);
/// A whole number; "2.0" is one as well (NASA's Treks write so).
[[nodiscard]] std::optional<long long> integer(std::string_view text);
/// "true", "1", "yes", "on" and their opposites, in any case.
[[nodiscard]] std::optional<bool> boolean(std::string_view text);
/// At most ten decimals, no exponent (servers do not read it), no trailing zeros.
[[nodiscard]] std::string decimal(double value);

/// A credit on one line: white space in it as single blanks, tags of HTML left out.
[[nodiscard]] std::string creditText(std::string_view text);

/// Everything but unreserved characters (RFC 3986, section 2.3) and those of `kept` as %XX.
[[nodiscard]] std::string percentEncoded(std::string_view text, std::string_view kept = {});

/// The opposite; what is no such escape stays.
[[nodiscard]] std::string percentDecoded(std::string_view text);

using QueryParameters = std::vector<std::pair<std::string, std::string>>;

/// `url` with these parameters in its query: those of the same name (in any case) are replaced, all others kept as they
/// are. Names and values are taken as encoded already.
[[nodiscard]] std::string withParameters(std::string_view url, const QueryParameters& parameters);
/// The value, still encoded, of a parameter of the query, its name in any case.
[[nodiscard]] std::optional<std::string> parameterOf(std::string_view url, std::string_view name);
/// Whether a GetMap request has a parameter of that name (in any case) of its own, whatever the server.
[[nodiscard]] bool isGetMapParameter(std::string_view name);
[[nodiscard]] std::string withoutQuery(std::string_view url);
/// `reference` as seen from a document at `base` (RFC 3986, section 5.2, for http, https, file and plain paths).
[[nodiscard]] std::string resolvedUrl(std::string_view base, std::string_view reference);
/// Puts right "http:/host" and blanks around it, as real descriptions have them.
[[nodiscard]] std::string repairedUrl(std::string_view url);

}  // namespace meridian::globebrowsing
