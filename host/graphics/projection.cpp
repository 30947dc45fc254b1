#include "host/graphics/projection.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace meridian::graphics {

glm::dmat4 reversedInfinitePerspective(double verticalFieldOfView, double aspect, double near) {
  assert(verticalFieldOfView > 0.0 && verticalFieldOfView < std::numbers::pi);
  assert(std::isfinite(aspect) && aspect > 0.0);
  assert(std::isfinite(near) && near > 0.0);
  const double scale = 1.0 / std::tan(0.5 * verticalFieldOfView);
  glm::dmat4 matrix(0.0);
  matrix[0][0] = scale / aspect;
  matrix[1][1] = scale;
  matrix[2][3] = -1.0;
  matrix[3][2] = near;
  return matrix;
}

double pixelsPerRadian(double verticalFieldOfView, double heightPixels) {
  assert(verticalFieldOfView > 0.0 && verticalFieldOfView < std::numbers::pi);
  return 0.5 * heightPixels / std::tan(0.5 * verticalFieldOfView);
}

}  // namespace meridian::graphics
