#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace meridian::globebrowsing::test {

/// Of all pictures here, in pixels.
inline constexpr glm::ivec2 pictureSize{240, 135};

/// An eye in a globe's model space.
struct Eye {
  glm::dvec3 position{0.0};
  glm::dvec3 forward{0.0};
  glm::dvec3 up{0.0};
  double nearPlane = 0.1;            ///< metres
  double verticalFieldOfView = 0.9;  ///< radians

  /// The unit direction through a pixel's middle, or between those of several; rows count from the top.
  [[nodiscard]] glm::dvec3 through(double column, double row) const;
};

}  // namespace meridian::globebrowsing::test
