#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "globebrowsing/network/network_options.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

/// A number in its setting's unit, a choice's place in CacheMode or a switch's 0 or 1; or a text.
using SettingValue = std::variant<double, std::string>;

/// Something that users can set of the network. What there is, is said in networkSettings() only: the environment, the
/// module's properties and the table of docs/network.md (a test compares it) follow from that.
struct NetworkSetting {
  enum class Kind { Count, Seconds, Bytes, Choice, Switch, Line, Path };

  std::string_view property;  ///< of the module, "NetworkCacheSize"; empty: it has none
  std::string_view variable;  ///< of the environment, "MERIDIAN_CACHE_SIZE"
  Kind kind;
  std::string_view unit;  ///< of `minimum`, `maximum` and the property: "s", "MiB", ...; empty: a number without one
  double minimum;         ///< of numbers, part of the range like the maximum
  double maximum;
  bool isLive;                 ///< the property can be set, and requests made afterwards heed it; else it is read only
  std::string_view initially;  ///< of texts: the default in words
  std::string_view meaning;
  SettingValue (*get)(const NetworkOptions&);
  void (*set)(NetworkOptions&, const SettingValue&);

  [[nodiscard]] bool isNumber() const { return kind == Kind::Count || kind == Kind::Seconds || kind == Kind::Bytes; }
  /// "1 to 1000"; of choices the words; of others what they are.
  [[nodiscard]] std::string values() const;
  /// "8", "0.5"; of texts `initially`.
  [[nodiscard]] std::string defaultText() const;
};

/// In the order of the documentation, in which they are set.
[[nodiscard]] std::span<const NetworkSetting> networkSettings();

/// The words of CacheMode, in its order.
[[nodiscard]] std::span<const std::string_view> cacheModeNames();

/// What the environment's text means. Numbers are decimal; bytes may have K, M, G or T, whatever the property's unit
/// is. Errors: no such value, out of range; `what` ends in what is allowed.
[[nodiscard]] Result<SettingValue> parseSetting(const NetworkSetting& setting, std::string_view text);
/// Whether a text can be a setting's: of a Line only printable ASCII, since it becomes a header field.
[[nodiscard]] bool isAllowed(const NetworkSetting& setting, std::string_view text);

/// `options` with what the environment says in place. What it says wrongly is logged and left out.
[[nodiscard]] NetworkOptions withEnvironment(NetworkOptions options);

}  // namespace meridian::globebrowsing
