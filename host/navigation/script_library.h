#pragma once

#include <vector>

#include "host/api/script_library.h"
#include "host/navigation/camera.h"
#include "host/navigation/orbit_navigator.h"

namespace meridian::navigation {

/// `openspace.navigation.*`: jumpToGeo, localPositionFromGeo, setNavigationState, jumpToNavigationState,
/// getNavigationState, setFocus, retargetAnchor, jumpTo, distanceToFocus, distanceToFocusBoundingSphere,
/// distanceToFocusInteractionSphere. Both outlive the library. Degrees, as OpenSpace has them.
[[nodiscard]] ScriptLibrary navigationLibrary(Camera& camera, OrbitNavigator& navigator);

/// The older names of the same: `openspace.globebrowsing.jumpToGeo` and so on, which the module does not have.
/// jumpToGeo without a globe takes the anchor, as goToGeo did.
[[nodiscard]] std::vector<ScriptFunction> geoFunctions(Camera& camera, OrbitNavigator& navigator);

}  // namespace meridian::navigation
