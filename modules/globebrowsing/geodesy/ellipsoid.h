#pragma once

#include <limits>

#include <glm/vec3.hpp>

#include "host/api/error.h"
#include "host/api/geodetic_position.h"

namespace meridian::globebrowsing {

/// Heights in metres, both ends included. Not-a-number is in no range.
struct HeightLimits {
  double least = -std::numeric_limits<double>::infinity();
  double greatest = std::numeric_limits<double>::infinity();
  [[nodiscard]] bool hold(double height) const { return height >= least && height <= greatest; }
};

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

  /// What may be a height above it: from the smallest radius below (a sphere's centre) to twice that above. The relief
  /// of Mars is 0.6 % of its radius, that of Vesta 10 %, and Kleopatra, as long as four times its width, reaches 1.3
  /// radii above a sphere of its mean radius. Beyond are values without data that nobody declared, wrong units, and
  /// heights stored as radii by a wrong scale.
  [[nodiscard]] HeightLimits heightLimits() const { return {-minimumRadius(), 2.0 * minimumRadius()}; }

  [[nodiscard]] glm::dvec3 normal(double latitude, double longitude) const;
  [[nodiscard]] glm::dvec3 cartesian(const GeodeticPosition& position) const;
  [[nodiscard]] GeodeticPosition geodetic(const glm::dvec3& position) const;

 private:
  explicit Ellipsoid(const glm::dvec3& radii) : radii_(radii) {}
  glm::dvec3 radii_;
};

}  // namespace meridian::globebrowsing
