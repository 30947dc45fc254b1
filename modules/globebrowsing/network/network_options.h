#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "globebrowsing/network/cache_policy.h"
#include "globebrowsing/network/request_queue.h"
#include "globebrowsing/network/retry_policy.h"

namespace meridian::globebrowsing {

enum class CacheMode {
  ReadWrite,
  CacheOnly,  ///< no server is asked: what is not on disk is an error; what is there is given however old it is
  ReadOnly,   ///< nothing is written, not even when something was last used
  Off
};

/// "read-write", "cache-only", "read-only" or "off"; nothing for any other word.
[[nodiscard]] std::optional<CacheMode> cacheModeFromName(std::string_view name);

struct CacheOptions {
  /// Where the database lies; it is made when it is missing. Empty: no cache.
  std::filesystem::path folder{};
  CacheMode mode = CacheMode::ReadWrite;
  /// Of all that is kept. Above it the least recently used goes, down to nine tenths. 0 keeps nothing.
  std::uint64_t maximumBytes = std::uint64_t{2} << 30;
  CacheRules rules{};
  /// How long "nothing here" counts without being asked again. 0: not at all.
  std::chrono::milliseconds negativeLifetime = std::chrono::minutes{10};
  std::size_t maximumNegatives = 200'000;
  /// Of bodies that wait to be written; what comes above it, because the disk is slow, is not kept.
  std::size_t maximumUnwrittenBytes = std::size_t{64} << 20;
};

/// Of every single transfer. Each ends it with an error; 0 means no limit, except where said otherwise.
struct TransferLimits {
  std::chrono::milliseconds connectTime{10'000};
  /// From being sent to the last byte; waiting for a turn does not count.
  std::chrono::milliseconds totalTime{120'000};
  /// Slower than minimumSpeed bytes a second for so long (waiting for the first byte included) is a stall.
  std::chrono::seconds stallTime{30};
  long minimumSpeed = 64;
  long redirects = 5;                               ///< 0: none is followed
  std::size_t headerBytes = std::size_t{64} << 10;  ///< of all headers of one answer; 0: none may be sent
  /// Of a body after decoding of its content encoding, where a FetchRequest says nothing else.
  std::size_t bodyBytes = std::size_t{32} << 20;
};

/// What the image of a tile may announce; one that announces more is not decoded.
struct ImageLimits {
  std::int32_t side = 8192;                     ///< pixels, at least 1
  std::int32_t pixels = std::int32_t{1} << 24;  ///< width times height
};

/// How the network behaves. The defaults are what a globe wants; network_settings.h tells what users can set of it.
struct NetworkOptions {
  ConcurrencyOptions concurrency{};
  RetryOptions retry{};
  TransferLimits limits{};
  ImageLimits images{};
  CacheOptions cache{};
  /// A file of certificates (PEM) to trust in place of the system's. Empty: the system's.
  std::filesystem::path certificateFile{};
  /// Empty: Meridian/VERSION.
  std::string userAgent{};
};

/// Gives `running` all of `options` that may change while the network runs: all but the cache's folder and the
/// certificates.
void setRunningOptions(NetworkOptions& running, const NetworkOptions& options);

/// Of these, or where they say nothing ours: Meridian/VERSION.
[[nodiscard]] std::string userAgentOf(const NetworkOptions& options);

}  // namespace meridian::globebrowsing
