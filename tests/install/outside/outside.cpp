#include <cstdio>
#include <numbers>

#include <glm/vec3.hpp>

#include "globebrowsing/geodesy/ellipsoid.h"

// Prints where 45 degrees north, 90 degrees east on the Earth's ellipsoid is, in metres.
int main() {
  using namespace meridian;
  const Result<globebrowsing::Ellipsoid> earth =
      globebrowsing::Ellipsoid::fromRadii({6378137.0, 6378137.0, 6356752.314245});
  if (!earth) {
    std::puts(earth.error().message().c_str());
    return 1;
  }
  const double degree = std::numbers::pi / 180.0;
  const glm::dvec3 place = earth->cartesian({45.0 * degree, 90.0 * degree, 0.0});
  const GeodeticPosition back = earth->geodetic(place);
  std::printf("%.3f %.3f %.3f\n", place.x, place.y, place.z);
  std::printf("%.9f %.9f\n", back.latitude / degree, back.longitude / degree);
}
