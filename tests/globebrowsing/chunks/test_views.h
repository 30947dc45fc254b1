#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "globebrowsing/chunks/selection.h"
#include "globebrowsing/geodesy/ellipsoid.h"

namespace meridian::globebrowsing {

inline Ellipsoid testEarth() {
  return *Ellipsoid::fromRadii({6378137.0, 6378137.0, 6356752.314245});
}

/// 1280 x 720 with 50 degrees from top to bottom, reversed depth, infinite far plane.
inline SelectionView testView(const glm::dvec3& position, const glm::dvec3& ahead) {
  constexpr double tangent = 0.4663076581549986;
  constexpr double aspect = 1280.0 / 720.0;
  constexpr double near = 0.1;
  glm::dmat4 clipFromCamera(0.0);
  clipFromCamera[0][0] = 1.0 / (tangent * aspect);
  clipFromCamera[1][1] = 1.0 / tangent;
  clipFromCamera[2][3] = -1.0;
  clipFromCamera[3][2] = near;
  const glm::dvec3 up =
      std::abs(glm::normalize(ahead).z) > 0.99 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 0.0, 1.0);
  SelectionView view;
  view.cameraPosition = position;
  view.clipFromModel = clipFromCamera * glm::lookAt(position, position + ahead, up);
  view.pixelsPerRadian = 360.0 / tangent;
  return view;
}

/// Above that place, looking down by `pitch` (radians below the horizon) along a heading.
inline SelectionView viewAbove(const Ellipsoid& ellipsoid, const GeodeticPosition& place, double heading,
                               double pitch) {
  const glm::dvec3 up = ellipsoid.normal(place.latitude, place.longitude);
  const glm::dvec3 east(-std::sin(place.longitude), std::cos(place.longitude), 0.0);
  const glm::dvec3 north = glm::cross(up, east);
  const glm::dvec3 level = std::cos(heading) * north + std::sin(heading) * east;
  return testView(ellipsoid.cartesian(place), std::cos(pitch) * level - std::sin(pitch) * up);
}

inline bool shows(const SelectionView& view, const glm::dvec3& position) {
  const glm::dvec4 clip = view.clipFromModel * glm::dvec4(position, 1.0);
  return clip.w > 0.0 && std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w && clip.z < clip.w;
}

}  // namespace meridian::globebrowsing
