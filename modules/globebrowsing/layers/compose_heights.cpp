#include "globebrowsing/layers/compose_heights.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace meridian::globebrowsing {

namespace {

void layOver(std::vector<double>& heights, const HeightPart& part) {
  assert(part.pixels->metres.size() == heights.size());
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double metres = static_cast<double>(part.pixels->metres[i]);
    const double layer = applySettings(metres, part.settings);
    if (std::isfinite(metres) && std::isfinite(layer)) {  // a gamma of 0 makes a number of anything
      heights[i] += (layer - heights[i]) * part.opacity;
    }
  }
}

}  // namespace

ComposedHeights composeHeights(std::span<const HeightPart> parts, const TileLayout& layout) {
  const auto size = static_cast<std::size_t>(layout.size());
  std::vector<double> heights(size * size, 0.0);
  for (const HeightPart& part : parts) {
    if (part.pixels != nullptr && !part.pixels->metres.empty()) {
      layOver(heights, part);
    }
  }
  ComposedHeights composed;
  composed.metres.resize(heights.size());
  std::transform(heights.begin(), heights.end(), composed.metres.begin(), [](double height) {
    constexpr double largest = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(height, -largest, largest));
  });
  const auto border = static_cast<std::size_t>(layout.border);
  composed.minimum = std::numeric_limits<float>::max();
  composed.maximum = std::numeric_limits<float>::lowest();
  for (std::size_t row = border; row < size - border; ++row) {
    const auto first = composed.metres.begin() + static_cast<std::ptrdiff_t>(row * size + border);
    const auto [least, greatest] = std::minmax_element(first, first + layout.interior);
    composed.minimum = std::min(composed.minimum, *least);
    composed.maximum = std::max(composed.maximum, *greatest);
  }
  return composed;
}

}  // namespace meridian::globebrowsing
