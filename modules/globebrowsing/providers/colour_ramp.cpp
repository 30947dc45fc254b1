#include "globebrowsing/providers/colour_ramp.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace meridian::globebrowsing {

namespace {

/// The names that gdaldem knows.
constexpr std::array<std::pair<std::string_view, std::array<int, 3>>, 15> namedColours{{{"white", {255, 255, 255}},
                                                                                        {"black", {0, 0, 0}},
                                                                                        {"red", {255, 0, 0}},
                                                                                        {"green", {0, 255, 0}},
                                                                                        {"blue", {0, 0, 255}},
                                                                                        {"yellow", {255, 255, 0}},
                                                                                        {"magenta", {255, 0, 255}},
                                                                                        {"cyan", {0, 255, 255}},
                                                                                        {"aqua", {0, 191, 191}},
                                                                                        {"grey", {191, 191, 191}},
                                                                                        {"gray", {191, 191, 191}},
                                                                                        {"orange", {255, 127, 0}},
                                                                                        {"brown", {191, 127, 63}},
                                                                                        {"purple", {127, 0, 255}},
                                                                                        {"violet", {127, 0, 255}}}};

std::string lowered(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// What lies between any of the separators.
std::vector<std::string_view> split(std::string_view text, std::string_view separators) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t first = text.find_first_not_of(separators);
    if (first == std::string_view::npos) {
      return parts;
    }
    const std::size_t end = std::min(text.find_first_of(separators, first), text.size());
    parts.push_back(text.substr(first, end - first));
    text.remove_prefix(end);
  }
}

std::optional<double> numberOf(std::string_view word) {
  double number = 0.0;
  word.remove_prefix(word.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool whole = error == std::errc() && end == word.data() + word.size() && std::isfinite(number);
  return whole ? std::optional(number) : std::nullopt;
}

std::optional<double> valueOf(std::string_view word, const glm::dvec2& range) {
  if (!word.ends_with('%')) {
    return numberOf(word);
  }
  word.remove_suffix(1);
  const std::optional<double> part = numberOf(word);
  return part ? std::optional(range.x + (range.y - range.x) * *part / 100.0) : std::nullopt;
}

std::optional<glm::dvec4> colourOf(const std::vector<std::string_view>& words) {
  if (words.size() == 2) {
    const auto named = std::find_if(namedColours.begin(), namedColours.end(),
                                    [name = lowered(words[1])](const auto& one) { return one.first == name; });
    if (named == namedColours.end()) {
      return std::nullopt;
    }
    const auto& [red, green, blue] = named->second;
    return glm::dvec4(red, green, blue, 255.0) / 255.0;
  }
  if (words.size() != 4 && words.size() != 5) {
    return std::nullopt;
  }
  glm::dvec4 colour(255.0);
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::optional<double> component = numberOf(words[i]);
    if (!component || *component < 0.0 || *component > 255.0) {
      return std::nullopt;
    }
    colour[static_cast<int>(i) - 1] = *component;
  }
  return colour / 255.0;
}

}  // namespace

Result<ColourRamp> readColourRamp(std::string_view text, const glm::dvec2& range) {
  ColourRamp ramp;
  for (const std::string_view line : split(text, "\r\n;")) {
    const std::vector<std::string_view> words = split(line, " \t,:");
    // QGIS puts a line of its own, INTERPOLATION:INTERPOLATED, before the others.
    if (words.empty() || words[0].starts_with('#') || lowered(words[0]) == "nv" ||
        lowered(words[0]) == "interpolation") {
      continue;
    }
    const std::optional<double> value = valueOf(words[0], range);
    const std::optional<glm::dvec4> colour = colourOf(words);
    if (!value || !colour) {
      return failure(fmt::format("\"{}\" is not a value and its colour", line), {},
                     "write for example 1500 240 220 180, or 50% white");
    }
    ramp.stops.push_back({*value, *colour});
  }
  if (ramp.stops.empty() || ramp.stops.size() > ColourRamp::mostStops) {
    return failure(
        fmt::format("a colour ramp has 1 to {} stops, this one {}", ColourRamp::mostStops, ramp.stops.size()));
  }
  std::stable_sort(ramp.stops.begin(), ramp.stops.end(),
                   [](const auto& a, const auto& b) { return a.value < b.value; });
  return ramp;
}

}  // namespace meridian::globebrowsing
