#include "host/navigation/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vector_relational.hpp>

namespace meridian::navigation {

namespace {

bool isFinite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// A length beyond which squares overflow; no scene is this large.
constexpr double farthest = 1e150;

}  // namespace

glm::dquat lookRotation(const glm::dvec3& ahead, const glm::dvec3& up) {
  const glm::dvec3 back = -glm::normalize(ahead);
  glm::dvec3 right = glm::cross(up, back);
  if (!(glm::length(right) > 1e-12 * glm::length(up))) {
    // Whichever axis is least along the view.
    const glm::dvec3 size = glm::abs(back);
    const glm::dvec3 other = size.x <= size.y && size.x <= size.z ? glm::dvec3(1.0, 0.0, 0.0)
                             : size.y <= size.z                   ? glm::dvec3(0.0, 1.0, 0.0)
                                                                  : glm::dvec3(0.0, 0.0, 1.0);
    right = glm::cross(other, back);
  }
  right = glm::normalize(right);
  return glm::normalize(glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back)));
}

Camera::Camera(scene::Scene& scene) : PropertyOwner("Camera"), scene_(scene), anchor_(&scene.root()) {
  addProperty(verticalFieldOfViewDegrees);
  removalKey_ = scene_.onRemove([this](scene::SceneNode& leaving) {
    if (&leaving == anchor_) {
      pose_ = poseIn(*leaving.parentNode());
      anchor_ = leaving.parentNode();
    }
  });
}

Camera::~Camera() {
  scene_.forget(removalKey_);
}

Result<void> Camera::setPose(const Pose& pose) {
  if (!isFinite(pose.position) || glm::any(glm::greaterThan(glm::abs(pose.position), glm::dvec3(farthest)))) {
    return failure("the camera's position is not finite", {}, "give finite metres");
  }
  const glm::dquat& q = pose.rotation;
  const double largest = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z), std::abs(q.w)});
  if (!(std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z) && std::isfinite(q.w)) || !(largest > 0.0)) {
    return failure("the camera's rotation is not a finite quaternion above length zero", {}, "give a unit quaternion");
  }
  pose_.position = pose.position;
  // Through the largest part, so that neither tiny nor huge quaternions leave the range.
  pose_.rotation = glm::normalize(q * (1.0 / largest));
  return {};
}

Result<void> Camera::setPose(std::string_view anchor, const Pose& pose) {
  scene::SceneNode* node = scene_.node(anchor);
  if (node == nullptr) {
    return failure("there is no node '" + std::string(anchor) + "' to anchor the camera to", {},
                   "check the identifier");
  }
  if (auto set = setPose(pose); !set) {
    return set;
  }
  anchor_ = node;
  return {};
}

Result<void> Camera::setAnchor(std::string_view identifier) {
  scene::SceneNode* node = scene_.node(identifier);
  if (node == nullptr) {
    return failure("there is no node '" + std::string(identifier) + "' to anchor the camera to", {},
                   "check the identifier");
  }
  if (node == anchor_) {
    return {};
  }
  return setPose(identifier, poseIn(*node));
}

Pose Camera::poseIn(const scene::SceneNode& node) const {
  if (&node == anchor_) {
    return pose_;
  }
  const scene::Transform nodeFromAnchor = scene::Scene::relativeTransform(*anchor_, node);
  // Poses are in the anchor's axes but in metres, so the scales of both nodes are taken out.
  const double nodeScale = scene_.worldFromNode(node).scale;
  const double anchorScale = scene_.worldFromNode(*anchor_).scale;
  const glm::dvec3 inNode = nodeFromAnchor.point(pose_.position / anchorScale);
  return {inNode * nodeScale, glm::normalize(glm::quat_cast(nodeFromAnchor.rotation) * pose_.rotation)};
}

double Camera::distanceTo(const scene::SceneNode& node) const {
  return glm::length(poseIn(node).position);
}

}  // namespace meridian::navigation
