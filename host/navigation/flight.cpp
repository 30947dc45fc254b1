#include "host/navigation/flight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "host/api/log.h"

namespace meridian::navigation {

namespace {

/// How far out the middle of a way to the other side of a body is, in its length.
constexpr double bulge = 0.25;

/// Any unit vector across `direction`.
glm::dvec3 across(const glm::dvec3& direction) {
  const glm::dvec3 other = std::abs(direction.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
  return glm::normalize(glm::cross(direction, other));
}

}  // namespace

Pose poseBetween(const Pose& from, const Pose& to, double share) {
  Pose pose;
  pose.rotation = glm::slerp(from.rotation, to.rotation, share);
  const double near = glm::length(from.position);
  const double far = glm::length(to.position);
  if (!(near > 0.0) || !(far > 0.0)) {
    pose.position = glm::mix(from.position, to.position, share);
    return pose;
  }
  const glm::dvec3 begin = from.position / near;
  const glm::dvec3 end = to.position / far;
  const glm::dvec3 normal = glm::cross(begin, end);
  const double angle = std::atan2(glm::length(normal), glm::dot(begin, end));
  const glm::dvec3 axis = glm::length(normal) > 1e-12 ? glm::normalize(normal) : across(begin);
  const double distance = std::exp(std::lerp(std::log(near), std::log(far), share));
  const double outward = bulge * angle * std::min(near, far) * std::sin(std::numbers::pi * share);
  pose.position = glm::angleAxis(angle * share, axis) * begin * (distance + outward);
  return pose;
}

Result<void> Flight::begin(const std::string& anchor, const Pose& target, double seconds) {
  stop();
  if (!(seconds > 0.0)) {
    return camera_.setPose(anchor, target);
  }
  if (auto held = camera_.setAnchor(anchor); !held) {
    return held;
  }
  paused_ = false;
  navigator_.stop();
  course_ = Course{anchor, camera_.pose(), target, seconds, 0.0, navigator_.stops()};
  return {};
}

void Flight::advance(double seconds) {
  if (!course_ || paused_) {
    return;
  }
  if (navigator_.stops() != course_->stops || camera_.anchor().identifier() != course_->anchor) {
    stop();
    return;
  }
  course_->elapsed += std::max(seconds, 0.0);
  const double linear = std::min(course_->elapsed / course_->seconds, 1.0);
  const double share = linear * linear * (3.0 - 2.0 * linear);
  const Pose pose = linear < 1.0 ? poseBetween(course_->from, course_->to, share) : course_->to;
  if (linear >= 1.0) {
    stop();
  }
  if (const auto set = camera_.setPose(pose); !set) {
    log::error("the flight ends: {}", set.error().message());
    stop();
  }
}

void Flight::skip() {
  if (course_) {
    setPaused(false);
    advance(course_->seconds);
  }
}

}  // namespace meridian::navigation
