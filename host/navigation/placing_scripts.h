#pragma once

#include <vector>

#include "host/api/script_library.h"
#include "host/navigation/camera.h"
#include "host/navigation/orbit_navigator.h"
#include "host/scene/scene.h"

namespace meridian::navigation {

/// Of `openspace.globebrowsing.*`, what concerns nodes and the camera over globes: setNodePosition(node, globe,
/// latitude, longitude, altitude?), setNodePositionFromCamera(node, useAltitude?), geoPositionForCamera(useEye?) (and
/// its older name getGeoPositionForCamera), goToChunk(globe, x, y, level). Degrees and metres. All of them outlive the
/// functions.
[[nodiscard]] std::vector<ScriptFunction> placingFunctions(scene::Scene& scene, Camera& camera,
                                                           OrbitNavigator& navigator);

}  // namespace meridian::navigation
