#pragma once

#include <string_view>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "host/api/error.h"

namespace meridian::globebrowsing {

/// Colours by value (metres, degrees): linear between two stops, the first and the last beyond them.
struct ColourRamp {
  struct Stop {
    double value = 0.0;
    glm::dvec4 colour{0.0};  ///< red, green, blue, alpha, 0 to 1; not premultiplied
  };
  std::vector<Stop> stops;  ///< at least one, values ascending; of two with one value the first ends what is below

  static constexpr std::size_t mostStops = 256;
};

/// Reads what `gdaldem color-relief` takes: on each line (here a semicolon ends one as well) a value, and a colour as
/// red, green, blue and perhaps alpha of 0 to 255, or as a name ("navy" is none of them); commas, colons, tabs and
/// spaces between. A value with % is that part of `range`. Lines that begin with #, and nv (no data), are left out.
/// Errors: the line that is wrong and why; no stop at all, or more than mostStops.
[[nodiscard]] Result<ColourRamp> readColourRamp(std::string_view text, const glm::dvec2& range);

}  // namespace meridian::globebrowsing
