#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "globebrowsing/network/header_fields.h"

namespace meridian::globebrowsing {

/// Seconds since 1970, by the system's clock.
using UnixTime = std::int64_t;

/// What holds where a server says nothing.
struct CacheRules {
  /// With a Last-Modified, an answer is fresh for this part of the time it had gone unchanged (RFC 9111, 4.2.2) ...
  double heuristicFraction = 0.1;
  /// ... but at most for this long.
  std::chrono::seconds maximumHeuristic = std::chrono::hours{24 * 7};
  /// With neither a lifetime nor a Last-Modified.
  std::chrono::seconds defaultLifetime = std::chrono::hours{24};
  /// How long past its lifetime an answer stands in for a server that cannot be reached or is in trouble (RFC 5861, 4).
  std::chrono::seconds staleIfError = std::chrono::hours{24 * 30};
};

/// What is known of an answer that is kept: the fields that matter to a cache, and when it was asked for and came.
struct AnswerFacts {
  HeaderFields fields{};
  UnixTime requestTime = 0;
  UnixTime responseTime = 0;
};

/// The rules of RFC 9111 for a private cache, as functions of an answer and the time. A cache that is private may keep
/// what says "private", and does not heed s-maxage.

/// Whether an answer may be kept at all: status 200, and neither no-store nor Vary: *. Any other Vary is met because
/// what is kept is named by the address and all further request headers, and the rest of a request never changes.
[[nodiscard]] bool isStorable(int status, const HeaderFields& fields);

/// Section 4.2: max-age, else Expires less Date, else a guess by `rules`. What cannot be understood is 0: stale.
[[nodiscard]] std::int64_t freshnessLifetime(const AnswerFacts& facts, const CacheRules& rules);
/// Section 4.2.3, in seconds.
[[nodiscard]] std::int64_t currentAge(const AnswerFacts& facts, UnixTime now);
/// Whether it may be used without asking; never with no-cache.
[[nodiscard]] bool isFresh(const AnswerFacts& facts, const CacheRules& rules, UnixTime now);
/// Whether it may be used although it is not fresh, because its server cannot answer: stale-if-error, else `rules`.
/// Never with must-revalidate or no-cache (section 4.2.4).
[[nodiscard]] bool mayServeStale(const AnswerFacts& facts, const CacheRules& rules, UnixTime now);

/// The headers, "Name: value", that turn a request into the question whether the answer is still good (section 4.3.1).
/// Empty when nothing can be asked.
[[nodiscard]] std::vector<std::string> conditionalHeaders(const AnswerFacts& facts);
/// What is known after a 304 (section 4.3.4): new fields replace old ones of the same name.
[[nodiscard]] AnswerFacts refreshed(const AnswerFacts& kept, const AnswerFacts& of304);
/// Only the fields that the functions above read, and Content-Type.
[[nodiscard]] HeaderFields relevantFields(const HeaderFields& fields);

/// An HTTP date (RFC 9110, 5.6.7, in any of its forms), nothing for any other text.
[[nodiscard]] std::optional<UnixTime> parseHttpDate(std::string_view text);

}  // namespace meridian::globebrowsing
