#pragma once

#include <glm/vec3.hpp>

#include "host/api/error.h"
#include "host/api/geodetic_position.h"

namespace meridian::globebrowsing {

/// A reference ellipsoid with any three semi-axes. Model space: metres, origin at the centre, +z the north pole, +x the
/// prime meridian. Geodetic latitude and longitude are the angles of the outward surface normal, on triaxial bodies
/// too: normal = (cos lat cos lon, cos lat sin lon, sin lat).
///
/// cartesian() is the closed form r^2 n / |r n| + h n, on every ellipsoid. geodetic() of spheres and spheroids, oblate
/// or prolate, is GeographicLib::Geocentric's; of triaxial bodies it is Newton's method on the foot point. Accuracy:
/// 1e-8 m and 1e-12 rad within 5000 km of the surface of an Earth-sized spheroid. Degenerate input: at a pole the
/// longitude is 0; at the centre the answer is the end of the shortest axis; never not-a-number for finite input.
class Ellipsoid {
 public:
  static constexpr double leastRadius = 1e-3;     ///< metres
  static constexpr double greatestRadius = 1e15;  ///< metres; squares of squares of it are still numbers
  /// Errors: a semi-axis that is not between these.
  [[nodiscard]] static Result<Ellipsoid> fromRadii(const glm::dvec3& radii);

  [[nodiscard]] const glm::dvec3& radii() const { return radii_; }
  [[nodiscard]] double minimumRadius() const;
  [[nodiscard]] double maximumRadius() const;
  [[nodiscard]] bool isSphere() const { return radii_.x == radii_.y && radii_.x == radii_.z; }
  /// Rotationally symmetric about z (a sphere is one too).
  [[nodiscard]] bool isSpheroid() const { return radii_.x == radii_.y; }

  [[nodiscard]] glm::dvec3 normal(double latitude, double longitude) const;
  [[nodiscard]] glm::dvec3 cartesian(const GeodeticPosition& position) const;
  [[nodiscard]] GeodeticPosition geodetic(const glm::dvec3& position) const;

 private:
  explicit Ellipsoid(const glm::dvec3& radii) : radii_(radii) {}
  glm::dvec3 radii_;
};

}  // namespace meridian::globebrowsing
