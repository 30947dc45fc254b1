#include "globebrowsing/network/network_settings.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

using Kind = NetworkSetting::Kind;

struct Names {
  std::string_view property;
  std::string_view variable;
};
struct Range {
  double minimum;
  double maximum;
};

double numberIn(const SettingValue& value) {
  return std::get<double>(value);
}

// Each of these makes a line of the table. `Field` is a lambda that gives the place in NetworkOptions, const or not.

template <class Field>
constexpr NetworkSetting count(Names names, std::string_view unit, Range range, Field, std::string_view meaning) {
  return {names.property,
          names.variable,
          Kind::Count,
          unit,
          range.minimum,
          range.maximum,
          true,
          {},
          meaning,
          [](const NetworkOptions& options) -> SettingValue { return static_cast<double>(Field{}(options)); },
          [](NetworkOptions& options, const SettingValue& value) {
            auto& field = Field{}(options);
            field = static_cast<std::remove_reference_t<decltype(field)>>(std::llround(numberIn(value)));
          }};
}

/// `Kind::Count` where the field has whole seconds only.
template <class Field>
constexpr NetworkSetting seconds(Names names, Range range, Field, std::string_view meaning, Kind kind = Kind::Seconds) {
  return {names.property,
          names.variable,
          kind,
          "s",
          range.minimum,
          range.maximum,
          true,
          {},
          meaning,
          [](const NetworkOptions& options) -> SettingValue {
            return std::chrono::duration<double>(Field{}(options)).count();
          },
          [](NetworkOptions& options, const SettingValue& value) {
            auto& field = Field{}(options);
            field = std::chrono::round<std::remove_reference_t<decltype(field)>>(
                std::chrono::duration<double>(numberIn(value)));
          }};
}

template <int shift, class Field>
constexpr NetworkSetting bytes(Names names, Range range, Field, std::string_view meaning) {
  constexpr double unit = static_cast<double>(1 << shift);
  return {names.property,
          names.variable,
          Kind::Bytes,
          shift == 10 ? "KiB" : "MiB",
          range.minimum,
          range.maximum,
          true,
          {},
          meaning,
          [](const NetworkOptions& options) -> SettingValue { return static_cast<double>(Field{}(options)) / unit; },
          [](NetworkOptions& options, const SettingValue& value) {
            auto& field = Field{}(options);
            field = static_cast<std::remove_reference_t<decltype(field)>>(std::llround(numberIn(value) * unit));
          }};
}

template <class Field>
constexpr NetworkSetting path(Names names, std::string_view initially, Field, std::string_view meaning) {
  return {names.property,
          names.variable,
          Kind::Path,
          {},
          0,
          0,
          false,
          initially,
          meaning,
          [](const NetworkOptions& options) -> SettingValue { return Field{}(options).string(); },
          [](NetworkOptions& options, const SettingValue& value) { Field{}(options) = std::get<std::string>(value); }};
}

constexpr std::array<std::string_view, 4> modeNames{"read-write", "cache-only", "read-only", "off"};

constexpr NetworkSetting cacheMode{
    "NetworkCacheMode",
    "MERIDIAN_CACHE_MODE",
    Kind::Choice,
    {},
    0,
    3,
    true,
    {},
    "`cache-only`: no server is asked, whatever is on disk is given however old it is; `read-only`: nothing is written",
    [](const NetworkOptions& options) -> SettingValue { return static_cast<double>(options.cache.mode); },
    [](NetworkOptions& options, const SettingValue& value) {
      options.cache.mode = static_cast<CacheMode>(std::lround(numberIn(value)));
    }};

constexpr NetworkSetting offline{{},
                                 "MERIDIAN_OFFLINE",
                                 Kind::Switch,
                                 {},
                                 0,
                                 1,
                                 false,
                                 {},
                                 "`1` is the cache mode `cache-only`, whatever `MERIDIAN_CACHE_MODE` says",
                                 [](const NetworkOptions& options) -> SettingValue {
                                   return options.cache.mode == CacheMode::CacheOnly ? 1.0 : 0.0;
                                 },
                                 [](NetworkOptions& options, const SettingValue& value) {
                                   options.cache.mode =
                                       numberIn(value) != 0.0 ? CacheMode::CacheOnly : options.cache.mode;
                                 }};

constexpr NetworkSetting userAgent{
    "NetworkUserAgent",
    "MERIDIAN_USER_AGENT",
    Kind::Line,
    {},
    0,
    0,
    true,
    "Meridian/VERSION",
    "what servers are told that we are",
    [](const NetworkOptions& options) -> SettingValue { return options.userAgent; },
    [](NetworkOptions& options, const SettingValue& value) { options.userAgent = std::get<std::string>(value); }};

// clang-format off
constexpr std::array settings{
    path({"NetworkCacheFolder", "MERIDIAN_CACHE_FOLDER"}, "`http` in the program's cache folder", [](auto& o) -> auto& { return o.cache.folder; }, "where the cache on disk lies; it is made when it is missing"),
    cacheMode,
    offline,
    bytes<20>({"NetworkCacheSize", "MERIDIAN_CACHE_SIZE"}, {0, 1 << 24}, [](auto& o) -> auto& { return o.cache.maximumBytes; }, "that the cache on disk may hold. Above it the least recently used goes, down to nine tenths. 0: no cache"),
    seconds({"NetworkStaleIfError", "MERIDIAN_STALE_IF_ERROR"}, {0, 315'360'000}, [](auto& o) -> auto& { return o.cache.rules.staleIfError; }, "so long past its lifetime an answer stands in for a server in trouble, where the server says nothing else", Kind::Count),
    seconds({"NetworkNegativeLifetime", "MERIDIAN_NEGATIVE_LIFETIME"}, {0, 86'400}, [](auto& o) -> auto& { return o.cache.negativeLifetime; }, "so long \"nothing here\" counts. 0: not at all. A change forgets what is remembered"),
    count({"NetworkNegativeEntries", "MERIDIAN_NEGATIVE_ENTRIES"}, "", {0, 10'000'000}, [](auto& o) -> auto& { return o.cache.maximumNegatives; }, "addresses with \"nothing here\" that are remembered"),
    count({"NetworkConnectionsPerHost", "MERIDIAN_CONNECTIONS_PER_HOST"}, "", {1, 1000}, [](auto& o) -> auto& { return o.concurrency.perHost; }, "connections to a host, which is requests at a time over HTTP/1.1"),
    count({"NetworkStreamsPerHost", "MERIDIAN_STREAMS_PER_HOST"}, "", {1, 1000}, [](auto& o) -> auto& { return o.concurrency.perHostMultiplexed; }, "requests at a time to a host over HTTP/2"),
    count({"NetworkRequests", "MERIDIAN_REQUESTS"}, "", {1, 10'000}, [](auto& o) -> auto& { return o.concurrency.total; }, "requests at a time in all"),
    count({"NetworkAttempts", "MERIDIAN_ATTEMPTS"}, "", {1, 100}, [](auto& o) -> auto& { return o.retry.attempts; }, "times that a request is sent"),
    seconds({"NetworkRetryDelay", "MERIDIAN_RETRY_DELAY"}, {0, 3600}, [](auto& o) -> auto& { return o.retry.firstDelay; }, "before the second time a random part of this is waited, and of twice as much before each further one"),
    seconds({"NetworkRetryDelayLimit", "MERIDIAN_RETRY_DELAY_LIMIT"}, {0, 3600}, [](auto& o) -> auto& { return o.retry.maximumDelay; }, "where that doubling ends"),
    seconds({"NetworkRetryAfterLimit", "MERIDIAN_RETRY_AFTER_LIMIT"}, {0, 86'400}, [](auto& o) -> auto& { return o.retry.maximumRetryAfter; }, "up to which Retry-After is heeded"),
    count({"NetworkBreakerFailures", "MERIDIAN_BREAKER_FAILURES"}, "", {1, 1000}, [](auto& o) -> auto& { return o.retry.failuresUntilDown; }, "failures in a row until a host is *down*"),
    seconds({"NetworkBreakerPause", "MERIDIAN_BREAKER_PAUSE"}, {0.1, 3600}, [](auto& o) -> auto& { return o.retry.firstPause; }, "first pause of a host that is down; each failure doubles it, and chance takes up to a quarter off"),
    seconds({"NetworkBreakerPauseLimit", "MERIDIAN_BREAKER_PAUSE_LIMIT"}, {0.1, 3600}, [](auto& o) -> auto& { return o.retry.maximumPause; }, "where that doubling ends"),
    seconds({"NetworkConnectTimeout", "MERIDIAN_CONNECT_TIMEOUT"}, {0.1, 3600}, [](auto& o) -> auto& { return o.limits.connectTime; }, "for a connection to be made"),
    seconds({"NetworkTransferTimeout", "MERIDIAN_TRANSFER_TIMEOUT"}, {0.1, 86'400}, [](auto& o) -> auto& { return o.limits.totalTime; }, "for a whole transfer"),
    seconds({"NetworkStallTimeout", "MERIDIAN_STALL_TIMEOUT"}, {1, 3600}, [](auto& o) -> auto& { return o.limits.stallTime; }, "slower for so long than the next line says, waiting for the first byte included, is a stall", Kind::Count),
    count({"NetworkStallSpeed", "MERIDIAN_STALL_SPEED"}, "B/s", {1, 1'000'000}, [](auto& o) -> auto& { return o.limits.minimumSpeed; }, "below which a transfer stalls"),
    count({"NetworkRedirects", "MERIDIAN_REDIRECTS"}, "", {0, 50}, [](auto& o) -> auto& { return o.limits.redirects; }, "that are followed, to http and https only"),
    bytes<10>({"NetworkHeaderSize", "MERIDIAN_HEADER_SIZE"}, {1, 1024}, [](auto& o) -> auto& { return o.limits.headerBytes; }, "that the headers of an answer may have"),
    bytes<20>({"NetworkBodySize", "MERIDIAN_BODY_SIZE"}, {1, 1024}, [](auto& o) -> auto& { return o.limits.bodyBytes; }, "that a tile may have, after decoding of its content encoding"),
    count({"NetworkImageSide", "MERIDIAN_IMAGE_SIDE"}, "pixels", {64, 8192}, [](auto& o) -> auto& { return o.images.side; }, "that a side of a tile's image may have"),
    count({"NetworkImagePixels", "MERIDIAN_IMAGE_PIXELS"}, "pixels", {4096, 1 << 26}, [](auto& o) -> auto& { return o.images.pixels; }, "that a tile's image may have in all"),
    userAgent,
    path({"NetworkCaFile", "MERIDIAN_CA_FILE"}, "the system's", [](auto& o) -> auto& { return o.certificateFile; }, "certificates (PEM) to trust *in place of* the system's: for a server with an authority of its own"),
};
// clang-format on

/// "500000", "64M", "2G", "2GiB".
std::optional<double> parseSize(std::string_view text) {
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const std::string_view unit = text.substr(digits);
  std::uint64_t number = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + digits, number);
  constexpr std::string_view letters = "KMGT";
  const std::size_t power = unit.empty() ? 0 : letters.find(unit.front()) + 1;
  if (digits == 0 || code != std::errc() || (!unit.empty() && power == 0) ||
      (unit.size() > 1 && unit.substr(1) != "iB")) {
    return std::nullopt;
  }
  return std::ldexp(static_cast<double>(number), static_cast<int>(10 * power));
}

std::optional<double> parseSwitch(std::string_view text) {
  constexpr std::array<std::string_view, 4> on{"1", "true", "yes", "on"};
  constexpr std::array<std::string_view, 4> off{"0", "false", "no", "off"};
  if (std::find(on.begin(), on.end(), text) != on.end()) {
    return 1.0;
  }
  return std::find(off.begin(), off.end(), text) != off.end() ? std::optional(0.0) : std::nullopt;
}

template <class Number>
std::optional<double> parseNumber(std::string_view text) {
  Number number{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool isWhole = code == std::errc() && end == text.data() + text.size();
  return isWhole ? std::optional(static_cast<double>(number)) : std::nullopt;
}

/// In the setting's unit, whether or not it is in range.
std::optional<double> numberOf(const NetworkSetting& setting, std::string_view text) {
  switch (setting.kind) {
    case Kind::Count:
      return parseNumber<std::int64_t>(text);
    case Kind::Seconds:
      return parseNumber<double>(text);
    case Kind::Bytes: {
      const double unit = setting.unit == "KiB" ? 1024.0 : 1048576.0;
      const auto size = parseSize(text);
      return size ? std::optional(*size / unit) : std::nullopt;
    }
    case Kind::Choice: {
      const auto mode = cacheModeFromName(text);
      return mode ? std::optional(static_cast<double>(*mode)) : std::nullopt;
    }
    case Kind::Switch:
      return parseSwitch(text);
    default:
      return std::nullopt;
  }
}

/// What a value has to be, as the end of a sentence.
std::string expected(const NetworkSetting& setting) {
  switch (setting.kind) {
    case Kind::Count:
    case Kind::Seconds:
      return fmt::format("a {}number from {}{}{}", setting.kind == Kind::Count ? "whole " : "", setting.values(),
                         setting.unit.empty() ? "" : " ", setting.unit);
    case Kind::Bytes:
      return fmt::format("a number of bytes, such as 500000000, 512M or 2G, from {} {}", setting.values(),
                         setting.unit);
    case Kind::Line:
      return "a line of printable ASCII";
    case Kind::Path:
      return "a path";
    default:
      return fmt::format("one of {}", setting.values());
  }
}

}  // namespace

std::string NetworkSetting::values() const {
  switch (kind) {
    case Kind::Choice:
      return fmt::format("{}", fmt::join(modeNames, ", "));
    case Kind::Switch:
      return "0, 1";
    case Kind::Line:
      return "a line of ASCII";
    case Kind::Path:
      return "a path";
    default:
      return fmt::format("{} to {}", minimum, maximum);
  }
}

std::string NetworkSetting::defaultText() const {
  if (kind == Kind::Choice) {
    return std::string(modeNames[static_cast<std::size_t>(std::get<double>(get({})))]);
  }
  return kind == Kind::Line || kind == Kind::Path ? std::string(initially)
                                                  : fmt::format("{}", std::get<double>(get({})));
}

std::span<const NetworkSetting> networkSettings() {
  return settings;
}

std::span<const std::string_view> cacheModeNames() {
  return modeNames;
}

bool isAllowed(const NetworkSetting& setting, std::string_view text) {
  return setting.kind != Kind::Line ||
         std::all_of(text.begin(), text.end(), [](char letter) { return letter >= ' ' && letter <= '~'; });
}

Result<SettingValue> parseSetting(const NetworkSetting& setting, std::string_view text) {
  if (setting.kind == Kind::Line || setting.kind == Kind::Path) {
    if (isAllowed(setting, text)) {
      return SettingValue(std::string(text));
    }
  } else if (const auto number = numberOf(setting, text);
             number && *number >= setting.minimum && *number <= setting.maximum) {
    return SettingValue(*number);
  }
  return failure(fmt::format("'{}' is not {}", text, expected(setting)), std::string(setting.variable));
}

NetworkOptions withEnvironment(NetworkOptions options) {
  for (const NetworkSetting& setting : settings) {
    const char* text = std::getenv(std::string(setting.variable).c_str());
    if (text == nullptr || *text == '\0') {
      continue;
    }
    if (const auto value = parseSetting(setting, text)) {
      setting.set(options, *value);
    } else {
      log::warning("the environment's {}: {}; it is left out", setting.variable, value.error().what);
    }
  }
  return options;
}

}  // namespace meridian::globebrowsing
