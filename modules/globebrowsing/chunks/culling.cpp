#include "globebrowsing/chunks/culling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace meridian::globebrowsing {

Frustum::Frustum(const glm::dmat4& clipFromModel) {
  const glm::dmat4 rows = glm::transpose(clipFromModel);
  const std::array<glm::dvec4, 5> planes{rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1],
                                         rows[3] - rows[2]};
  for (const glm::dvec4& plane : planes) {
    const glm::dvec3 normal(plane.x, plane.y, plane.z);
    const double length = glm::length(normal);
    if (length > 0.0 && std::isfinite(length) && std::isfinite(plane.w)) {
      planes_[static_cast<std::size_t>(count_++)] = {normal / length, plane.w / length};
    }
  }
}

double Horizon::occluderScale(const glm::dvec3& radii, double lowestHeight) {
  const double height = std::isfinite(lowestHeight) ? std::min(lowestHeight, 0.0) : 0.0;
  return std::max(0.0, 1.0 + height / std::min({radii.x, radii.y, radii.z}));
}

Horizon::Horizon(const glm::dvec3& radii, double lowestHeight, const glm::dvec3& cameraPosition) {
  const double scale = occluderScale(radii, lowestHeight);
  if (scale <= 0.0) {
    return;
  }
  const glm::dvec3 scaled = cameraPosition / (radii * scale);
  const double length = glm::length(scaled);
  if (!(length > 1.0) || !std::isfinite(length)) {
    return;
  }
  active_ = true;
  direction_ = scaled / length;
  cosine_ = 1.0 / length;
  sine_ = std::sqrt((1.0 - cosine_) * (1.0 + cosine_));
}

HorizonCap Horizon::capOf(const ScaledCap& cap, double occluderScale) {
  if (occluderScale <= 0.0) {
    return {cap.direction, -1.0, 0.0};
  }
  const double radius = cap.greatestRadius / occluderScale;
  const double half = cap.angle + (radius > 1.0 ? std::acos(1.0 / radius) : 0.0);
  if (half >= std::numbers::pi) {
    return {cap.direction, -1.0, 0.0};
  }
  return {cap.direction, std::cos(half), std::sin(half)};
}

}  // namespace meridian::globebrowsing
