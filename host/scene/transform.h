#pragma once

#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace meridian::scene {

/// A similarity: scale, then rotation, then translation. Metres, double.
struct Transform {
  glm::dvec3 translation{0.0};
  glm::dmat3 rotation{1.0};  ///< orthonormal
  double scale = 1.0;        ///< positive

  [[nodiscard]] glm::dvec3 point(const glm::dvec3& point) const { return translation + rotation * (scale * point); }
  [[nodiscard]] glm::dvec3 direction(const glm::dvec3& direction) const { return rotation * direction; }
  [[nodiscard]] glm::dmat4 matrix() const;
  [[nodiscard]] Transform inverse() const;
};

/// First `right`, then `left`.
[[nodiscard]] Transform operator*(const Transform& left, const Transform& right);

}  // namespace meridian::scene
