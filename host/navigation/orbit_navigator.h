#pragma once

#include <glm/vec2.hpp>

#include "host/api/property.h"
#include "host/api/property_owner.h"
#include "host/navigation/camera.h"

namespace meridian::navigation {

/// Moves the camera about its anchor by mouse: over a globe at a speed proportional to the height over the terrain,
/// about any other node at one proportional to the distance from its bounding sphere. Never below the terrain.
/// Properties: `Navigation.*`.
class OrbitNavigator final : public PropertyOwner {
 public:
  enum class Motion {
    Orbit,  ///< round the anchor: what is under the pointer follows it
    Zoom,   ///< down the picture: nearer
    Tilt,   ///< turns the camera on the spot
    Roll    ///< to the right: the camera rolls to the right
  };

  /// The camera outlives the navigator.
  explicit OrbitNavigator(Camera& camera);

  /// The pointer has moved by `delta`, in picture heights (x to the right, y down). Not finite: ignored.
  void drag(Motion motion, const glm::dvec2& delta);
  /// Wheel notches, positive is nearer. Not finite: ignored.
  void scroll(double notches);
  /// Moves the camera by what was dragged and by what is left of earlier motion, then lifts it out of the terrain. Call
  /// once a frame.
  void update(double seconds);
  /// Only lifts the camera out of the terrain as far as that is loaded. Whether that moved it.
  bool keepClear();
  /// Forgets what is left of earlier motion.
  void stop();
  /// How often that was, or the mouse moved the camera: by this others see that they no longer do.
  [[nodiscard]] unsigned stops() const { return stops_; }

  /// Metres: height over the terrain of a globe anchor, else the distance from the bounding sphere (from the origin
  /// without one). What speed is proportional to; negative inside.
  [[nodiscard]] double height() const;

  FloatProperty minimumClearance{
      {"MinimumClearance", "Minimum clearance", "Metres that the camera keeps over the terrain"}, 2.0, {0.05, 1e6}};
  FloatProperty sensitivity{{"Sensitivity", "Sensitivity", "Factor of every mouse motion"}, 1.0, {0.01, 10.0}};
  FloatProperty friction{
      {"Friction", "Friction", "Seconds in which inertia falls to a third; 0: no inertia"}, 0.15, {0.0, 10.0}};

 private:
  struct Motions {
    glm::dvec2 orbit{0.0};
    double zoom = 0.0;
    glm::dvec2 tilt{0.0};
    double roll = 0.0;
  };
  void apply(const Motions& motions);
  void orbit(const glm::dvec2& delta);
  void zoom(double amount);
  void turn(const glm::dvec2& tilt, double roll);

  Camera& camera_;
  Motions pending_;
  Motions velocity_;  ///< per second
  unsigned stops_ = 0;
};

}  // namespace meridian::navigation
