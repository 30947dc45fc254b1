#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host/api/error.h"
#include "host/navigation/camera.h"
#include "host/navigation/geodetic_pose.h"

namespace meridian::app {

/// Anchors the camera at a node so that its bounding sphere fills most of the picture, seen from where the light comes
/// from but for a few tens of degrees, +z up. A node without a bounding sphere is seen from ten metres.
/// The scene has been evaluated. Errors: no such node.
[[nodiscard]] Result<void> showNode(navigation::Camera& camera, std::string_view node);

/// Where the camera is at the start: at `place` over the globe `anchor`; without a place it shows the anchor. An empty
/// anchor: the node that scripts have chosen by now, else the first globe, else the first node with a bounding sphere,
/// else the root; and without a place a camera that scripts have placed stays.
/// Errors: no such node; a place over a node that is no globe.
[[nodiscard]] Result<void> placeCamera(navigation::Camera& camera, const std::string& anchor,
                                       const std::optional<navigation::GeodeticPose>& place);

}  // namespace meridian::app
