#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>

#include "host/api/property.h"
#include "host/api/schema.h"
#include "host/ephemeris/frames.h"
#include "host/scene/composed_transforms.h"
#include "host/scene/fixed_rotation.h"
#include "host/scene/globe_transforms.h"
#include "host/scene/lua_transforms.h"
#include "host/scene/node_transforms.h"
#include "host/scene/transform_types.h"

namespace meridian::scene {

namespace {

using Type = Schema::Type;

/// About x, then y, then z: what OpenSpace makes of three angles.
glm::dmat3 fromEuler(const glm::dvec3& angles) {
  return glm::mat3_cast(glm::dquat(angles));
}

class StaticRotation final : public Rotation {
 public:
  explicit StaticRotation(const glm::dmat3& matrix)
      : rotation_({"Rotation", "Rotation", "Euler angles about x, y and z, radians"},
                  glm::eulerAngles(glm::quat_cast(matrix))),
        matrix_(matrix) {
    addProperty(rotation_);
    rotation_.onChange([this] { matrix_ = fromEuler(rotation_.get()); });
  }
  [[nodiscard]] glm::dmat3 matrix(const Time& /*time*/) const override { return matrix_; }

 private:
  Vec3Property rotation_;
  glm::dmat3 matrix_;
};

bool isRotation(const glm::dmat3& matrix) {
  const glm::dmat3 identity = glm::transpose(matrix) * matrix;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (!(std::abs(identity[i][j] - (i == j ? 1.0 : 0.0)) < 1e-4)) {
        return false;
      }
    }
  }
  return glm::determinant(matrix) > 0.0;
}

Result<std::unique_ptr<Rotation>> makeStatic(const TransformRequest& request) {
  const std::string place = request.place("Rotation");
  const Value* rotation = request.table.find("Rotation");
  const auto numbers = rotation != nullptr ? rotation->numbers() : std::nullopt;
  const std::size_t count = numbers ? numbers->size() : 0;
  if (count != 3 && count != 4 && count != 9) {
    return failure("expected a list of 3 (Euler angles), 4 (quaternion) or 9 (matrix) numbers", place,
                   "give the rotation in one of these forms");
  }
  const std::vector<double>& n = *numbers;
  glm::dmat3 matrix(1.0);
  if (count == 3) {
    matrix = fromEuler({n[0], n[1], n[2]});
  } else if (count == 4) {
    const glm::dquat quaternion(n[3], n[0], n[1], n[2]);
    const double length = glm::length(quaternion);
    if (!(std::isfinite(length) && length > 0.0)) {
      return failure("the quaternion has no finite length above zero", place, "give a unit quaternion x, y, z, w");
    }
    matrix = glm::mat3_cast(quaternion / length);
  } else {
    matrix = {{n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}};
  }
  if (!isRotation(matrix)) {
    return failure("the numbers are not a rotation", place,
                   "give an orthonormal, right-handed matrix or finite angles");
  }
  return std::make_unique<StaticRotation>(glm::mat3_cast(glm::normalize(glm::quat_cast(matrix))));
}

class ConstantRotation final : public Rotation {
 public:
  ConstantRotation(const glm::dvec3& axis, double rate)
      : axis_({"RotationAxis", "Rotation axis", "In the parent's frame"}, axis),
        rate_({"RotationRate", "Rotation rate", "Revolutions a second"}, rate) {
    addProperty(axis_);
    addProperty(rate_);
  }
  [[nodiscard]] glm::dmat3 matrix(const Time& time) const override {
    const double length = glm::length(axis_.get());
    if (!(length > 0.0)) {
      return glm::dmat3(1.0);
    }
    // Whole turns go first: the angle stays exact far from J2000.
    const double turns = std::fmod(time.tdbSeconds() * rate_.get(), 1.0);
    return glm::mat3_cast(glm::angleAxis(2.0 * std::numbers::pi * turns, axis_.get() / length));
  }

 private:
  Vec3Property axis_;
  FloatProperty rate_;
};

Result<std::unique_ptr<Rotation>> makeConstant(const TransformRequest& request) {
  const Value& table = request.table;
  static const Schema schema({{"RotationAxis", Type::Vector3, "In the parent's frame", true},
                              {"RotationRate", Type::Number, "Revolutions a second", true}});
  if (auto valid = schema.validate(table, request.where, request.path); !valid) {
    return tl::make_unexpected(valid.error());
  }
  const std::vector<double> axis = *table.find("RotationAxis")->numbers(3);
  const double rate = *table.find("RotationRate")->number();
  const double length = glm::length(glm::dvec3(axis[0], axis[1], axis[2]));
  if (!(std::isfinite(length) && length > 0.0 && std::isfinite(rate))) {
    return failure("the rotation axis and rate must be finite, and the axis not zero", request.place({}),
                   "give an axis such as {0, 0, 1}");
  }
  return std::make_unique<ConstantRotation>(glm::dvec3(axis[0], axis[1], axis[2]), rate);
}

class SpiceRotation final : public Rotation {
 public:
  SpiceRotation(ephemeris::Frame source, ephemeris::Frame destination, TransformClock clock)
      : source_(std::move(source)), destination_(std::move(destination)), clock_(clock) {}
  [[nodiscard]] glm::dmat3 matrix(const Time& time) const override {
    return ephemeris::rotationBetween(source_, destination_, clock_.at(time));
  }

 private:
  ephemeris::Frame source_;
  ephemeris::Frame destination_;
  TransformClock clock_;
};

Result<std::unique_ptr<Rotation>> makeSpice(const TransformRequest& request) {
  const Value& table = request.table;
  static const Schema schema({{"SourceFrame", Type::String, "The node's axes: IAU_EARTH", true},
                              {"DestinationFrame", Type::String, "The parent's axes: GALACTIC", true},
                              {"FixedDate", Type::String, "UTC date at which the body stands still"},
                              {"TimeOffset", Type::Number, "Seconds added to the scene's time"}});
  if (auto valid = schema.validate(table, request.where, request.path); !valid) {
    return tl::make_unexpected(valid.error());
  }
  const auto source = ephemeris::Frame::fromName(*table.find("SourceFrame")->string());
  const auto destination = ephemeris::Frame::fromName(*table.find("DestinationFrame")->string());
  const auto clock = TransformClock::fromTable(request);
  if (!clock) {
    return tl::make_unexpected(clock.error());
  }
  for (const auto* frame : {&source, &destination}) {
    if (!*frame) {
      warnOnce(request, "frame " + frame->error().what, frame->error().what + "; nodes in it are not turned");
      return std::make_unique<StaticRotation>(glm::dmat3(1.0));
    }
  }
  return std::make_unique<SpiceRotation>(*source, *destination, *clock);
}

class MultiRotation final : public Rotation {
 public:
  explicit MultiRotation(std::vector<std::unique_ptr<Rotation>> parts) : parts_(std::move(parts)) {}
  /// The first of them is applied first.
  [[nodiscard]] glm::dmat3 matrix(const Time& time) const override {
    glm::dmat3 product(1.0);
    for (const auto& part : parts_) {
      product = part->matrix(time) * product;
    }
    return product;
  }

 private:
  std::vector<std::unique_ptr<Rotation>> parts_;
};

Result<std::unique_ptr<Rotation>> makeMulti(const TransformRequest& request) {
  return makeParts<Rotation>(request, "Rotations", makeRotation).map([](auto parts) {
    return std::make_unique<MultiRotation>(std::move(parts));
  });
}

class TimelineRotation final : public Rotation {
 public:
  explicit TimelineRotation(Timeline<Rotation> timeline) : timeline_(std::move(timeline)) {}
  [[nodiscard]] glm::dmat3 matrix(const Time& time) const override {
    const auto [before, after, share] = timeline_.at(time);
    const glm::dmat3 from = before.matrix(time);
    if (!(share > 0.0)) {
      return from;
    }
    return glm::mat3_cast(glm::slerp(glm::quat_cast(from), glm::quat_cast(after.matrix(time)), share));
  }

 private:
  Timeline<Rotation> timeline_;
};

Result<std::unique_ptr<Rotation>> makeTimeline(const TransformRequest& request) {
  return Timeline<Rotation>::make(request, makeRotation).map([](auto timeline) {
    return std::make_unique<TimelineRotation>(std::move(timeline));
  });
}

constexpr std::array types = {TransformType<Rotation>{"StaticRotation", makeStatic},
                              TransformType<Rotation>{"ConstantRotation", makeConstant},
                              TransformType<Rotation>{"SpiceRotation", makeSpice},
                              TransformType<Rotation>{"FixedRotation", makeFixedRotation},
                              TransformType<Rotation>{"GlobeRotation", makeGlobeRotation},
                              TransformType<Rotation>{"LuaRotation", makeLuaRotation},
                              TransformType<Rotation>{"MultiRotation", makeMulti},
                              TransformType<Rotation>{"TimelineRotation", makeTimeline}};

}  // namespace

Result<std::unique_ptr<Rotation>> makeRotation(const TransformRequest& request) {
  return request.table.table()->list.empty() ? makeByType<Rotation>(request, types) : makeMulti(request);
}

}  // namespace meridian::scene
