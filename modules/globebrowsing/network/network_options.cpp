#include "globebrowsing/network/network_options.h"

#include <charconv>
#include <cstdlib>
#include <limits>

#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

/// Null when it is unset or empty.
const char* variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : nullptr;
}

template <class Number>
std::optional<Number> parseNumber(std::string_view text) {
  Number number{};
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), number);
  return code == std::errc() && end == text.data() + text.size() ? std::optional<Number>(number) : std::nullopt;
}

/// "500000", "64M", "2G", "2GiB".
std::optional<std::uint64_t> parseSize(std::string_view text) {
  const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
  const std::string_view unit = text.substr(digits);
  const auto number = parseNumber<std::uint64_t>(text.substr(0, digits));
  int shift = 0;
  if (unit == "K" || unit == "KiB") {
    shift = 10;
  } else if (unit == "M" || unit == "MiB") {
    shift = 20;
  } else if (unit == "G" || unit == "GiB") {
    shift = 30;
  } else if (unit == "T" || unit == "TiB") {
    shift = 40;
  } else if (!unit.empty()) {
    return std::nullopt;
  }
  if (!number || *number > (std::numeric_limits<std::uint64_t>::max() >> shift)) {
    return std::nullopt;
  }
  return *number << shift;
}

std::optional<int> parseCount(std::string_view text) {
  const auto number = parseNumber<int>(text);
  return number && *number >= 1 && *number <= 1000 ? number : std::nullopt;
}

std::optional<bool> parseSwitch(std::string_view text) {
  if (text == "1" || text == "true" || text == "yes" || text == "on") {
    return true;
  }
  if (text == "0" || text == "false" || text == "no" || text == "off") {
    return false;
  }
  return std::nullopt;
}

/// Sets `target` from the variable, if there is one that `parse` takes.
template <class Target, class Parse>
void read(const char* name, const char* expected, Parse parse, Target& target) {
  const char* text = variable(name);
  if (text == nullptr) {
    return;
  }
  if (const auto value = parse(text)) {
    target = *value;
  } else {
    log::warning("the environment's {} is '{}', which is not {}; it is left out", name, text, expected);
  }
}

}  // namespace

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

NetworkOptions withEnvironment(NetworkOptions options) {
  read("MERIDIAN_CACHE_MODE", "read-write, cache-only, read-only or off", cacheModeFromName, options.cache.mode);
  read("MERIDIAN_CACHE_SIZE", "a number of bytes, such as 500000000, 512M or 2G", parseSize,
       options.cache.maximumBytes);
  read("MERIDIAN_CONNECTIONS_PER_HOST", "a number from 1 to 1000", parseCount, options.concurrency.perHost);
  bool isOffline = false;
  read("MERIDIAN_OFFLINE", "0 or 1", parseSwitch, isOffline);
  if (isOffline) {
    options.cache.mode = CacheMode::CacheOnly;
  }
  if (const char* file = variable("MERIDIAN_CA_FILE")) {
    options.certificateFile = file;
  }
  return options;
}

}  // namespace meridian::globebrowsing
