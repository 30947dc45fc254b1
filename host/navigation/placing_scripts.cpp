#include "host/navigation/placing_scripts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "host/api/ground.h"
#include "host/api/log.h"
#include "host/api/property.h"
#include "host/navigation/geodetic_pose.h"

namespace meridian::navigation {

namespace {

using Arguments = std::span<const Value>;

constexpr double degree = std::numbers::pi / 180.0;
constexpr int deepestLevel = 30;

struct Scenery {
  scene::Scene* scene;
  Camera* camera;
  OrbitNavigator* navigator;
};

ScriptResult none(const Result<void>& done) {
  return done ? ScriptResult(std::vector<Value>{}) : tl::make_unexpected(done.error());
}

/// A node, given by its identifier or its table.
Result<scene::SceneNode*> nodeAt(const scene::Scene& scene, Arguments arguments, std::size_t i) {
  const Value* named = arguments[i].isTable() ? arguments[i].find("Identifier") : &arguments[i];
  const std::string* identifier = named != nullptr ? named->string() : nullptr;
  if (identifier == nullptr) {
    return failure("argument " + std::to_string(i + 1) + " must be the identifier of a node");
  }
  scene::SceneNode* node = scene.node(*identifier);
  if (node == nullptr) {
    return failure("there is no node '" + *identifier + "'", {}, "check the identifier");
  }
  return node;
}

Result<scene::SceneNode*> globeAt(const scene::Scene& scene, Arguments arguments, std::size_t i) {
  return nodeAt(scene, arguments, i).and_then([](scene::SceneNode* node) -> Result<scene::SceneNode*> {
    if (node->ground() == nullptr) {
      return failure("the node '" + node->identifier() + "' is not a globe", {}, "name a node with a RenderableGlobe");
    }
    return node;
  });
}

Result<double> numberAt(Arguments arguments, std::size_t i, std::optional<double> otherwise = {}) {
  if (otherwise && (i >= arguments.size() || arguments[i].isNil())) {
    return *otherwise;
  }
  const auto number = arguments[i].number();
  if (!number || !std::isfinite(*number)) {
    return failure("argument " + std::to_string(i + 1) + " must be a finite number");
  }
  return *number;
}

/// By the properties of the node's translation: those of a GlobeTranslation, or a StaticTranslation's Position.
Result<void> placeNode(scene::Scene& scene, scene::SceneNode& node, const scene::SceneNode& globe,
                       const GeodeticPosition& position) {
  const PropertyOwner* translation = node.child("Translation");
  const auto set = [&](std::string_view name, const Value& value) -> Result<void> {
    Property* property = translation != nullptr ? translation->property(name) : nullptr;
    return property != nullptr ? property->set(value) : failure("it has no property " + std::string(name));
  };
  if (translation != nullptr && translation->property("Latitude") != nullptr) {
    return set("Latitude", position.latitude / degree)
        .and_then([&] { return set("Longitude", position.longitude / degree); })
        .and_then([&] { return set("Altitude", position.height); });
  }
  if (translation == nullptr || translation->property("Position") == nullptr) {
    return failure("the node '" + node.identifier() + "' cannot be placed", {},
                   "give it a StaticTranslation or a GlobeTranslation");
  }
  if (node.parentNode() != &globe) {
    if (auto moved = scene.setParent(node.identifier(), globe.identifier()); !moved) {
      return moved;
    }
  }
  return set("Position", Value(globe.ground()->cartesian(position)));
}

ScriptResult setNodePosition(const Scenery& scenery, Arguments arguments) {
  const auto node = nodeAt(*scenery.scene, arguments, 0);
  const auto globe = globeAt(*scenery.scene, arguments, 1);
  if (!node || !globe) {
    return tl::make_unexpected(node ? globe.error() : node.error());
  }
  const auto latitude = numberAt(arguments, 2);
  const auto longitude = numberAt(arguments, 3);
  const auto altitude = numberAt(arguments, 4, 0.0);
  for (const auto* each : {&latitude, &longitude, &altitude}) {
    if (!*each) {
      return tl::make_unexpected(each->error());
    }
  }
  if (std::abs(*latitude) > 90.0) {
    return failure("the latitude is outside -90..90 degrees");
  }
  return none(placeNode(*scenery.scene, **node, **globe,
                        {*latitude * degree, std::remainder(*longitude, 360.0) * degree, *altitude}));
}

/// Of the eye over its anchor; nothing, with an error in the log, when that is no globe.
std::optional<GeodeticPosition> placeOfCamera(const Scenery& scenery) {
  const scene::SceneNode& anchor = scenery.camera->anchor();
  if (anchor.ground() == nullptr) {
    log::error("the camera's anchor '{}' is no globe", anchor.identifier());
    return std::nullopt;
  }
  const double scale = scenery.scene->worldFromNode(anchor).scale;
  return anchor.ground()->geodetic(scenery.camera->pose().position / scale);
}

ScriptResult setNodePositionFromCamera(const Scenery& scenery, Arguments arguments) {
  const auto node = nodeAt(*scenery.scene, arguments, 0);
  if (!node) {
    return tl::make_unexpected(node.error());
  }
  auto place = placeOfCamera(scenery);
  if (!place) {
    return none({});
  }
  if (arguments.size() < 2 || !arguments[1].boolean().value_or(false)) {
    place->height = 0.0;
  }
  return none(placeNode(*scenery.scene, **node, scenery.camera->anchor(), *place));
}

/// The eye is the point below the camera too: nothing else of a globe is known to be looked at.
ScriptResult geoPositionForCamera(const Scenery& scenery) {
  const GeodeticPosition place = placeOfCamera(scenery).value_or(GeodeticPosition{});
  return std::vector<Value>{place.latitude / degree, place.longitude / degree, place.height};
}

/// Above the middle of a tile of OpenSpace's regular grid, as high as it is wide: at level 1 there are 2 x 1 of them.
ScriptResult goToChunk(const Scenery& scenery, Arguments arguments) {
  const auto globe = globeAt(*scenery.scene, arguments, 0);
  if (!globe) {
    return tl::make_unexpected(globe.error());
  }
  const auto x = numberAt(arguments, 1);
  const auto y = numberAt(arguments, 2);
  const auto level = numberAt(arguments, 3);
  for (const auto* each : {&x, &y, &level}) {
    if (!*each) {
      return tl::make_unexpected(each->error());
    }
  }
  const double columns = std::exp2(*level);
  const bool exists = *level >= 1.0 && *level <= deepestLevel && *level == std::floor(*level) && *x >= 0.0 &&
                      *x < columns && *y >= 0.0 && *y < columns / 2.0;
  if (!exists) {
    return failure("there is no such chunk", {}, "give x below 2^level, y below 2^(level - 1), and a level from 1");
  }
  const double size = 360.0 / columns;
  const Ground& ground = *(*globe)->ground();
  const glm::dvec3 radii = ground.radii();
  const double width = size * degree * std::max({radii.x, radii.y, radii.z});
  const GeodeticPosition place{(90.0 - (*y + 0.5) * size) * degree, (-180.0 + (*x + 0.5) * size) * degree, width};
  Pose pose = poseFromGeodetic(ground, {place, 0.0, -0.5 * std::numbers::pi, 0.0});
  pose.position *= scenery.scene->worldFromNode(**globe).scale;
  scenery.navigator->stop();
  return none(scenery.camera->setPose((*globe)->identifier(), pose));
}

}  // namespace

std::vector<ScriptFunction> placingFunctions(scene::Scene& scene, Camera& camera, OrbitNavigator& navigator) {
  const Scenery scenery{&scene, &camera, &navigator};
  const auto position = [scenery](Arguments) { return geoPositionForCamera(scenery); };
  return {{"setNodePosition", "node, globe, latitude, longitude, altitude?", "Puts a node over a place", 4, 5,
           [scenery](Arguments a) { return setNodePosition(scenery, a); }},
          {"setNodePositionFromCamera", "node, useAltitude?", "Puts a node below the camera, or where it is", 1, 2,
           [scenery](Arguments a) { return setNodePositionFromCamera(scenery, a); }},
          {"geoPositionForCamera", "useEye?", "Latitude, longitude, altitude of the camera", 0, 1, position},
          {"getGeoPositionForCamera", "useEye?", "Older name of geoPositionForCamera", 0, 1, position},
          {"goToChunk", "globe, x, y, level", "Over a tile of OpenSpace's grid", 4, 4,
           [scenery](Arguments a) { return goToChunk(scenery, a); }}};
}

}  // namespace meridian::navigation
