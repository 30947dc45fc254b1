#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "globebrowsing/gpu/surface_store.h"
#include "globebrowsing/tiling/tiling.h"

namespace meridian::globebrowsing {

/// Metres of the finest surface there is above the ellipsoid at that place (radians); 0 without one. Of one that shows
/// earlier heights only as long as it is in use.
[[nodiscard]] double heightAt(const SurfaceStore& surfaces, const Tiling& tiling, double latitude, double longitude);

/// The first point on the ray, in front of its origin, where it goes below heightAt; to a part in 1e9 of the distance.
/// Relief thinner than a thousandth of the ray's way through the relief may be missed.
[[nodiscard]] std::optional<glm::dvec3> pick(const SurfaceStore& surfaces, const Tiling& tiling,
                                             const glm::dvec3& origin, const glm::dvec3& direction);

}  // namespace meridian::globebrowsing
