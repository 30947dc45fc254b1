#include "globebrowsing/geodesy/ellipsoid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <GeographicLib/Geocentric.hpp>
#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace meridian::globebrowsing {

namespace {

constexpr double halfPi = std::numbers::pi / 2.0;

/// The surface's normal (not of unit length) below a position, and the signed height above it.
struct Foot {
  glm::dvec3 normal{0.0};
  double height = 0.0;
};

/// The root s of sum (r_i p_i / (d_i + s))^2 = 1, where d_i = r_i^2 - r_min^2. The left side falls and is convex in s >
/// 0, and the start lies left of the root, so Newton's method climbs to it without overshooting.
double footParameter(const glm::dvec3& radii, const glm::dvec3& difference, const glm::dvec3& position) {
  double s = 0.0;
  for (int i = 0; i < 3; ++i) {
    s = std::max(s, radii[i] * position[i] - difference[i]);
  }
  constexpr int enough = 200;
  for (int iteration = 0; iteration < enough; ++iteration) {
    double value = -1.0;
    double slope = 0.0;
    for (int i = 0; i < 3; ++i) {
      if (position[i] == 0.0) {
        continue;
      }
      const double denominator = difference[i] + s;
      const double ratio = radii[i] * position[i] / denominator;
      value += ratio * ratio;
      slope -= 2.0 * ratio * ratio / denominator;
    }
    const double next = s - value / slope;
    if (!(next > s)) {
      break;
    }
    s = next;
  }
  return s;
}

/// The foot point on an ellipsoid whose greatest semi-axis is 1, for a position in the positive octant (Eberly 2013,
/// "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid", with the shortest axis as origin of the
/// parameter, so that nothing cancels near the centre).
Foot footOfUnitOctant(const glm::dvec3& radii, const glm::dvec3& position) {
  // On a tie the polar axis counts as the shortest.
  const int shortest = radii.z <= std::min(radii.x, radii.y) ? 2 : (radii.y <= radii.x ? 1 : 0);
  const double least = radii[shortest];
  const glm::dvec3 difference = (radii - least) * (radii + least);

  bool inPlane = true;
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (difference[i] > 0.0) {
      const double ratio = radii[i] * position[i] / difference[i];
      sum += ratio * ratio;
    } else {
      inPlane = inPlane && position[i] == 0.0;
    }
  }
  Foot foot;
  double s = 0.0;
  if (inPlane && sum <= 1.0) {
    // Inside the focal ellipse the nearest points lie symmetrically on both sides; the positive one is taken.
    for (int i = 0; i < 3; ++i) {
      foot.normal[i] = difference[i] > 0.0 ? position[i] / difference[i] : 0.0;
    }
    foot.normal[shortest] = std::sqrt(1.0 - sum) / least;
  } else {
    s = footParameter(radii, difference, position);
    for (int i = 0; i < 3; ++i) {
      foot.normal[i] = position[i] == 0.0 ? 0.0 : position[i] / (difference[i] + s);
    }
  }
  foot.height = (s - least * least) * glm::length(foot.normal);
  return foot;
}

Foot footOf(const glm::dvec3& radii, const glm::dvec3& position) {
  const double scale = std::max({radii.x, radii.y, radii.z});
  const glm::dvec3 unitPosition = position / scale;
  constexpr double far = 1e20;
  const double farthest = std::max({std::abs(unitPosition.x), std::abs(unitPosition.y), std::abs(unitPosition.z)});
  if (farthest > far) {
    const glm::dvec3 direction = unitPosition / farthest;
    return {direction, std::hypot(position.x, position.y, position.z)};
  }
  constexpr double nothing = 1e-150;
  glm::dvec3 octant = glm::abs(unitPosition);
  for (int i = 0; i < 3; ++i) {
    octant[i] = octant[i] < nothing ? 0.0 : octant[i];
  }
  Foot foot = footOfUnitOctant(radii / scale, octant);
  for (int i = 0; i < 3; ++i) {
    foot.normal[i] = std::copysign(foot.normal[i], octant[i] == 0.0 ? 1.0 : position[i]);
  }
  foot.height *= scale;
  return foot;
}

}  // namespace

Result<Ellipsoid> Ellipsoid::fromRadii(const glm::dvec3& radii) {
  for (int i = 0; i < 3; ++i) {
    if (!(radii[i] >= leastRadius && radii[i] <= greatestRadius)) {
      return failure(
          fmt::format("the radii {}, {}, {} are no ellipsoid's that can be drawn", radii.x, radii.y, radii.z), {},
          fmt::format("give three lengths in metres, each between {} and {}", leastRadius, greatestRadius));
    }
  }
  return Ellipsoid(radii);
}

double Ellipsoid::minimumRadius() const {
  return std::min({radii_.x, radii_.y, radii_.z});
}

double Ellipsoid::maximumRadius() const {
  return std::max({radii_.x, radii_.y, radii_.z});
}

glm::dvec3 Ellipsoid::normal(double latitude, double longitude) const {
  // pi and pi / 2 are not representable, but the poles and the antimeridian are meant: all longitudes give the same
  // pole, and both ends of the antimeridian the same points, to the bit.
  const double cosLatitude = std::abs(latitude) == halfPi ? 0.0 : std::cos(latitude);
  const double sinLongitude = std::abs(longitude) == std::numbers::pi ? 0.0 : std::sin(longitude);
  return {cosLatitude * std::cos(longitude), cosLatitude * sinLongitude, std::sin(latitude)};
}

glm::dvec3 Ellipsoid::cartesian(const GeodeticPosition& position) const {
  const glm::dvec3 direction = normal(position.latitude, position.longitude);
  // The point of the surface with that normal, on any ellipsoid: r^2 n / |r n|.
  const glm::dvec3 scaled = radii_ * direction;
  return radii_ * scaled / glm::length(scaled) + position.height * direction;
}

GeodeticPosition Ellipsoid::geodetic(const glm::dvec3& position) const {
  constexpr double radiansPerDegree = std::numbers::pi / 180.0;
  GeodeticPosition result;
  if (isSpheroid()) {
    // A handful of operations make one, which is less than keeping it would cost every copy of an ellipsoid.
    const GeographicLib::Geocentric geocentric(radii_.x, (radii_.x - radii_.z) / radii_.x);
    geocentric.Reverse(position.x, position.y, position.z, result.latitude, result.longitude, result.height);
    result.latitude *= radiansPerDegree;
    result.longitude *= radiansPerDegree;
    return result;
  }
  const Foot foot = footOf(radii_, position);
  const double equatorial = std::hypot(foot.normal.x, foot.normal.y);
  result.latitude = std::atan2(foot.normal.z, equatorial);
  result.longitude = equatorial > 0.0 ? std::atan2(foot.normal.y, foot.normal.x) : 0.0;
  result.height = foot.height;
  return result;
}

}  // namespace meridian::globebrowsing
