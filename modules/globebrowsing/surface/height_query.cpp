#include "globebrowsing/surface/height_query.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

namespace meridian::globebrowsing {

namespace {

/// Where the ray (unit direction) is within the sphere of that radius about the origin; in front only.
std::optional<std::pair<double, double>> within(double radius, const glm::dvec3& origin, const glm::dvec3& direction) {
  const double along = -glm::dot(origin, direction);
  const double closest = glm::dot(origin, origin) - along * along;
  const double half = radius * radius - closest;
  if (half < 0.0 || along + std::sqrt(half) < 0.0) {
    return std::nullopt;
  }
  return std::pair(std::max(0.0, along - std::sqrt(half)), along + std::sqrt(half));
}

}  // namespace

double heightAt(const SurfaceStore& surfaces, const Tiling& tiling, double latitude, double longitude) {
  for (int level = surfaces.deepestLevel(); level >= 0; --level) {
    const TilePlace place = tiling.locate(latitude, longitude, level);
    if (const ChunkSurface* surface = surfaces.findInForce(place.index)) {
      return surface->heightAt(place.uv);
    }
  }
  return 0.0;
}

std::optional<glm::dvec3> pick(const SurfaceStore& surfaces, const Tiling& tiling, const glm::dvec3& origin,
                               const glm::dvec3& direction) {
  const double length = glm::length(direction);
  if (!(length > 0.0) || !std::isfinite(length) || !std::isfinite(glm::length(origin))) {
    return std::nullopt;
  }
  const glm::dvec3 unit = direction / length;
  const auto clearance = [&](double t) {
    const GeodeticPosition place = tiling.ellipsoid().geodetic(origin + unit * t);
    return place.height - heightAt(surfaces, tiling, place.latitude, place.longitude);
  };
  const auto reach = within(tiling.ellipsoid().maximumRadius() + surfaces.highestHeight(), origin, unit);
  if (!reach) {
    return std::nullopt;
  }
  auto [near, far] = *reach;
  const double smallest = (far - near) * 1e-3;
  double before = near;
  double t = near;
  // No slope is steeper than 1 in 1 for long: half the clearance is a safe stride.
  while (t <= far) {
    const double above = clearance(t);
    if (above <= 0.0) {
      break;
    }
    before = t;
    t += std::max(0.5 * above, std::min(smallest, 1e-4 * t + 1.0));
  }
  if (t > far) {
    return std::nullopt;
  }
  for (int i = 0; i < 60 && t - before > 1e-9 * t; ++i) {
    const double middle = 0.5 * (before + t);
    (clearance(middle) > 0.0 ? before : t) = middle;
  }
  return origin + unit * t;
}

}  // namespace meridian::globebrowsing
