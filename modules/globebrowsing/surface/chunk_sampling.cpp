#include "globebrowsing/surface/chunk_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>

#include "globebrowsing/source/tile_layout.h"

namespace meridian::globebrowsing {

namespace {

/// Tiles that touch a pole taper to nothing; in the others the wider edge is at most about twice the narrower.
constexpr double polarTaper = 0.9;

/// North to south, as if seen from straight above.
double texelsPerPixel(double texels, const ChunkSurface& surface, const SelectedChunk& chunk, const View& view) {
  const double meridian = glm::distance(surface.corners()[0], surface.corners()[2]);
  return texels * chunk.distance / (meridian * view.pixelsPerRadian);
}

/// The half-size level whose texels are nearest to a pixel apart.
int nearestLevel(double texelsPerPixel, int levels) {
  return static_cast<int>(std::lround(std::log2(std::clamp(texelsPerPixel, 1.0, std::ldexp(1.0, levels - 1)))));
}

/// Texels that a pixel spans along the slant, where they are fewest in the chunk and where they are most, as if its
/// shortest edge lay along the slant. Both grow with the distance from the point below the eye; infinite where the
/// surface faces away.
struct TexelsPerPixel {
  double least = 0.0;
  double most = 0.0;
};

TexelsPerPixel slantedTexelsPerPixel(double texels, const ChunkSurface& surface, const SelectedChunk& chunk,
                                     const View& view) {
  const auto& corners = surface.corners();
  const double edge = std::min({glm::distance(corners[0], corners[1]), glm::distance(corners[0], corners[2]),
                                glm::distance(corners[2], corners[3]), glm::distance(corners[1], corners[3])});
  const double eye = glm::length(view.cameraPosition);
  const auto at = [&](double distance, double radius) {
    // Of the triangle from the body's centre to the eye and to a point of its surface.
    const double cosine = ((eye - radius) * (eye + radius) - distance * distance) / (2.0 * radius * distance);
    return cosine > 0.0 ? texels * distance / (std::min(cosine, 1.0) * edge * view.pixelsPerRadian)
                        : std::numeric_limits<double>::infinity();
  };
  double leastRadius = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (const glm::dvec3& corner : corners) {
    const double radius = glm::length(corner);
    leastRadius = std::min(leastRadius, radius);
    most = std::max(most, at(glm::distance(view.cameraPosition, corner), radius));
  }
  return {at(chunk.distance, leastRadius), most};
}

}  // namespace

Composer::Sampling samplingOf(const ChunkSurface& surface, const SelectedChunk& chunk, const View& view) {
  using Kind = Composer::Sampling::Kind;
  constexpr double mostPolarTexelsPerPixel = 3.0;  // one that is shown much smaller needs all levels
  // It may draw an ancestor's composite, of which it is a part.
  const double texels = std::ldexp(colourLayout.interior, chunk.colourLevel - chunk.index.level);
  if (std::abs(surface.taper()) > polarTaper) {
    return {texelsPerPixel(texels, surface, chunk, view) < mostPolarTexelsPerPixel ? Kind::Polar : Kind::Plain};
  }
  const TexelsPerPixel slanted = slantedTexelsPerPixel(texels, surface, chunk, view);
  // Nothing may be blurred where texels are fewest, and where they are most a pixel may pass over every other one: a
  // bilinear fetch spans two.
  const int level = nearestLevel(slanted.least, Composer::levelCount);
  if (slanted.most > std::ldexp(4.0, level)) {
    return {Kind::Plain};
  }
  return {Kind::OneLevel, static_cast<std::uint8_t>(level)};
}

int normalLevel(const ChunkSurface& surface, const SelectedChunk& chunk, const View& view) {
  return nearestLevel(texelsPerPixel(ChunkSurface::nodes - 1, surface, chunk, view), NormalImage::levels);
}

}  // namespace meridian::globebrowsing
