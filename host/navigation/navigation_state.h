#pragma once

#include <optional>
#include <string>

#include <glm/vec3.hpp>

#include "host/api/error.h"
#include "host/api/time.h"
#include "host/api/value.h"
#include "host/navigation/camera.h"

namespace meridian::navigation {

/// OpenSpace's description of a camera. The camera looks from `position` at the anchor (or the aim), with `up` up, then
/// turned by yaw (to the right) and pitch (upwards), radians.
struct NavigationState {
  std::string anchor;
  std::string aim{};             ///< empty: the anchor
  std::string referenceFrame{};  ///< the node along whose axes position and up are given; empty: the anchor
  glm::dvec3 position{0.0};      ///< metres from the anchor's origin
  std::optional<glm::dvec3> up{};
  double yaw = 0.0;
  double pitch = 0.0;
  std::optional<Time> timestamp{};

  /// Errors: bad keys, values that are not finite, a timestamp that is no date.
  [[nodiscard]] static Result<NavigationState> fromValue(const Value& value, std::string_view where);
  [[nodiscard]] Value toValue() const;
};

/// Of the camera as it is; `referenceFrame` empty: the anchor's axes. Errors: no such node.
[[nodiscard]] Result<NavigationState> navigationState(const Camera& camera, std::string_view referenceFrame = {});
/// Errors: a node that is not there; a position at what is looked at. The timestamp is left to the caller.
[[nodiscard]] Result<void> setNavigationState(Camera& camera, const NavigationState& state);

}  // namespace meridian::navigation
