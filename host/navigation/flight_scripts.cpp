#include "host/navigation/flight_scripts.h"

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "host/navigation/geodetic_pose.h"
#include "host/navigation/navigation_state.h"

namespace meridian::navigation {

namespace {

using Arguments = std::span<const Value>;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double defaultSeconds = 5.0;
constexpr double fallbackSize = 1e7;     ///< metres; of a node without a bounding sphere
constexpr double spheresAway = 3.0;      ///< how far from a node's centre a flight to it ends
constexpr double heightsPerPush = 0.01;  ///< picture heights that one unit of addGlobalRotation and the like drags

struct Controls {
  Camera* camera;
  OrbitNavigator* navigator;
  Flight* flight;
};

ScriptResult none(const Result<void>& done) {
  return done ? ScriptResult(std::vector<Value>{}) : tl::make_unexpected(done.error());
}

Result<double> numberAt(Arguments arguments, std::size_t i, std::optional<double> otherwise = {}) {
  if (otherwise && (i >= arguments.size() || arguments[i].isNil())) {
    return *otherwise;
  }
  const auto number = i < arguments.size() ? arguments[i].number() : std::nullopt;
  if (!number || !std::isfinite(*number)) {
    return failure("expected a finite number as argument " + std::to_string(i + 1));
  }
  return *number;
}

/// Behind the target come, in any of OpenSpace's versions, whether to use the target's up, and seconds.
double secondsFrom(Arguments arguments, std::size_t first) {
  for (std::size_t i = first; i < arguments.size(); ++i) {
    if (const auto seconds = arguments[i].number(); seconds && std::isfinite(*seconds)) {
      return *seconds;
    }
  }
  return defaultSeconds;
}

Result<scene::SceneNode*> nodeAt(const Controls& controls, Arguments arguments, std::size_t i) {
  const std::string* identifier = i < arguments.size() ? arguments[i].string() : nullptr;
  if (identifier == nullptr) {
    return failure("expected the identifier of a node as argument " + std::to_string(i + 1));
  }
  scene::SceneNode* node =
      identifier->empty() ? &controls.camera->anchor() : controls.camera->scene().node(*identifier);
  if (node == nullptr) {
    return failure("there is no node '" + *identifier + "'", {}, "check the identifier");
  }
  return node;
}

double sphereOf(const Controls& controls, const scene::SceneNode& node) {
  const double scale = controls.camera->scene().worldFromNode(node).scale;
  return node.boundingSphere() > 0.0 ? scale * node.boundingSphere() : fallbackSize;
}

/// To that distance from the node's centre, on the side where the camera is; looking at it.
Result<void> flyToDistance(const Controls& controls, const scene::SceneNode& node, double distance, double seconds) {
  const Pose present = controls.camera->poseIn(node);
  const double length = glm::length(present.position);
  const glm::dvec3 outward = length > 0.0 ? present.position / length : glm::dvec3(1.0, 0.0, 0.0);
  return controls.flight->begin(node.identifier(), {distance * outward, lookRotation(-outward, present.up())}, seconds);
}

ScriptResult flyTo(const Controls& controls, Arguments arguments) {
  return nodeAt(controls, arguments, 0).and_then([&](const scene::SceneNode* node) {
    return none(flyToDistance(controls, *node, spheresAway * sphereOf(controls, *node), secondsFrom(arguments, 1)));
  });
}

ScriptResult flyToHeight(const Controls& controls, Arguments arguments) {
  const auto node = nodeAt(controls, arguments, 0);
  const auto height = numberAt(arguments, 1);
  if (!node || !height) {
    return tl::make_unexpected(node ? height.error() : node.error());
  }
  const double distance = sphereOf(controls, **node) + *height;
  if (!(distance > 0.0)) {
    return failure("the height leads to the node's centre");
  }
  return none(flyToDistance(controls, **node, distance, secondsFrom(arguments, 2)));
}

struct GeoPlace {
  double latitude = 0.0;           ///< degrees
  double longitude = 0.0;          ///< degrees
  std::optional<double> altitude;  ///< metres; nothing: as now
};

ScriptResult flyToPlace(const Controls& controls, const scene::SceneNode& node, const GeoPlace& place, double seconds) {
  const Ground* ground = node.ground();
  if (ground == nullptr) {
    return failure("the node '" + node.identifier() + "' is not a globe", {}, "name a node with a RenderableGlobe");
  }
  if (std::abs(place.latitude) > 90.0) {
    return failure("the latitude is outside -90..90 degrees");
  }
  const double scale = controls.camera->scene().worldFromNode(node).scale;
  const double present = ground->geodetic(controls.camera->poseIn(node).position / scale).height;
  const GeodeticPosition target{place.latitude * degree, std::remainder(place.longitude, 360.0) * degree,
                                place.altitude.value_or(present)};
  Pose pose = poseFromGeodetic(*ground, {target, 0.0, -0.5 * std::numbers::pi, 0.0});
  pose.position *= scale;
  return none(controls.flight->begin(node.identifier(), pose, seconds));
}

ScriptResult flyToGeo(const Controls& controls, Arguments arguments) {
  const auto node = nodeAt(controls, arguments, 0);
  const auto latitude = numberAt(arguments, 1);
  const auto longitude = numberAt(arguments, 2);
  const auto altitude = numberAt(arguments, 3);
  if (!node) {
    return tl::make_unexpected(node.error());
  }
  for (const auto* each : {&latitude, &longitude, &altitude}) {
    if (!*each) {
      return tl::make_unexpected(each->error());
    }
  }
  return flyToPlace(controls, **node, {*latitude, *longitude, *altitude}, secondsFrom(arguments, 4));
}

/// Without an altitude: at the distance of now, or a bounding sphere above the ground.
ScriptResult flyToGeo2(const Controls& controls, Arguments arguments) {
  const auto node = nodeAt(controls, arguments, 0);
  const auto latitude = numberAt(arguments, 1);
  const auto longitude = numberAt(arguments, 2);
  if (!node) {
    return tl::make_unexpected(node.error());
  }
  if (!latitude || !longitude) {
    return tl::make_unexpected(latitude ? longitude.error() : latitude.error());
  }
  const bool keepDistance = arguments.size() > 3 && arguments[3].boolean().value_or(false);
  GeoPlace place{*latitude, *longitude, std::nullopt};
  if (!keepDistance) {
    place.altitude = (*node)->boundingSphere();
  }
  return flyToPlace(controls, **node, place, secondsFrom(arguments, 4));
}

/// Where the state puts the camera is found by putting it there and back.
ScriptResult flyToState(const Controls& controls, Arguments arguments) {
  const auto state = NavigationState::fromValue(arguments[0], "the navigation state");
  if (!state) {
    return tl::make_unexpected(state.error());
  }
  const std::string anchor = controls.camera->anchor().identifier();
  const Pose present = controls.camera->pose();
  if (auto set = setNavigationState(*controls.camera, *state); !set) {
    return none(set);
  }
  const std::string targetAnchor = controls.camera->anchor().identifier();
  const Pose target = controls.camera->pose();
  if (auto back = controls.camera->setPose(anchor, present); !back) {
    return none(back);
  }
  return none(controls.flight->begin(targetAnchor, target, secondsFrom(arguments, 1)));
}

ScriptResult zoomTo(const Controls& controls, double height, double seconds) {
  const scene::SceneNode& anchor = controls.camera->anchor();
  const double distance = sphereOf(controls, anchor) + height;
  if (!(distance > 0.0)) {
    return failure("the distance leads to the node's centre");
  }
  return none(flyToDistance(controls, anchor, distance, seconds));
}

/// createPath { TargetType = "Node" or "NavigationState", Target, Height, NavigationState, Duration }.
ScriptResult createPath(const Controls& controls, Arguments arguments) {
  const Value& path = arguments[0];
  const Value* type = path.find("TargetType");
  const std::string kind = type != nullptr && type->string() != nullptr ? *type->string() : std::string();
  const Value* seconds = path.find("Duration");
  const Value duration = seconds != nullptr ? *seconds : Value(defaultSeconds);
  if (kind == "NavigationState") {
    const Value* state = path.find("NavigationState");
    const std::vector<Value> flown{state != nullptr ? *state : Value(), duration};
    return flyToState(controls, flown);
  }
  if (kind != "Node") {
    return failure("the path has no TargetType", {}, "use Node or NavigationState");
  }
  const Value* target = path.find("Target");
  const Value* height = path.find("Height");
  const std::vector<Value> flown{target != nullptr ? *target : Value(), height != nullptr ? *height : Value(),
                                 duration};
  return height != nullptr ? flyToHeight(controls, flown) : flyTo(controls, std::vector<Value>{flown[0], duration});
}

std::vector<ScriptFunction> flights(const Controls& controls) {
  const auto with = [controls](ScriptResult (*function)(const Controls&, Arguments)) {
    return [controls, function](Arguments arguments) { return function(controls, arguments); };
  };
  return {{"flyTo", "node, useUp or seconds?, seconds?", "Flies to a node", 1, 3, with(flyTo)},
          {"flyToHeight", "node, height, useUp or seconds?, seconds?", "Flies to a height over a node", 2, 4,
           with(flyToHeight)},
          {"flyToGeo", "globe, latitude, longitude, altitude, seconds?, useUp?", "Flies over a place", 4, 6,
           with(flyToGeo)},
          {"flyToGeo2", "globe, latitude, longitude, keepDistance?, seconds?, useUp?", "Flies over a place", 3, 6,
           with(flyToGeo2)},
          {"flyToNavigationState", "table, useUp?, seconds?", "Flies to where the table says", 1, 3, with(flyToState)},
          {"zoomToFocus", "seconds?", "Flies nearer to or away from the anchor, to see it whole", 0, 1,
           [controls](Arguments a) {
             const scene::SceneNode& anchor = controls.camera->anchor();
             return none(flyToDistance(controls, anchor, spheresAway * sphereOf(controls, anchor), secondsFrom(a, 0)));
           }},
          {"zoomToDistance", "metres, seconds?", "Flies to a distance from the anchor's sphere", 1, 2,
           [controls](Arguments a) -> ScriptResult {
             return numberAt(a, 0).and_then([&](double metres) { return zoomTo(controls, metres, secondsFrom(a, 1)); });
           }},
          {"zoomToDistanceRelative", "factor, seconds?", "The same, in bounding spheres", 1, 2,
           [controls](Arguments a) -> ScriptResult {
             return numberAt(a, 0).and_then([&](double factor) {
               return zoomTo(controls, factor * sphereOf(controls, controls.camera->anchor()), secondsFrom(a, 1));
             });
           }},
          {"isFlying", "", "Whether a flight is under way", 0, 0,
           [controls](Arguments) -> ScriptResult { return std::vector<Value>{controls.flight->isFlying()}; }}};
}

ScriptFunction push(const Controls& controls, std::string name, OrbitNavigator::Motion motion) {
  return {std::move(name), "x, y", "Pushes the camera once", 2, 2, [controls, motion](Arguments a) -> ScriptResult {
            const auto x = numberAt(a, 0);
            const auto y = numberAt(a, 1);
            if (!x || !y) {
              return tl::make_unexpected(x ? y.error() : x.error());
            }
            controls.navigator->drag(motion, heightsPerPush * glm::dvec2(*x, *y));
            return std::vector<Value>{};
          }};
}

}  // namespace

ScriptLibrary flightLibrary(Camera& camera, OrbitNavigator& navigator, Flight& flight) {
  using Motion = OrbitNavigator::Motion;
  const Controls controls{&camera, &navigator, &flight};
  ScriptLibrary library{"navigation", flights(controls)};
  for (const auto& [name, motion] : {std::pair{"addGlobalRotation", Motion::Orbit},
                                     {"addLocalRotation", Motion::Tilt},
                                     {"addTruckMovement", Motion::Zoom},
                                     {"addLocalRoll", Motion::Roll},
                                     {"addGlobalRoll", Motion::Roll}}) {
    library.functions.push_back(push(controls, name, motion));
  }
  return library;
}

ScriptLibrary pathLibrary(Camera& camera, OrbitNavigator& navigator, Flight& flight) {
  const Controls controls{&camera, &navigator, &flight};
  const auto action = [](std::string name, std::string description, std::function<void()> act) {
    return ScriptFunction{
        std::move(name), "", std::move(description), 0, 0, [act = std::move(act)](Arguments) -> ScriptResult {
          act();
          return std::vector<Value>{};
        }};
  };
  ScriptLibrary library{"pathnavigation", flights(controls)};
  library.functions.push_back({"createPath", "table", "Begins the flight that the table describes", 1, 1,
                               [controls](Arguments a) { return createPath(controls, a); }});
  library.functions.push_back(action("pausePath", "Halts the flight", [&flight] { flight.setPaused(true); }));
  library.functions.push_back(action("continuePath", "Goes on with it", [&flight] { flight.setPaused(false); }));
  library.functions.push_back(action("stopPath", "Ends it where it is", [&flight] { flight.stop(); }));
  library.functions.push_back(action("skipToEnd", "Goes to its end at once", [&flight] { flight.skip(); }));
  return library;
}

}  // namespace meridian::navigation
