#include "host/recording/player.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <glm/common.hpp>
#include <glm/gtc/quaternion.hpp>

#include "host/api/log.h"

namespace meridian::recording {

namespace {

/// The entry's pose in metres along the axes of `node`, from its origin.
navigation::Pose poseIn(const CameraEntry& entry, const scene::Scene& scene, const scene::SceneNode& node) {
  const scene::SceneNode* focus = scene.node(entry.node);
  if (focus == nullptr) {
    focus = &node;  // was removed while playing: the earlier node stands in
  }
  glm::dvec3 position = entry.position;
  glm::dquat rotation = entry.rotation;
  if (!entry.followsRotation) {
    const glm::dquat focusFromWorld = glm::quat_cast(scene::Scene::relativeTransform(scene.root(), *focus).rotation);
    position = focusFromWorld * position;
    rotation = focusFromWorld * rotation;
  }
  if (focus == &node) {
    return {position, rotation};
  }
  const scene::Transform nodeFromFocus = scene::Scene::relativeTransform(*focus, node);
  const double focusScale = scene.worldFromNode(*focus).scale;
  const double nodeScale = scene.worldFromNode(node).scale;
  return {nodeFromFocus.point(position / focusScale) * nodeScale, glm::quat_cast(nodeFromFocus.rotation) * rotation};
}

}  // namespace

Player::Player(SessionRecording recording, navigation::Camera& camera, RunScript runScript)
    : recording_(std::move(recording)), camera_(&camera), runScript_(std::move(runScript)) {
  for (std::size_t i = 0; i < recording_.entries.size(); ++i) {
    if (std::holds_alternative<CameraEntry>(recording_.entries[i])) {
      cameras_.push_back(i);
    }
  }
}

Result<Player> Player::create(SessionRecording recording, navigation::Camera& camera, RunScript runScript) {
  Player player(std::move(recording), camera, std::move(runScript));
  if (player.cameras_.empty()) {
    return failure("the recording has no camera entry", {}, "record the session again");
  }
  const auto& first = std::get<CameraEntry>(player.recording_.entries[player.cameras_.front()]);
  if (camera.scene().node(first.node) == nullptr) {
    return failure("the recording begins at the node '" + first.node + "', which is not in the scene", {},
                   "load the asset that adds it");
  }
  player.startTime_ = first.simulationTime;
  return player;
}

void Player::advance(double seconds) {
  assert(seconds >= 0.0);
  elapsed_ += seconds;
  runDueScripts();
  placeCamera();
}

void Player::restart() {
  elapsed_ = 0.0;
  nextScript_ = 0;
}

void Player::runDueScripts() {
  for (; nextScript_ < recording_.entries.size(); ++nextScript_) {
    const SessionRecording::Entry& entry = recording_.entries[nextScript_];
    const double timestamp = std::visit([](const auto& each) { return each.timestamp; }, entry);
    // A script at the very start belongs to the first frame.
    if (timestamp > 0.0 && timestamp >= elapsed_ && !(elapsed_ >= duration())) {
      return;
    }
    if (const auto* script = std::get_if<ScriptEntry>(&entry)) {
      if (const auto run = runScript_(*script); !run) {
        log::warning("the recording's script at {} s failed: {}", script->timestamp, run.error().message());
      }
    }
  }
}

void Player::placeCamera() {
  const auto at = [&](std::size_t place) -> const CameraEntry& {
    return std::get<CameraEntry>(recording_.entries[cameras_[place]]);
  };
  const auto after = std::upper_bound(cameras_.begin(), cameras_.end(), elapsed_, [&](double time, std::size_t place) {
    return time < std::get<CameraEntry>(recording_.entries[place]).timestamp;
  });
  const auto next = static_cast<std::size_t>(after - cameras_.begin());
  const CameraEntry& earlier = at(next == 0 ? 0 : next - 1);
  const CameraEntry& later = at(std::min(next, cameras_.size() - 1));
  const scene::Scene& scene = camera_->scene();
  const scene::SceneNode* anchor = scene.node(earlier.node);
  if (anchor == nullptr) {
    // A script may have removed it, or may yet add it.
    tellTrouble(earlier, "is relative to '" + earlier.node + "', which is not in the scene: the camera stays");
    return;
  }
  const navigation::Pose from = poseIn(earlier, scene, *anchor);
  const navigation::Pose to = poseIn(later, scene, *anchor);
  const double span = later.timestamp - earlier.timestamp;
  const double t = span > 0.0 ? std::clamp((elapsed_ - earlier.timestamp) / span, 0.0, 1.0) : 0.0;
  const navigation::Pose pose{glm::mix(from.position, to.position, t), glm::slerp(from.rotation, to.rotation, t)};
  if (const auto set = camera_->setPose(earlier.node, pose); !set) {
    const bool isLater = camera_->setPose(earlier.node, from).has_value();
    tellTrouble(isLater ? later : earlier, "cannot be used: " + set.error().message());
    return;
  }
  trouble_.clear();
}

void Player::tellTrouble(const CameraEntry& entry, const std::string& why) {
  const std::string line = entry.line > 0 ? fmt::format(" (line {})", entry.line) : std::string();
  std::string trouble = fmt::format("the recording's camera at {} s{} {}", entry.timestamp, line, why);
  if (trouble != trouble_) {
    trouble_ = std::move(trouble);
    log::warning("{}", trouble_);
  }
}

}  // namespace meridian::recording
