#pragma once

#include "host/api/geodetic_position.h"
#include "host/api/ground.h"
#include "host/navigation/camera.h"

namespace meridian::navigation {

/// A camera over a globe, in radians.
struct GeodeticPose {
  GeodeticPosition position{};
  double heading = 0.0;  ///< clockwise from north: 0 north, pi/2 east
  double pitch = 0.0;    ///< above the horizon: 0 level, -pi/2 straight down (then `heading` is where up points)
  double roll = 0.0;     ///< of the camera to its right
};

/// In the globe's model space. At a pole north is the direction that its longitude gives it.
[[nodiscard]] Pose poseFromGeodetic(const Ground& ground, const GeodeticPose& pose);

/// The way back: heading in -pi..pi, pitch in -pi/2..pi/2; looking straight up or down the roll is 0 and the heading
/// that of the camera's up.
[[nodiscard]] GeodeticPose geodeticFromPose(const Ground& ground, const Pose& pose);

/// "LAT,LON,ALT[,HEADING,PITCH]" in degrees and metres above the ellipsoid, as on the command line. Without heading and
/// pitch: north is up, straight down (0, -90). Errors: not 3 or 5 finite numbers; latitude or pitch outside -90..90,
/// longitude outside -360..360.
[[nodiscard]] Result<GeodeticPose> geodeticPoseFromText(std::string_view text);

}  // namespace meridian::navigation
