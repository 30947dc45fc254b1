#pragma once

#include <glm/vec3.hpp>

#include "host/api/error.h"
#include "host/api/time.h"

namespace meridian::ephemeris {

/// An elliptic orbit about the frame's origin. Angles in radians.
struct KeplerElements {
  double semiMajorAxis = 1.0;  ///< metres
  double eccentricity = 0.0;   ///< 0 <= e < 1
  double inclination = 0.0;
  double ascendingNode = 0.0;
  double argumentOfPeriapsis = 0.0;
  double meanAnomalyAtEpoch = 0.0;
  Time epoch{};
  double period = 1.0;  ///< seconds

  /// Errors: a value that is not finite, an axis or period that is not positive, an eccentricity outside 0 <= e < 1.
  [[nodiscard]] Result<void> validate() const;
};

/// The eccentric anomaly E with E - e sin E = M, in the same turn as M. 0 <= e < 1, M finite. Newton's method kept
/// inside the bracket [M - e, M + e]: converges for every eccentricity below 1, to the last bits of M.
[[nodiscard]] double eccentricAnomaly(double meanAnomaly, double eccentricity);

/// Metres, in the frame the elements are given in.
[[nodiscard]] glm::dvec3 position(const KeplerElements& elements, const Time& time);

}  // namespace meridian::ephemeris
