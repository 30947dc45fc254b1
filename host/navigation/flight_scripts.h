#pragma once

#include "host/api/script_library.h"
#include "host/navigation/flight.h"

namespace meridian::navigation {

/// `openspace.navigation.*` that moves the camera over a time: flyTo, flyToHeight, flyToGeo, flyToGeo2,
/// flyToNavigationState, zoomToFocus, zoomToDistance, zoomToDistanceRelative, isFlying; and one push of the camera
/// each: addGlobalRotation, addLocalRotation, addTruckMovement, addLocalRoll, addGlobalRoll. Paths are Flight's, not
/// those of OpenSpace; without a duration they take five seconds. All of them outlive the library.
[[nodiscard]] ScriptLibrary flightLibrary(Camera& camera, OrbitNavigator& navigator, Flight& flight);

/// `openspace.pathnavigation.*`: the same flights, as up to version 0.20, and createPath, pausePath, continuePath,
/// stopPath, skipToEnd.
[[nodiscard]] ScriptLibrary pathLibrary(Camera& camera, OrbitNavigator& navigator, Flight& flight);

}  // namespace meridian::navigation
