#include "globebrowsing/layers/compose_heights.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace meridian::globebrowsing {

namespace {

/// An ancestor's heights at the tile's samples.
std::vector<float> enlarge(const std::vector<float>& metres, const UnitSquareTransform& within,
                           const TileLayout& layout) {
  const int size = layout.size();
  const auto side = static_cast<std::size_t>(size);
  const glm::dvec2 origin = layout.uv(0, 0);
  const auto place = [&](double unit, double first) {
    return std::clamp((unit - first) / layout.spacing(), 0.0, size - 1.0);
  };
  std::vector<float> enlarged;
  enlarged.reserve(metres.size());
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column < size; ++column) {
      const glm::dvec2 uv = within.apply(layout.uv(column, row));
      const double x = place(uv.x, origin.x);
      const double y = place(uv.y, origin.y);
      const auto left = std::min(static_cast<std::size_t>(x), side - 2);
      const auto top = std::min(static_cast<std::size_t>(y), side - 2);
      const auto at = [&](std::size_t dx, std::size_t dy) {
        return static_cast<double>(metres[(top + dy) * side + left + dx]);
      };
      const double right = x - static_cast<double>(left);
      const double upper = std::lerp(at(0, 0), at(1, 0), right);
      const double lower = std::lerp(at(0, 1), at(1, 1), right);
      enlarged.push_back(static_cast<float>(std::lerp(upper, lower, y - static_cast<double>(top))));
    }
  }
  return enlarged;
}

void layOver(std::vector<double>& heights, const HeightPart& part, const TileLayout& layout) {
  assert(part.pixels->metres.size() == heights.size());
  const bool isOwn = part.within == UnitSquareTransform{};
  const std::vector<float> enlarged = isOwn ? std::vector<float>() : enlarge(part.pixels->metres, part.within, layout);
  const std::vector<float>& all = isOwn ? part.pixels->metres : enlarged;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double metres = static_cast<double>(all[i]);
    const double layer = applySettings(metres, part.settings);
    if (std::isfinite(metres) && std::isfinite(layer)) {  // a gamma of 0 makes a number of anything
      heights[i] += (layer - heights[i]) * part.opacity;
    }
  }
}

}  // namespace

ComposedHeights composeHeights(std::span<const HeightPart> parts, const TileLayout& layout,
                               const HeightLimits& limits) {
  const auto size = static_cast<std::size_t>(layout.size());
  std::vector<double> heights(size * size, 0.0);
  for (const HeightPart& part : parts) {
    if (part.pixels != nullptr && !part.pixels->metres.empty()) {
      layOver(heights, part, layout);
    }
  }
  ComposedHeights composed;
  composed.metres.resize(heights.size());
  std::transform(heights.begin(), heights.end(), composed.metres.begin(), [&](double height) {
    constexpr double largest = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(height, std::max(limits.least, -largest), std::min(limits.greatest, largest)));
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
