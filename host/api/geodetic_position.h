#pragma once

namespace meridian {

/// A place on or above a globe. Latitude is geodetic (the normal's angle to the equator), -pi/2..pi/2 radians;
/// longitude is east-positive, -pi..pi radians; height is metres above the reference ellipsoid.
struct GeodeticPosition {
  double latitude = 0.0;
  double longitude = 0.0;
  double height = 0.0;
};

}  // namespace meridian
