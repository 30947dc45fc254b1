#pragma once

#include <optional>
#include <string>

#include "host/api/error.h"
#include "host/navigation/camera.h"
#include "host/navigation/orbit_navigator.h"

namespace meridian::navigation {

/// A movement of the camera to a pose, in the frame of the node that is then its anchor: along a great circle about
/// that node, outwards on the way as far as it is long, the distance changing by equal factors in equal times, slow at
/// both ends. It knows of no obstacles; the navigator keeps it out of the anchor's terrain. Whatever stops the
/// navigator (the mouse, a jump) ends it.
class Flight {
 public:
  /// Both outlive it.
  Flight(Camera& camera, OrbitNavigator& navigator) : camera_(camera), navigator_(navigator) {}

  /// Seconds of frame time; 0 or less: at once. Errors: no such node; a pose that Camera::setPose refuses.
  Result<void> begin(const std::string& anchor, const Pose& target, double seconds);
  /// `seconds` of frame time have gone by. Once a frame, before the navigator's update.
  void advance(double seconds);
  void stop() { course_.reset(); }
  /// To its end at once.
  void skip();
  void setPaused(bool paused) { paused_ = paused; }
  [[nodiscard]] bool isFlying() const { return course_.has_value(); }

 private:
  struct Course {
    std::string anchor;
    Pose from;
    Pose to;
    double seconds;
    double elapsed;
    unsigned stops;  ///< of the navigator, when it began
  };
  Camera& camera_;
  OrbitNavigator& navigator_;
  std::optional<Course> course_;
  bool paused_ = false;
};

/// The pose at `share` (0 to 1) of the way.
[[nodiscard]] Pose poseBetween(const Pose& from, const Pose& to, double share);

}  // namespace meridian::navigation
