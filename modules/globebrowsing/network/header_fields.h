#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace meridian::globebrowsing {

/// The fields of an HTTP message in the order of arrival. Names compare without regard to case (RFC 9110, section 5.1).
class HeaderFields {
 public:
  void add(std::string_view name, std::string_view value);
  /// "Name: value", with or without a line end; what is no field is left out.
  void addLine(std::string_view line);
  /// Takes all fields of that name away.
  void remove(std::string_view name);

  /// Of the first field of that name; good until the next change.
  [[nodiscard]] std::optional<std::string_view> find(std::string_view name) const;
  /// All values of that name, joined by commas: the same as one field (RFC 9110, section 5.3). Empty without any.
  [[nodiscard]] std::string list(std::string_view name) const;
  [[nodiscard]] const std::vector<std::pair<std::string, std::string>>& all() const { return fields_; }

  /// One "Name: value" a line, and back.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] static HeaderFields fromText(std::string_view text);

 private:
  std::vector<std::pair<std::string, std::string>> fields_;
};

/// ASCII letters only, whatever the locale.
[[nodiscard]] bool equalIgnoringCase(std::string_view a, std::string_view b);
/// Without spaces, tabs and line ends at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

}  // namespace meridian::globebrowsing
