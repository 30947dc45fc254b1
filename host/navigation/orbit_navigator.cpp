#include "host/navigation/orbit_navigator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace meridian::navigation {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
/// How much of the height a drag over one picture height, or one notch, takes away (as a natural logarithm).
constexpr double zoomPerPicture = 3.0;
constexpr double zoomPerNotch = 0.2;
/// Farther than this nothing in the solar system is seen; a zoom ends here. Metres.
constexpr double farthestDistance = 1e18;
/// The part of the distance to a body without a known size that zooming never crosses. Metres.
constexpr double nearestDistance = 0.1;
/// A camera that was just put to its clearance may miss it by less than this, and is not moved by that. Metres.
constexpr double roundingOfHeights = 1e-3;

}  // namespace

OrbitNavigator::OrbitNavigator(Camera& camera) : PropertyOwner("Navigation"), camera_(camera) {
  addProperty(minimumClearance);
  addProperty(sensitivity);
  addProperty(friction);
}

void OrbitNavigator::drag(Motion motion, const glm::dvec2& delta) {
  if (!std::isfinite(delta.x) || !std::isfinite(delta.y)) {
    return;
  }
  ++stops_;
  const glm::dvec2 scaled = delta * sensitivity.get();
  switch (motion) {
    case Motion::Orbit:
      pending_.orbit += scaled;
      break;
    case Motion::Zoom:
      pending_.zoom += zoomPerPicture * scaled.y;
      break;
    case Motion::Tilt:
      pending_.tilt += scaled;
      break;
    case Motion::Roll:
      pending_.roll += scaled.x;
      break;
  }
}

void OrbitNavigator::scroll(double notches) {
  if (std::isfinite(notches)) {
    ++stops_;
    pending_.zoom += zoomPerNotch * sensitivity.get() * notches;
  }
}

void OrbitNavigator::stop() {
  ++stops_;
  pending_ = {};
  velocity_ = {};
}

void OrbitNavigator::update(double seconds) {
  if (!(seconds > 0.0) || !std::isfinite(seconds)) {
    keepClear();
    return;
  }
  const double time = friction.get();
  if (time > 0.0) {
    // Motion becomes velocity that decays by e in `time`: what is moved altogether is what was dragged.
    velocity_.orbit += pending_.orbit / time;
    velocity_.zoom += pending_.zoom / time;
    velocity_.tilt += pending_.tilt / time;
    velocity_.roll += pending_.roll / time;
    const double kept = std::exp(-seconds / time);
    const double moved = time * (1.0 - kept);
    apply({velocity_.orbit * moved, velocity_.zoom * moved, velocity_.tilt * moved, velocity_.roll * moved});
    velocity_ = {velocity_.orbit * kept, velocity_.zoom * kept, velocity_.tilt * kept, velocity_.roll * kept};
  } else {
    velocity_ = {};
    apply(pending_);
  }
  pending_ = {};
  keepClear();
}

void OrbitNavigator::apply(const Motions& motions) {
  if (motions.orbit != glm::dvec2(0.0)) {
    orbit(motions.orbit);
  }
  if (motions.zoom != 0.0) {
    zoom(motions.zoom);
  }
  if (motions.tilt != glm::dvec2(0.0) || motions.roll != 0.0) {
    turn(motions.tilt, motions.roll);
  }
}

double OrbitNavigator::height() const {
  const scene::SceneNode& anchor = camera_.anchor();
  const double scale = camera_.scene().worldFromNode(anchor).scale;
  const glm::dvec3 inModel = camera_.pose().position / scale;
  if (const Ground* ground = anchor.ground()) {
    const GeodeticPosition place = ground->geodetic(inModel);
    return scale * (place.height - ground->heightAt(place.latitude, place.longitude));
  }
  return scale * (glm::length(inModel) - anchor.boundingSphere());
}

void OrbitNavigator::orbit(const glm::dvec2& delta) {
  Pose pose = camera_.pose();
  const double distance = glm::length(pose.position);
  if (!(distance > 0.0)) {
    return;
  }
  // One picture height moves by what one picture height shows at the ground below, but never more than a quarter turn.
  const double fieldOfView = camera_.verticalFieldOfViewDegrees.get() * degree;
  const double shown = 2.0 * std::tan(0.5 * fieldOfView) * std::max(height(), minimumClearance.get());
  const double groundDistance = std::max(distance - height(), 1e-6 * distance);
  const double turn = std::min(shown / groundDistance, 0.5 * std::numbers::pi);
  const glm::dvec3 outward = pose.position / distance;
  // The pointer's directions, laid onto the sphere: when looking level, up in the picture is ahead.
  glm::dvec3 right = pose.rotation * glm::dvec3(1.0, 0.0, 0.0);
  right -= glm::dot(right, outward) * outward;
  if (!(glm::length(right) > 1e-6)) {
    right = pose.up() - glm::dot(pose.up(), outward) * outward;
  }
  right = glm::normalize(right);
  const glm::dvec3 forward = glm::cross(outward, right);
  const glm::dvec2 angle = delta * turn;
  const double size = glm::length(angle);
  const glm::dvec3 axis = glm::normalize(-angle.x * forward - angle.y * right);
  const glm::dquat rotation = glm::angleAxis(size, axis);
  pose.position = rotation * pose.position;
  pose.rotation = rotation * pose.rotation;
  static_cast<void>(camera_.setPose(pose));
}

void OrbitNavigator::zoom(double amount) {
  Pose pose = camera_.pose();
  const double distance = glm::length(pose.position);
  if (!(distance > 0.0)) {
    return;
  }
  const double floor = camera_.anchor().ground() != nullptr ? minimumClearance.get() : nearestDistance;
  const double above = std::max(height(), floor);
  const double next = std::max(above * std::exp(-std::clamp(amount, -50.0, 50.0)), floor);
  const double nextDistance = std::clamp(distance + next - above, nearestDistance, farthestDistance);
  pose.position *= nextDistance / distance;
  static_cast<void>(camera_.setPose(pose));
}

void OrbitNavigator::turn(const glm::dvec2& tilt, double roll) {
  Pose pose = camera_.pose();
  const double fieldOfView = camera_.verticalFieldOfViewDegrees.get() * degree;
  const glm::dquat about = glm::angleAxis(-tilt.y * fieldOfView, glm::dvec3(1.0, 0.0, 0.0)) *
                           glm::angleAxis(-tilt.x * fieldOfView, glm::dvec3(0.0, 1.0, 0.0)) *
                           glm::angleAxis(-roll * std::numbers::pi, glm::dvec3(0.0, 0.0, 1.0));
  pose.rotation = pose.rotation * about;
  static_cast<void>(camera_.setPose(pose));
}

bool OrbitNavigator::keepClear() {
  const scene::SceneNode& anchor = camera_.anchor();
  const Ground* ground = anchor.ground();
  const double missing = ground != nullptr ? minimumClearance.get() - height() : 0.0;
  if (!(missing > 0.0)) {
    return false;
  }
  const double scale = camera_.scene().worldFromNode(anchor).scale;
  Pose pose = camera_.pose();
  GeodeticPosition place = ground->geodetic(pose.position / scale);
  place.height = ground->heightAt(place.latitude, place.longitude) + minimumClearance.get() / scale;
  pose.position = scale * ground->cartesian(place);
  static_cast<void>(camera_.setPose(pose));
  return missing > roundingOfHeights;
}

}  // namespace meridian::navigation
