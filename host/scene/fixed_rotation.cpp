#include "host/scene/fixed_rotation.h"

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <glm/geometric.hpp>

#include "host/api/schema.h"
#include "host/scene/scene.h"

namespace meridian::scene {

namespace {

constexpr std::array<std::string_view, 3> axisNames{"XAxis", "YAxis", "ZAxis"};

struct Axis {
  std::variant<std::monostate, glm::dvec3, std::string> direction;  ///< nothing, a vector, or a node
  bool orthogonal = false;
  bool inverted = false;
};

std::optional<glm::dvec3> unit(const glm::dvec3& vector) {
  const double length = glm::length(vector);
  return std::isfinite(length) && length > 0.0 ? std::optional(vector / length) : std::nullopt;
}

bool flag(const Value& table, const std::string& key) {
  const Value* value = table.find(key);
  return value != nullptr && value->boolean().value_or(false);
}

Result<Axis> readAxis(const TransformRequest& request, std::string_view name) {
  const std::string key(name);
  Axis axis;
  axis.orthogonal = flag(request.table, key + "Orthogonal");
  axis.inverted = flag(request.table, key + "Invert");
  const Value* value = request.table.find(key);
  if (value == nullptr) {
    return axis;
  }
  if (const std::string* node = value->string()) {
    axis.direction = *node;
  } else if (const auto numbers = value->numbers(3)) {
    axis.direction = glm::dvec3((*numbers)[0], (*numbers)[1], (*numbers)[2]);
  } else {
    return failure("expected the identifier of a node or a list of 3 numbers", request.place(name));
  }
  return axis;
}

class FixedRotation final : public Rotation {
 public:
  FixedRotation(const Scene* scene, std::string attached, std::array<Axis, 3> axes)
      : scene_(scene), attached_(std::move(attached)), axes_(std::move(axes)) {}

  [[nodiscard]] glm::dmat3 matrix(const Time& /*time*/) const override {
    std::array<std::optional<glm::dvec3>, 3> given;
    for (std::size_t i = 0; i < 3; ++i) {
      given[i] = direction(axes_[i]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& other = given[(i + 1) % 3] ? given[(i + 1) % 3] : given[(i + 2) % 3];
      if (axes_[i].orthogonal && given[i] && other) {
        given[i] = unit(*given[i] - glm::dot(*given[i], *other) * *other);
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (!given[i] && given[(i + 1) % 3] && given[(i + 2) % 3]) {
        given[i] = unit(glm::cross(*given[(i + 1) % 3], *given[(i + 2) % 3]));
      }
    }
    for (std::size_t i = 0; i < 3; ++i) {
      if (given[i] && !given[(i + 1) % 3] && !given[(i + 2) % 3]) {
        const glm::dvec3 aside = std::abs(given[i]->z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
        given[(i + 1) % 3] = unit(glm::cross(aside, *given[i]));
        given[(i + 2) % 3] = unit(glm::cross(*given[i], *given[(i + 1) % 3]));
        break;
      }
    }
    return given[0] && given[1] && given[2] ? frameFrom(*given[0], *given[1]) : glm::dmat3(1.0);
  }

 private:
  /// Orthonormal and right-handed whatever the asset gave: a third axis that contradicts is replaced.
  static glm::dmat3 frameFrom(const glm::dvec3& x, const glm::dvec3& y) {
    const auto straight = unit(y - glm::dot(y, x) * x);
    return straight ? glm::dmat3(x, *straight, glm::cross(x, *straight)) : glm::dmat3(1.0);
  }

  [[nodiscard]] std::optional<glm::dvec3> direction(const Axis& axis) const {
    std::optional<glm::dvec3> found;
    if (const auto* vector = std::get_if<glm::dvec3>(&axis.direction)) {
      found = unit(*vector);
    } else if (const auto* node = std::get_if<std::string>(&axis.direction)) {
      found = towards(*node);
    }
    return found && axis.inverted ? -*found : found;
  }

  /// In the frame of the attached node's parent.
  [[nodiscard]] std::optional<glm::dvec3> towards(const std::string& identifier) const {
    const SceneNode* from = scene_ != nullptr ? scene_->node(attached_) : nullptr;
    const SceneNode* to = scene_ != nullptr ? scene_->node(identifier) : nullptr;
    if (from == nullptr || to == nullptr || from->parentNode() == nullptr) {
      return std::nullopt;
    }
    return unit(Scene::relativeTransform(*to, *from->parentNode()).translation - from->parentFromNode().translation);
  }

  const Scene* scene_;
  std::string attached_;
  std::array<Axis, 3> axes_;
};

}  // namespace

Result<std::unique_ptr<Rotation>> makeFixedRotation(const TransformRequest& request) {
  static const Schema schema(
      {{"Attached", Schema::Type::String, "The node from which directions to others are taken"}});
  if (auto valid = schema.validate(request.table, request.where, request.path); !valid) {
    return tl::make_unexpected(valid.error());
  }
  std::array<Axis, 3> axes;
  for (std::size_t i = 0; i < 3; ++i) {
    auto axis = readAxis(request, axisNames[i]);
    if (!axis) {
      return tl::make_unexpected(axis.error());
    }
    axes[i] = std::move(*axis);
  }
  const Value* attached = request.table.find("Attached");
  return std::make_unique<FixedRotation>(request.scene, attached != nullptr ? *attached->string() : request.node,
                                         std::move(axes));
}

}  // namespace meridian::scene
