#pragma once

#include <memory>

#include "host/scene/node_transforms.h"

namespace meridian::scene {

/// GlobeTranslation {Globe, Latitude, Longitude (degrees), Altitude (metres over the ellipsoid), UseHeightmap (over the
/// terrain instead, as far as that is loaded), UseCamera, UseCameraAltitude}: a place in that globe's frame, for nodes
/// whose parent it is. With UseCamera, latitude and longitude are those of the eye. Without such a globe: the origin.
[[nodiscard]] Result<std::unique_ptr<Translation>> makeGlobeTranslation(const TransformRequest& request);

/// GlobeRotation {Globe, Latitude, Longitude, Angle (degrees about the vertical), UseHeightmap (accepted; the
/// ellipsoid's vertical is taken), UseCamera}: +y is up, +x east and +z south there.
[[nodiscard]] Result<std::unique_ptr<Rotation>> makeGlobeRotation(const TransformRequest& request);

}  // namespace meridian::scene
