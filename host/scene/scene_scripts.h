#pragma once

#include "host/api/script_library.h"
#include "host/scene/scene.h"

namespace meridian::scene {

/// `openspace.*`: sceneGraphNodes, nodeByRenderableType, setParent, boundingSphere, interactionSphere, worldPosition,
/// worldRotation (9 numbers by columns). Lengths in metres. The scene outlives the library.
[[nodiscard]] ScriptLibrary sceneLibrary(Scene& scene);

}  // namespace meridian::scene
