#include "host/app/start_view.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

namespace meridian::app {
namespace {

constexpr double filling = 0.85;             // of the picture's height
constexpr double phase = 35.0;               // degrees between the eye and the light, so that relief has shades
constexpr double distanceOfThePoint = 10.0;  // metres, to a node without extent

/// `direction` turned about +z.
glm::dvec3 turned(const glm::dvec3& direction, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * direction.x - s * direction.y, s * direction.x + c * direction.y, direction.z};
}

const scene::SceneNode* chooseAnchor(const navigation::Camera& camera) {
  const auto& nodes = camera.scene().nodes();
  for (const auto& node : nodes) {
    if (node->ground() != nullptr) {
      return node.get();
    }
  }
  for (const auto& node : nodes) {
    if (node->boundingSphere() > 0.0) {
      return node.get();
    }
  }
  return &camera.scene().root();
}

}  // namespace

Result<void> showNode(navigation::Camera& camera, std::string_view identifier) {
  const scene::SceneNode* const node = camera.scene().node(identifier);
  if (node == nullptr) {
    return failure(fmt::format("the scene has no node '{}'", identifier));
  }
  const double radius = node->boundingSphere();
  const double halfAngle = filling * 0.5 * camera.verticalFieldOfViewDegrees.get() * std::numbers::pi / 180.0;
  const double distance = radius > 0.0 ? radius / std::sin(halfAngle) : distanceOfThePoint;
  const glm::dvec3 light = camera.scene().lightDirection(*node);
  const glm::dvec3 outward = turned(light, phase * std::numbers::pi / 180.0);
  return camera.setPose(identifier, {outward * distance, navigation::lookRotation(-outward, {0.0, 0.0, 1.0})});
}

Result<void> placeCamera(navigation::Camera& camera, const std::string& anchor,
                         const std::optional<navigation::GeodeticPose>& place) {
  const bool isPlaced = &camera.anchor() != &camera.scene().root();
  const scene::SceneNode* node = isPlaced ? &camera.anchor() : chooseAnchor(camera);
  if (!anchor.empty()) {
    node = camera.scene().node(anchor);
    if (node == nullptr) {
      return failure(fmt::format("--anchor: the scene has no node '{}'", anchor), {},
                     "name the identifier of a node that an asset adds");
    }
  }
  if (place) {
    if (node->ground() == nullptr) {
      return failure(fmt::format("--camera: the node '{}' is no globe, so it has no latitudes", node->identifier()), {},
                     "name a globe with --anchor");
    }
    return camera.setPose(node->identifier(), navigation::poseFromGeodetic(*node->ground(), *place));
  }
  if (anchor.empty() && isPlaced) {
    return {};
  }
  return showNode(camera, node->identifier());
}

}  // namespace meridian::app
