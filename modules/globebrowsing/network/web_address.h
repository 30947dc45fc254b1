#pragma once

#include <string>

#include "host/api/error.h"

namespace meridian::globebrowsing {

/// A URL that may be asked for.
struct WebAddress {
  std::string url;   ///< as it is sent: spaces and letters outside ASCII encoded, no fragment
  std::string host;  ///< what shares connections, limits and fate: "https://tiles.example.org:443"
  bool isEncrypted = false;
};

/// An error for what is no URL, has no host, or is neither http nor https.
[[nodiscard]] Result<WebAddress> parseWebAddress(const std::string& url);

}  // namespace meridian::globebrowsing
