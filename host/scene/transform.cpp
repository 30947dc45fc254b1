#include "host/scene/transform.h"

#include <glm/matrix.hpp>

namespace meridian::scene {

glm::dmat4 Transform::matrix() const {
  glm::dmat4 matrix(rotation * scale);
  matrix[3] = glm::dvec4(translation, 1.0);
  return matrix;
}

Transform Transform::inverse() const {
  Transform result;
  result.scale = 1.0 / scale;
  result.rotation = glm::transpose(rotation);
  result.translation = -(result.rotation * translation) * result.scale;
  return result;
}

Transform operator*(const Transform& left, const Transform& right) {
  return {left.point(right.translation), left.rotation * right.rotation, left.scale * right.scale};
}

}  // namespace meridian::scene
