#pragma once

#include <optional>

#include <glm/vec3.hpp>

namespace meridian::globebrowsing {

/// Where a ray meets an ellipsoid centred on the origin: the least t >= 0 with origin + t * direction on its surface,
/// so from inside it is the way out. `direction` need not be of unit length; t counts in its lengths. Nothing when the
/// ray misses, when the direction is zero, or when anything is not finite or a semi-axis not positive.
///
/// Solved as a sphere in scaled space with the discriminant as the distance of the line from the centre, which keeps
/// its digits far away (Haines et al. 2019, "Precision Improvements for Ray/Sphere Intersection").
[[nodiscard]] std::optional<double> nearestHit(const glm::dvec3& origin, const glm::dvec3& direction,
                                               const glm::dvec3& radii);

}  // namespace meridian::globebrowsing
