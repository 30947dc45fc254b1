#include "globebrowsing/surface/chunk_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

namespace meridian::globebrowsing {

namespace {

/// Tiles that touch a pole taper to nothing; in the others the wider edge is at most about twice the narrower.
constexpr double polarTaper = 0.9;

constexpr std::size_t side = chunk_grid::side;
constexpr std::array<std::size_t, 4> cornerVertices{0, side - 1, side*(side - 1), side* side - 1};

/// North to south, as if seen from straight above.
double texelsPerPixel(double texels, const ChunkSurface& surface, const SelectedChunk& chunk, const View& view) {
  const double meridian = glm::distance(surface.corners()[0], surface.corners()[2]);
  return texels * chunk.distance / (meridian * view.pixelsPerRadian);
}

/// The half-size level whose texels are nearest to a pixel apart.
int nearestLevel(double texelsPerPixel, int levels) {
  // Also where it is not a number.
  return texelsPerPixel > 1.0
             ? static_cast<int>(std::lround(std::log2(std::min(texelsPerPixel, std::ldexp(1.0, levels - 1)))))
             : 0;
}

/// How many of the tile's edges a radian of the view spans along the slant (divided by pixels per radian: the share of
/// an edge that a pixel's longer side spans). At the least anywhere in the chunk, and at the most, which is infinite
/// where the surface faces away.
struct PixelSpan {
  double least = 0.0;
  double most = 0.0;
};

PixelSpan pixelSpan(const ChunkSurface& surface, const SelectedChunk& chunk, const View& view) {
  const auto& corners = surface.corners();
  const std::array<double, 4> edges{glm::distance(corners[0], corners[1]), glm::distance(corners[0], corners[2]),
                                    glm::distance(corners[2], corners[3]), glm::distance(corners[1], corners[3])};
  const auto [shorter, longer] = std::minmax_element(edges.begin(), edges.end());

  const HeightRange& heights = surface.heightRange();
  const ChunkSurface::NormalCone& cone = surface.normalCone();
  const glm::dvec3 middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]) +
                            0.5 * (heights.minimum + heights.maximum) * cone.axis;
  const glm::dvec3 towardsEye = view.cameraPosition - middle;
  const double middleDistance = glm::length(towardsEye);
  double radius = 0.0;
  PixelSpan span;
  for (std::size_t corner = 0; corner < corners.size(); ++corner) {
    const auto& [x, y, z] = surface.vertices()[cornerVertices[corner]].normal;
    const glm::dvec3 normal(x, y, z);
    // Relief may bring the ground nearer to the eye's height, which is then seen at a greater slant.
    for (const double height : {heights.minimum, heights.maximum}) {
      const glm::dvec3 point = corners[corner] + height * normal;
      const glm::dvec3 toEye = view.cameraPosition - point;
      const double cosine = glm::dot(normal, toEye) / glm::length(toEye);
      const double along = cosine > 0.0 ? glm::length(toEye) / cosine : std::numeric_limits<double>::infinity();
      span.most = std::max(span.most, along / *shorter);
      radius = std::max(radius, glm::distance(middle, point));
    }
  }
  // No point's slant is less than the middle's by more than its normal and its direction to the eye differ.
  const double slant = std::acos(std::clamp(glm::dot(cone.axis, towardsEye) / middleDistance, -1.0, 1.0)) - cone.angle -
                       std::asin(std::min(radius / middleDistance, 1.0));
  const double cosine = std::cos(std::clamp(slant, 0.0, std::numbers::pi / 2.0));
  span.least = chunk.distance * std::max(1.0 / *shorter, 1.0 / (*longer * cosine));
  return span;
}

}  // namespace

Composer::Sampling samplingOf(const ChunkSurface& surface, const SelectedChunk& chunk, const TexelsAcross& texels,
                              const View& view) {
  using Kind = Composer::Sampling::Kind;
  if (std::abs(surface.taper()) > polarTaper) {
    constexpr double mostPolarTexelsPerPixel = 3.0;  // one that is shown much smaller needs all levels
    return {texelsPerPixel(texels.most, surface, chunk, view) < mostPolarTexelsPerPixel ? Kind::Polar : Kind::Plain};
  }
  const PixelSpan span = pixelSpan(surface, chunk, view);
  // Nothing may be blurred where texels are fewest, and where they are most a pixel may pass over every other one: a
  // bilinear fetch spans two.
  const int level = nearestLevel(texels.fewest * span.least / view.pixelsPerRadian, Composer::levelCount);
  if (!(texels.most * span.most / view.pixelsPerRadian <= std::ldexp(4.0, level))) {
    return {Kind::Plain};
  }
  return {Kind::OneLevel, static_cast<std::uint8_t>(level)};
}

int normalLevel(const ChunkSurface& surface, const SelectedChunk& chunk, const View& view) {
  return nearestLevel(texelsPerPixel(ChunkSurface::nodes - 1, surface, chunk, view), NormalImage::levels);
}

}  // namespace meridian::globebrowsing
