#pragma once

#include <cstdint>
#include <span>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "host/api/time.h"

namespace meridian {

/// One eye or screen, as seen from one renderable: the host gives every renderable its own Views, made through the
/// nearest common ancestor of camera and node, never through world coordinates.
///
/// Camera space: metres, origin at the eye, -z ahead, +y up. Clip space: depth reversed, 1 at the near plane, 0 at
/// infinity (glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE), depth test GL_GREATER).
struct View {
  glm::ivec2 size{0};  ///< pixels
  glm::dmat4 clipFromCamera{1.0};
  glm::dmat4 cameraFromModel{1.0};
  glm::dvec3 cameraPosition{0.0};            ///< of the eye, in model space, metres
  glm::dvec3 lightDirection{1.0, 0.0, 0.0};  ///< unit, in model space, towards the light source
  double pixelsPerRadian = 0.0;              ///< at the middle of the picture
};

/// One frame: one time, one or several views. The same for update and draw.
struct FrameContext {
  Time time;
  double deltaSeconds = 0.0;  ///< of simulation time since the last frame
  double wallSeconds = 0.0;   ///< real (or, at a fixed time step, frame) seconds since start
  std::uint64_t number = 0;
  std::span<const View> views;  ///< valid during the call that gets it
};

}  // namespace meridian
