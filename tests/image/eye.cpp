#include "eye.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace meridian::globebrowsing::test {

glm::dvec3 Eye::through(double column, double row) const {
  const double scale = 2.0 * std::tan(0.5 * verticalFieldOfView) / pictureSize.y;
  const double right = (column + 0.5 - 0.5 * pictureSize.x) * scale;
  const double above = (0.5 * pictureSize.y - row - 0.5) * scale;
  return glm::normalize(forward + right * glm::cross(forward, up) + above * up);
}

}  // namespace meridian::globebrowsing::test
