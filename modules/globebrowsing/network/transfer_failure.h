#pragma once

#include <string>

#include "globebrowsing/network/retry_policy.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

/// Why a transfer brought no answer, and whether another try may.
struct TransferFailure {
  Outcome outcome = Outcome::Final;
  Error error;
};

/// Of a transfer that curl ended with `code`, a CURLcode; `detail` is what curl says of it, may be empty.
[[nodiscard]] TransferFailure failureOfCurl(int code, const std::string& detail, const std::string& url);
/// Of an answer whose status is no success.
[[nodiscard]] TransferFailure failureOfStatus(int status, const std::string& url);

}  // namespace meridian::globebrowsing
