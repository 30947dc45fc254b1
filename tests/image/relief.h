#pragma once

#include <functional>
#include <optional>

#include <glm/vec3.hpp>

// Rays and coordinates, worked out without the product's code.
namespace meridian::globebrowsing::test {

/// The foot of the perpendicular from a position onto the ellipsoid.
struct Foot {
  glm::dvec3 normal{0.0};  ///< unit, of the ellipsoid there
  double height = 0.0;     ///< metres above it
};
/// By Newton's method on the distance along the normal, which converges from above (Eberly 2013, "Distance from a point
/// to an ellipse, an ellipsoid, or a hyperellipsoid"). For positions farther from the centre than the evolute reaches.
[[nodiscard]] Foot footOf(const glm::dvec3& position, const glm::dvec3& radii);

/// The unit normal at a geodetic latitude and longitude in degrees.
[[nodiscard]] glm::dvec3 normalAt(double latitudeDegrees, double longitudeDegrees);
/// The point of the ellipsoid that has that normal, raised.
[[nodiscard]] glm::dvec3 positionOf(const glm::dvec3& normal, double height, const glm::dvec3& radii);

/// A surface over an ellipsoid.
struct Relief {
  glm::dvec3 radii{1.0};                                     ///< metres
  double highest = 0.0;                                      ///< metres above the ellipsoid, at least
  double steepest = 0.0;                                     ///< slope, at least
  std::function<double(const glm::dvec3& normal)> height{};  ///< where the ellipsoid's unit normal is that
};

/// The normal where the ray first meets the relief; `direction` is a unit vector. What comes as near to the ray as
/// `precision` times the distance counts as met.
[[nodiscard]] std::optional<glm::dvec3> firstHit(const Relief& relief, const glm::dvec3& origin,
                                                 const glm::dvec3& direction, double precision);

}  // namespace meridian::globebrowsing::test
