#include "host/navigation/script_library.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "host/navigation/geodetic_pose.h"
#include "host/navigation/navigation_state.h"

namespace meridian::navigation {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double fallbackSize = 1e7;  ///< metres; of a node without a bounding sphere

using Arguments = std::span<const Value>;

/// What every function needs.
struct Controls {
  Camera* camera;
  OrbitNavigator* navigator;
};

Result<std::string> textAt(Arguments arguments, std::size_t index, std::string_view name) {
  const std::string* text = index < arguments.size() ? arguments[index].string() : nullptr;
  if (text == nullptr) {
    return failure("expected a string as argument " + std::to_string(index + 1) + " (" + std::string(name) + ")");
  }
  return *text;
}

Result<double> numberAt(Arguments arguments, std::size_t index, std::string_view name) {
  const auto number = index < arguments.size() ? arguments[index].number() : std::nullopt;
  if (!number || !std::isfinite(*number)) {
    return failure("expected a finite number as argument " + std::to_string(index + 1) + " (" + std::string(name) +
                   ")");
  }
  return *number;
}

Result<scene::SceneNode*> nodeNamed(const Controls& controls, const std::string& identifier) {
  scene::SceneNode* node = identifier.empty() ? &controls.camera->anchor() : controls.camera->scene().node(identifier);
  if (node == nullptr) {
    return failure("there is no node '" + identifier + "'", {}, "check the identifier");
  }
  return node;
}

struct GeoTarget {
  scene::SceneNode* node = nullptr;
  const Ground* ground = nullptr;
  GeodeticPosition position{};
};

/// node, latitude, longitude[, altitude] from argument `first` on. Without altitude: the camera's present height.
Result<GeoTarget> geoTarget(const Controls& controls, const std::string& identifier, Arguments arguments,
                            std::size_t first) {
  const auto node = nodeNamed(controls, identifier);
  if (!node) {
    return tl::make_unexpected(node.error());
  }
  const Ground* ground = (*node)->ground();
  if (ground == nullptr) {
    return failure("the node '" + (*node)->identifier() + "' is not a globe", {}, "name a node with a RenderableGlobe");
  }
  const auto latitude = numberAt(arguments, first, "latitude");
  const auto longitude = numberAt(arguments, first + 1, "longitude");
  if (!latitude || !longitude) {
    return tl::make_unexpected((latitude ? longitude : latitude).error());
  }
  if (std::abs(*latitude) > 90.0) {
    return failure("the latitude is outside -90..90 degrees");
  }
  double altitude = 0.0;
  if (first + 2 < arguments.size() && !arguments[first + 2].isNil()) {
    const auto given = numberAt(arguments, first + 2, "altitude");
    if (!given) {
      return tl::make_unexpected(given.error());
    }
    altitude = *given;
  } else {
    altitude = ground->geodetic(controls.camera->poseIn(**node).position).height;
  }
  return GeoTarget{*node, ground, {*latitude * degree, std::remainder(*longitude, 360.0) * degree, altitude}};
}

ScriptResult none(const Result<void>& result) {
  if (!result) {
    return tl::make_unexpected(result.error());
  }
  return std::vector<Value>{};
}

/// Looks straight down with north up, as OpenSpace does after a jump.
ScriptResult jumpToTarget(const Controls& controls, const GeoTarget& target) {
  const double floor = target.ground->heightAt(target.position.latitude, target.position.longitude);
  if (target.position.height < floor) {
    return failure("the altitude is below the surface, which is at " + std::to_string(floor) + " m there", {},
                   "give a greater altitude; it counts from the reference ellipsoid");
  }
  Pose pose = poseFromGeodetic(*target.ground, {target.position, 0.0, -0.5 * std::numbers::pi, 0.0});
  pose.position *= controls.camera->scene().worldFromNode(*target.node).scale;
  controls.navigator->stop();
  return none(controls.camera->setPose(target.node->identifier(), pose));
}

ScriptResult jumpToGeo(const Controls& controls, Arguments arguments) {
  const auto identifier = textAt(arguments, 0, "globe");
  if (!identifier) {
    return tl::make_unexpected(identifier.error());
  }
  const auto target = geoTarget(controls, *identifier, arguments, 1);
  return target ? jumpToTarget(controls, *target) : ScriptResult(tl::make_unexpected(target.error()));
}

ScriptResult goToGeo(const Controls& controls, Arguments arguments) {
  if (!arguments.empty() && arguments[0].string() != nullptr) {
    return jumpToGeo(controls, arguments);
  }
  const auto target = geoTarget(controls, {}, arguments, 0);
  return target ? jumpToTarget(controls, *target) : ScriptResult(tl::make_unexpected(target.error()));
}

ScriptResult localPositionFromGeo(const Controls& controls, Arguments arguments) {
  const auto identifier = textAt(arguments, 0, "globe");
  if (!identifier) {
    return tl::make_unexpected(identifier.error());
  }
  const auto target = geoTarget(controls, *identifier, arguments, 1);
  if (!target) {
    return tl::make_unexpected(target.error());
  }
  const glm::dvec3 position = target->ground->cartesian(target->position);
  return std::vector<Value>{position.x, position.y, position.z};
}

ScriptResult setState(const Controls& controls, Arguments arguments) {
  const auto state = NavigationState::fromValue(arguments[0], "the navigation state");
  if (!state) {
    return tl::make_unexpected(state.error());
  }
  controls.navigator->stop();
  return none(setNavigationState(*controls.camera, *state));
}

ScriptResult getState(const Controls& controls, Arguments arguments) {
  std::string frame;
  if (!arguments.empty() && !arguments[0].isNil()) {
    const auto given = textAt(arguments, 0, "frame");
    if (!given) {
      return tl::make_unexpected(given.error());
    }
    frame = *given;
  }
  const auto state = navigationState(*controls.camera, frame);
  if (!state) {
    return tl::make_unexpected(state.error());
  }
  return std::vector<Value>{state->toValue()};
}

Result<void> lookAtAnchor(Camera& camera) {
  Pose pose = camera.pose();
  if (!(glm::length(pose.position) > 0.0)) {
    return {};
  }
  pose.rotation = lookRotation(-pose.position, pose.up());
  return camera.setPose(pose);
}

ScriptResult setFocus(const Controls& controls, Arguments arguments) {
  const auto identifier = textAt(arguments, 0, "node");
  if (!identifier) {
    return tl::make_unexpected(identifier.error());
  }
  if (auto set = controls.camera->setAnchor(*identifier); !set) {
    return tl::make_unexpected(set.error());
  }
  if (arguments.size() < 3 || arguments[2].boolean().value_or(true)) {
    controls.navigator->stop();
  }
  const bool retarget = arguments.size() < 2 || arguments[1].boolean().value_or(true);
  return retarget ? none(lookAtAnchor(*controls.camera)) : ScriptResult(std::vector<Value>{});
}

/// The next (or the one before) of the nodes with the tag `GUI.Interesting`, which profiles mark.
ScriptResult targetInteresting(const Controls& controls, bool next) {
  std::vector<const scene::SceneNode*> marked;
  std::ptrdiff_t present = -1;
  for (const auto& node : controls.camera->scene().nodes()) {
    const auto& tags = node->tags();
    if (std::find(tags.begin(), tags.end(), "GUI.Interesting") != tags.end()) {
      present = node.get() == &controls.camera->anchor() ? std::ssize(marked) : present;
      marked.push_back(node.get());
    }
  }
  if (marked.empty()) {
    return std::vector<Value>{};
  }
  const auto count = std::ssize(marked);
  const std::ptrdiff_t chosen = present < 0 ? 0 : (present + (next ? 1 : count - 1)) % count;
  const std::vector<Value> focus{marked[static_cast<std::size_t>(chosen)]->identifier()};
  return setFocus(controls, focus);
}

/// To the side of the node that the camera is on, three bounding spheres from its centre.
ScriptResult jumpTo(const Controls& controls, Arguments arguments) {
  if (!arguments.empty() && arguments[0].isTable()) {
    return setState(controls, arguments);
  }
  const auto identifier = textAt(arguments, 0, "node");
  if (!identifier) {
    return tl::make_unexpected(identifier.error());
  }
  const auto node = nodeNamed(controls, *identifier);
  if (!node) {
    return tl::make_unexpected(node.error());
  }
  const Pose present = controls.camera->poseIn(**node);
  const double distance = glm::length(present.position);
  const double scale = controls.camera->scene().worldFromNode(**node).scale;
  const double size = (*node)->boundingSphere() > 0.0 ? scale * (*node)->boundingSphere() : fallbackSize;
  const glm::dvec3 outward = distance > 0.0 ? present.position / distance : glm::dvec3(1.0, 0.0, 0.0);
  controls.navigator->stop();
  return none(controls.camera->setPose((*node)->identifier(),
                                       {3.0 * size * outward, lookRotation(-outward, glm::dvec3(0.0, 0.0, 1.0))}));
}

ScriptResult distance(const Controls& controls, bool toSphere) {
  const scene::SceneNode& anchor = controls.camera->anchor();
  const double sphere = toSphere ? controls.camera->scene().worldFromNode(anchor).scale * anchor.boundingSphere() : 0.0;
  return std::vector<Value>{controls.camera->distanceTo(anchor) - sphere};
}

}  // namespace

ScriptLibrary navigationLibrary(Camera& camera, OrbitNavigator& navigator) {
  const Controls controls{&camera, &navigator};
  const auto with = [controls](auto function) {
    return [controls, function](Arguments arguments) -> ScriptResult { return function(controls, arguments); };
  };
  const auto sphere = [controls](Arguments) { return distance(controls, true); };
  return {"navigation",
          {{"jumpToGeo", "globe, latitude, longitude, altitude?, fade?", "Over a place on a globe, looking down", 3, 5,
            with(jumpToGeo)},
           {"localPositionFromGeo", "globe, latitude, longitude, altitude", "x, y, z in the globe's frame", 4, 4,
            with(localPositionFromGeo)},
           {"setNavigationState", "table", "Puts the camera where the table says", 1, 2, with(setState)},
           {"jumpToNavigationState", "table", "The same", 1, 3, with(setState)},
           {"getNavigationState", "frame?", "Where the camera is", 0, 1, with(getState)},
           {"setFocus", "node, retarget?, reset?", "Makes a node the anchor and looks at it", 1, 3, with(setFocus)},
           {"retargetAnchor", "", "Looks at the anchor", 0, 0,
            [controls](Arguments) { return none(lookAtAnchor(*controls.camera)); }},
           {"retargetAim", "", "The same: the aim is the anchor", 0, 0,
            [controls](Arguments) { return none(lookAtAnchor(*controls.camera)); }},
           {"targetNextInterestingAnchor", "", "Makes the next marked node the anchor", 0, 0,
            [controls](Arguments) { return targetInteresting(controls, true); }},
           {"targetPreviousInterestingAnchor", "", "And the one before", 0, 0,
            [controls](Arguments) { return targetInteresting(controls, false); }},
           {"jumpTo", "node or table, fade?", "Near a node, or where the table says", 1, 2, with(jumpTo)},
           {"distanceToFocus", "", "Metres to the anchor's origin", 0, 0,
            [controls](Arguments) { return distance(controls, false); }},
           {"distanceToFocusBoundingSphere", "", "Metres to the anchor's bounding sphere", 0, 0, sphere},
           {"distanceToFocusInteractionSphere", "", "The same: we have no other sphere", 0, 0, sphere}}};
}

std::vector<ScriptFunction> geoFunctions(Camera& camera, OrbitNavigator& navigator) {
  const Controls controls{&camera, &navigator};
  const auto with = [controls](auto function) {
    return [controls, function](Arguments arguments) -> ScriptResult { return function(controls, arguments); };
  };
  return {
      {"jumpToGeo", "globe, latitude, longitude, altitude?", "Over a place on a globe", 3, 5, with(jumpToGeo)},
      {"goToGeo", "globe?, latitude, longitude, altitude?", "Over a place on a globe", 2, 4, with(goToGeo)},
      {"localPositionFromGeo", "globe, latitude, longitude, altitude", "x, y, z", 4, 4, with(localPositionFromGeo)},
      {"getLocalPositionFromGeo", "globe, latitude, longitude, altitude", "x, y, z", 4, 4, with(localPositionFromGeo)}};
}

}  // namespace meridian::navigation
