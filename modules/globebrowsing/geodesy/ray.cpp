#include "globebrowsing/geodesy/ray.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace meridian::globebrowsing {

std::optional<double> nearestHit(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& radii) {
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(origin[i]) || !std::isfinite(direction[i]) || !(radii[i] > 0.0)) {
      return std::nullopt;
    }
  }
  const glm::dvec3 start = origin / radii;
  const glm::dvec3 way = direction / radii;
  const double length = glm::length(way);
  if (!(length > 0.0) || !std::isfinite(length)) {
    return std::nullopt;
  }
  const glm::dvec3 unit = way / length;
  const double toMiddle = -glm::dot(start, unit);
  const glm::dvec3 middle = start + toMiddle * unit;
  const double discriminant = 1.0 - glm::dot(middle, middle);
  if (!(discriminant >= 0.0)) {
    return std::nullopt;
  }
  const double half = std::sqrt(discriminant);
  // The product of both solutions; the one that would cancel is had from the other.
  const double outside = glm::dot(start, start) - 1.0;
  const double larger = toMiddle >= 0.0 ? toMiddle + half : toMiddle - half;
  const double other = larger != 0.0 ? outside / larger : 0.0;
  const double near = std::min(larger, other);
  const double far = std::max(larger, other);
  if (far < 0.0) {
    return std::nullopt;
  }
  return (near >= 0.0 ? near : far) / length;
}

}  // namespace meridian::globebrowsing
