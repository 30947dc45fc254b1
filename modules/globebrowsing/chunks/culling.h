#pragma once

#include <array>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "globebrowsing/chunks/chunk_bounds.h"

namespace meridian::globebrowsing {

/// The part of model space that a view shows: four side planes and the near plane; with reversed depth and an infinite
/// far plane there is no fifth. Planes that the matrix leaves undefined hold everything.
class Frustum {
 public:
  Frustum() = default;
  explicit Frustum(const glm::dmat4& clipFromModel);

  /// False only when the whole box lies outside one of the planes.
  [[nodiscard]] bool touches(const OrientedBox& box) const {
    for (int i = 0; i < count_; ++i) {
      const Plane& plane = planes_[static_cast<std::size_t>(i)];
      double reach = plane.offset;
      for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3& direction = box.axes[static_cast<std::size_t>(axis)];
        const double along = plane.normal.x * direction.x + plane.normal.y * direction.y + plane.normal.z * direction.z;
        reach += box.half[axis] * (along < 0.0 ? -along : along);
      }
      reach += plane.normal.x * box.centre.x + plane.normal.y * box.centre.y + plane.normal.z * box.centre.z;
      if (reach < 0.0) {
        return false;
      }
    }
    return true;
  }

 private:
  struct Plane {
    glm::dvec3 normal{0.0};  ///< unit, inward
    double offset = 0.0;
  };
  std::array<Plane, 5> planes_{};
  int count_ = 0;
};

/// The part of the globe that a tile hides from a camera at a horizon, ready to be compared with it: half the angle of
/// the cap of the occluder that could still see some of the tile's surface.
struct HorizonCap {
  glm::dvec3 direction{0.0, 0.0, 1.0};
  double cosine = -1.0;  ///< of the half angle
  double sine = 0.0;
};

/// Culling of what lies behind the globe itself, in the space where the occluder is the unit sphere (Cozzi & Ring 2011,
/// "3D Engine Design for Virtual Globes", section 12.3, with caps in place of points).
///
/// The occluder is the ellipsoid scaled by 1 + h_min / r_min, where h_min <= 0 is the least height drawn anywhere.
/// Along every normal n that lies |r n| * |h_min| / r_min >= |h_min| below the ellipsoid, so no drawn surface reaches
/// into it, on triaxial bodies neither. A point of scaled radius s sees the occluder's cap of half angle acos(1 / s)
/// around it; two points see each other exactly when their caps meet. A tile within `angle` of a direction and within
/// `s` thus needs a cap of angle + acos(1 / s).
class Horizon {
 public:
  /// `lowestHeight` above 0 or not finite counts as 0. It hides nothing when the occluder vanishes or the camera is
  /// inside it.
  Horizon(const glm::dvec3& radii, double lowestHeight, const glm::dvec3& cameraPosition);

  /// The occluder's size as a fraction of the ellipsoid's; 0 when nothing is left.
  [[nodiscard]] static double occluderScale(const glm::dvec3& radii, double lowestHeight);
  [[nodiscard]] static HorizonCap capOf(const ScaledCap& cap, double occluderScale);

  [[nodiscard]] bool hides(const HorizonCap& cap) const {
    if (!active_) {
      return false;
    }
    // cos and sin of the sum of both half angles; beyond pi the caps meet whatever lies between them.
    const double sine = sine_ * cap.cosine + cosine_ * cap.sine;
    const double cosine = cosine_ * cap.cosine - sine_ * cap.sine;
    const double between =
        direction_.x * cap.direction.x + direction_.y * cap.direction.y + direction_.z * cap.direction.z;
    return sine > 0.0 && between < cosine - rounding;
  }

 private:
  static constexpr double rounding = 1e-14;
  bool active_ = false;
  glm::dvec3 direction_{0.0, 0.0, 1.0};
  double cosine_ = 1.0;
  double sine_ = 0.0;
};

}  // namespace meridian::globebrowsing
