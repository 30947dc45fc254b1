#include "globebrowsing/network/retry_policy.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace meridian::globebrowsing {

Outcome outcomeOfStatus(int status) {
  switch (status) {
    case 408:
    case 425:
      return Outcome::ServerError;
    case 429:
    case 502:
    case 503:
    case 504:
    case 522:
    case 524:
      return Outcome::Unavailable;
    default:
      break;
  }
  if (status >= 500) {
    return Outcome::ServerError;
  }
  return (status >= 200 && status < 300) || status == 304 ? Outcome::Done : Outcome::Final;
}

std::chrono::milliseconds retryDelay(const RetryOptions& options, int failures, double random) {
  const double first = static_cast<double>(options.firstDelay.count());
  const double most = static_cast<double>(options.maximumDelay.count());
  const double whole = std::min(std::ldexp(first, std::clamp(failures - 1, 0, 60)), most);
  return std::chrono::milliseconds(static_cast<std::int64_t>(std::max(whole, 0.0) * random));
}

std::optional<std::chrono::milliseconds> retryAfter(const RetryOptions& options, std::string_view value, UnixTime now) {
  value = trimmed(value);
  std::int64_t seconds = 0;
  if (!value.empty() && value.find_first_not_of("0123456789") == std::string_view::npos) {
    for (const char digit : value) {
      seconds = std::min<std::int64_t>(seconds * 10 + (digit - '0'), 1'000'000'000);
    }
  } else if (const auto date = parseHttpDate(value)) {
    seconds = std::clamp<std::int64_t>(*date - now, 0, 1'000'000'000);
  } else {
    return std::nullopt;
  }
  return std::min<std::chrono::milliseconds>(std::chrono::seconds(seconds), options.maximumRetryAfter);
}

}  // namespace meridian::globebrowsing
