#pragma once

#include <memory>

#include "host/scene/node_transforms.h"

namespace meridian::scene {

/// FixedRotation {Attached, XAxis, XAxisOrthogonal, XAxisInvert, and the same of Y and Z}: axes that point in given
/// directions (three numbers, in the parent's frame) or at other nodes (their identifiers) as seen from the node
/// `Attached`, which is the node itself when absent. Two axes suffice, one is completed arbitrarily. An orthogonal axis
/// is turned until it is perpendicular to the other one that is given. Axes that span no frame give no rotation.
[[nodiscard]] Result<std::unique_ptr<Rotation>> makeFixedRotation(const TransformRequest& request);

}  // namespace meridian::scene
