#include "host/navigation/navigation_state.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "host/api/schema.h"

namespace meridian::navigation {

namespace {

using Type = Schema::Type;

const Schema& schema() {
  static const Schema schema({{"Anchor", Type::Identifier, "The node that the camera hangs on", true},
                              {"Aim", Type::String, "The node that is looked at; the anchor without"},
                              {"ReferenceFrame", Type::String, "The node whose axes hold; the anchor without"},
                              {"Position", Type::Vector3, "Metres from the anchor", true},
                              {"Up", Type::Vector3, "Direction that is up in the picture"},
                              {"Yaw", Type::Number, "Radians to the right"},
                              {"Pitch", Type::Number, "Radians upwards"},
                              {"Timestamp", Type::Any, "UTC date, or TDB seconds past J2000"}});
  return schema;
}

std::string text(const Value& value, std::string_view key) {
  const Value* found = value.find(key);
  return found != nullptr ? *found->string() : std::string();
}

double number(const Value& value, std::string_view key) {
  const Value* found = value.find(key);
  return found != nullptr ? *found->number() : 0.0;
}

Result<glm::dvec3> finiteVector(const Value& value, std::string_view where, std::string_view key) {
  const std::vector<double> n = *value.numbers(3);
  if (!std::isfinite(n[0]) || !std::isfinite(n[1]) || !std::isfinite(n[2])) {
    return failure("expected finite numbers", std::string(where) + ": " + std::string(key),
                   "check how they were computed");
  }
  return glm::dvec3(n[0], n[1], n[2]);
}

Result<std::optional<Time>> timestampOf(const Value& value, std::string_view where) {
  const Value* stamp = value.find("Timestamp");
  if (stamp == nullptr) {
    return std::nullopt;
  }
  if (const auto seconds = stamp->number(); seconds && std::isfinite(*seconds)) {
    return Time(*seconds);
  }
  if (const std::string* date = stamp->string()) {
    auto time = Time::fromUtc(*date);
    if (!time) {
      return tl::make_unexpected(time.error());
    }
    return *time;
  }
  return failure("expected a UTC date or TDB seconds past J2000", std::string(where) + ": Timestamp",
                 "write it as \"2026-06-21T06:00:00\"");
}

Result<scene::SceneNode*> findNode(const scene::Scene& scene, std::string_view identifier) {
  scene::SceneNode* node = scene.node(identifier);
  if (node == nullptr) {
    return failure("there is no node '" + std::string(identifier) + "'", {}, "check the identifier");
  }
  return node;
}

/// The turn of the camera that looks from `position` at `aim`, before yaw and pitch.
glm::dquat lookAt(const glm::dvec3& position, const glm::dvec3& aim, const glm::dvec3& up) {
  return lookRotation(aim - position, up);
}

}  // namespace

Result<NavigationState> NavigationState::fromValue(const Value& value, std::string_view where) {
  if (auto valid = schema().validate(value, where); !valid) {
    return tl::make_unexpected(valid.error());
  }
  NavigationState state;
  state.anchor = text(value, "Anchor");
  state.aim = text(value, "Aim");
  state.referenceFrame = text(value, "ReferenceFrame");
  const auto position = finiteVector(*value.find("Position"), where, "Position");
  if (!position) {
    return tl::make_unexpected(position.error());
  }
  state.position = *position;
  if (const Value* up = value.find("Up")) {
    const auto direction = finiteVector(*up, where, "Up");
    if (!direction) {
      return tl::make_unexpected(direction.error());
    }
    state.up = *direction;
  }
  state.yaw = number(value, "Yaw");
  state.pitch = number(value, "Pitch");
  if (!std::isfinite(state.yaw) || !std::isfinite(state.pitch)) {
    return failure("yaw and pitch must be finite", std::string(where), "give radians");
  }
  const auto timestamp = timestampOf(value, where);
  if (!timestamp) {
    return tl::make_unexpected(timestamp.error());
  }
  state.timestamp = *timestamp;
  return state;
}

Value NavigationState::toValue() const {
  Table table;
  table.fields.emplace("Anchor", anchor);
  if (!aim.empty()) {
    table.fields.emplace("Aim", aim);
  }
  if (!referenceFrame.empty()) {
    table.fields.emplace("ReferenceFrame", referenceFrame);
  }
  table.fields.emplace("Position", Value(position));
  if (up) {
    table.fields.emplace("Up", Value(*up));
  }
  table.fields.emplace("Yaw", yaw);
  table.fields.emplace("Pitch", pitch);
  if (timestamp) {
    table.fields.emplace("Timestamp", timestamp->utc());
  }
  return table;
}

Result<NavigationState> navigationState(const Camera& camera, std::string_view referenceFrame) {
  const scene::Scene& scene = camera.scene();
  const std::string frame(referenceFrame.empty() ? camera.anchor().identifier() : referenceFrame);
  const auto axes = findNode(scene, frame);
  if (!axes) {
    return tl::make_unexpected(axes.error());
  }
  const glm::dmat3 turn = scene::Scene::relativeTransform(camera.anchor(), **axes).rotation;
  NavigationState state;
  state.anchor = camera.anchor().identifier();
  state.referenceFrame = frame;
  state.position = turn * camera.pose().position;
  const glm::dquat rotation = glm::normalize(glm::quat_cast(turn) * camera.pose().rotation);
  state.timestamp = scene.time();
  if (glm::length(state.position) == 0.0) {
    return state;
  }
  // The direction to the anchor in the camera's axes fixes yaw and pitch: what they are turned back by gives up.
  const glm::dvec3 towards = glm::conjugate(rotation) * -glm::normalize(state.position);
  state.yaw = std::asin(std::clamp(-towards.x, -1.0, 1.0));
  state.pitch = std::atan2(-towards.y, -towards.z);
  const glm::dquat level = rotation * glm::angleAxis(-state.pitch, glm::dvec3(1.0, 0.0, 0.0)) *
                           glm::angleAxis(state.yaw, glm::dvec3(0.0, 1.0, 0.0));
  state.up = level * glm::dvec3(0.0, 1.0, 0.0);
  return state;
}

Result<void> setNavigationState(Camera& camera, const NavigationState& state) {
  const scene::Scene& scene = camera.scene();
  const auto anchor = findNode(scene, state.anchor);
  const auto aim = findNode(scene, state.aim.empty() ? state.anchor : state.aim);
  const auto axes = findNode(scene, state.referenceFrame.empty() ? state.anchor : state.referenceFrame);
  for (const auto* found : {&anchor, &aim, &axes}) {
    if (!*found) {
      return tl::make_unexpected(found->error());
    }
  }
  const glm::dmat3 turn = scene::Scene::relativeTransform(**axes, **anchor).rotation;
  const double scale = scene.worldFromNode(**anchor).scale;
  const glm::dvec3 position = turn * state.position;
  const glm::dvec3 target = scene::Scene::relativeTransform(**aim, **anchor).translation * scale;
  if (!(glm::distance(position, target) > 0.0)) {
    return failure("the camera cannot stand where it looks at", "Position", "give a position away from the aim");
  }
  const glm::dvec3 up = turn * state.up.value_or(glm::dvec3(0.0, 0.0, 1.0));
  const glm::dquat rotation = lookAt(position, target, up) * glm::angleAxis(-state.yaw, glm::dvec3(0.0, 1.0, 0.0)) *
                              glm::angleAxis(state.pitch, glm::dvec3(1.0, 0.0, 0.0));
  return camera.setPose(state.anchor, {position, rotation});
}

}  // namespace meridian::navigation
