#include "globebrowsing/network/network_options.h"

#include <utility>

namespace meridian::globebrowsing {

std::optional<CacheMode> cacheModeFromName(std::string_view name) {
  if (name == "read-write") {
    return CacheMode::ReadWrite;
  }
  if (name == "cache-only") {
    return CacheMode::CacheOnly;
  }
  if (name == "read-only") {
    return CacheMode::ReadOnly;
  }
  return name == "off" ? std::optional(CacheMode::Off) : std::nullopt;
}

void setRunningOptions(NetworkOptions& running, const NetworkOptions& options) {
  NetworkOptions changed = options;
  changed.cache.folder = std::move(running.cache.folder);
  changed.certificateFile = std::move(running.certificateFile);
  running = std::move(changed);
}

std::string userAgentOf(const NetworkOptions& options) {
  return options.userAgent.empty() ? "Meridian/" MERIDIAN_VERSION : options.userAgent;
}

}  // namespace meridian::globebrowsing
