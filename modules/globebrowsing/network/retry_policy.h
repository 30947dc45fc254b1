#pragma once

#include <chrono>
#include <optional>
#include <string_view>

#include "globebrowsing/network/cache_policy.h"

namespace meridian::globebrowsing {

/// How one attempt ended, as far as trying again is concerned.
enum class Outcome {
  Done,         ///< an answer that counts: any 2xx, 304, and whatever the request calls empty
  Unreachable,  ///< no answer: no such host, no connection, reset, timed out, stalled
  Unavailable,  ///< 429, 502, 503, 504, 522, 524: the server asks to be left alone for a while
  ServerError,  ///< any other 5xx, 408, 425, or a body that broke off: may be this one address
  Final         ///< asking again would change nothing: other 4xx, certificates, limits
};

/// How failed requests are tried again.
struct RetryOptions {
  /// How often in all a request is sent; 1 is never again. Of a patient request, what fails while its server is down,
  /// or answers nobody else either, does not count.
  int attempts = 5;
  /// The n-th wait is a random part of firstDelay * 2^(n-1), but at most of maximumDelay. 0 tries again at once.
  std::chrono::milliseconds firstDelay{500};
  std::chrono::milliseconds maximumDelay{15'000};
  /// What Retry-After may ask for at most.
  std::chrono::milliseconds maximumRetryAfter{60'000};
  /// So many failures in a row, of whatever requests to it, mean that a server is down. At least 1.
  int failuresUntilDown = 5;
  /// The first pause before one request is let through to see; each that fails doubles the pause, up to the maximum.
  /// So a server that returns is noticed within maximumPause.
  std::chrono::milliseconds firstPause{1'000};
  std::chrono::milliseconds maximumPause{15'000};
};

/// Of an answer with that status.
[[nodiscard]] Outcome outcomeOfStatus(int status);

/// The wait after the `failures`-th failure (1 is the first): exponential, with full jitter. `random` is in [0, 1).
[[nodiscard]] std::chrono::milliseconds retryDelay(const RetryOptions& options, int failures, double random);

/// The wait that a Retry-After asks for (RFC 9110, section 10.2.3: seconds or a date), at least 0 and at most the
/// maximum; nothing when it cannot be understood.
[[nodiscard]] std::optional<std::chrono::milliseconds> retryAfter(const RetryOptions& options, std::string_view value,
                                                                  UnixTime now);

}  // namespace meridian::globebrowsing
