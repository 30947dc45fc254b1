#pragma once

#include <optional>

#include "host/ephemeris/body_positions.h"
#include "host/ephemeris/frames.h"
#include "host/scene/node_transforms.h"
#include "host/scene/transform_types.h"

namespace meridian::scene {

/// A body as seen from another, by the ephemeris room. A body whose position is not known stays at the origin.
class SpiceTranslation final : public Translation {
 public:
  SpiceTranslation(std::optional<ephemeris::BodyId> target, std::optional<ephemeris::BodyId> observer,
                   ephemeris::Frame frame, TransformClock clock)
      : target_(target), observer_(observer), frame_(std::move(frame)), clock_(clock) {}

  [[nodiscard]] glm::dvec3 position(const Time& time) const override;

  /// The body, if its position is known.
  [[nodiscard]] std::optional<ephemeris::BodyId> target() const { return target_; }
  [[nodiscard]] Time moment(const Time& time) const { return clock_.at(time); }
  [[nodiscard]] const ephemeris::Frame& frame() const { return frame_; }

 private:
  std::optional<ephemeris::BodyId> target_;
  std::optional<ephemeris::BodyId> observer_;
  ephemeris::Frame frame_;
  TransformClock clock_;
};

}  // namespace meridian::scene
