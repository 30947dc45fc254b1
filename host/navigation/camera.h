#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "host/api/error.h"
#include "host/api/frame_context.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"
#include "host/scene/scene.h"

namespace meridian::navigation {

/// Where a camera is and how it is turned, in some frame: looks along -z, +y is up.
struct Pose {
  glm::dvec3 position{0.0};                 ///< metres
  glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< frame-from-camera, unit

  [[nodiscard]] glm::dvec3 ahead() const { return rotation * glm::dvec3(0.0, 0.0, -1.0); }
  [[nodiscard]] glm::dvec3 up() const { return rotation * glm::dvec3(0.0, 1.0, 0.0); }
};

/// The rotation of a camera that looks along `ahead` with `up` as nearly up as can be. Any finite input but a zero
/// `ahead` gives a unit quaternion (an `up` along `ahead` is replaced).
[[nodiscard]] glm::dquat lookRotation(const glm::dvec3& ahead, const glm::dvec3& up);

/// The camera hangs on a node of the scene, its anchor: the pose is in metres along the anchor's axes from the anchor's
/// origin (the anchor's scale does not enter). When the anchor is removed the camera stays where it is, on the parent.
/// Properties: `Camera.*`.
class Camera final : public PropertyOwner {
 public:
  /// Anchored at the root. The scene outlives the camera.
  explicit Camera(scene::Scene& scene);
  ~Camera() override;

  [[nodiscard]] scene::SceneNode& anchor() const { return *anchor_; }
  [[nodiscard]] const Pose& pose() const { return pose_; }

  /// Errors: something that is not finite, a rotation of length zero; the pose is then unchanged. The rotation is
  /// normalised.
  [[nodiscard]] Result<void> setPose(const Pose& pose);
  /// Another anchor and a pose relative to it. Errors as above, and no such node.
  [[nodiscard]] Result<void> setPose(std::string_view anchor, const Pose& pose);
  /// Another anchor while the camera stays where it is. Errors: no such node.
  [[nodiscard]] Result<void> setAnchor(std::string_view identifier);

  /// The same place and direction in the frame of another node: metres along its axes.
  [[nodiscard]] Pose poseIn(const scene::SceneNode& node) const;
  /// Metres between the eye and the node's origin.
  [[nodiscard]] double distanceTo(const scene::SceneNode& node) const;

  [[nodiscard]] const scene::Scene& scene() const { return scene_; }

  /// Of the picture's height; between 0.01 and 170 degrees.
  FloatProperty verticalFieldOfViewDegrees{
      {"FieldOfView", "Vertical field of view", "Degrees, of the picture's height"}, 50.0, {0.01, 170.0}};

 private:
  scene::Scene& scene_;
  scene::SceneNode* anchor_;
  Pose pose_;
  int removalKey_;
};

/// One eye or screen of the camera. Without more than a size it is the whole picture, straight ahead.
struct Viewport {
  glm::ivec2 size{1280, 720};        ///< pixels, at least 1 x 1
  glm::dmat4 eyeFromCamera{1.0};     ///< rotation and translation in metres
  double verticalFieldOfView = 0.0;  ///< radians; 0: the camera's
};

/// Symmetric perspective, depth reversed, far plane at infinity: 1 at `near`, 0 at infinity.
[[nodiscard]] glm::dmat4 reversedPerspective(double verticalFieldOfView, double aspect, double near);

/// Metres; nothing nearer is drawn.
inline constexpr double nearPlane = 0.01;

/// The Views of one node for a FrameContext, through the nearest common ancestor of anchor and node. Replaces what is
/// in `views`, whose memory is used again.
void makeViews(const Camera& camera, const scene::SceneNode& node, std::span<const Viewport> viewports,
               std::vector<View>& views);

}  // namespace meridian::navigation
