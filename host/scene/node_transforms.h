#pragma once

#include <memory>
#include <string>
#include <string_view>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "host/api/error.h"
#include "host/api/property_owner.h"
#include "host/api/time.h"
#include "host/api/value.h"

namespace meridian::scene {

/// Where a node stands in its parent's frame. Its properties are at `Scene.NODE.Translation.*`.
class Translation : public PropertyOwner {
 public:
  Translation() : PropertyOwner("Translation") {}
  [[nodiscard]] virtual glm::dvec3 position(const Time& time) const = 0;  ///< metres
};

/// How a node's axes lie in its parent's frame. Its properties are at `Scene.NODE.Rotation.*`.
class Rotation : public PropertyOwner {
 public:
  Rotation() : PropertyOwner("Rotation") {}
  [[nodiscard]] virtual glm::dmat3 matrix(const Time& time) const = 0;  ///< parent-from-node, orthonormal
};

/// How many of the parent's units one of the node's is. Its properties are at `Scene.NODE.Scale.*`.
class Scale : public PropertyOwner {
 public:
  Scale() : PropertyOwner("Scale") {}
  [[nodiscard]] virtual double factor(const Time& time) const = 0;  ///< positive
};

/// From an asset's table, by its `Type`. Each type is one class and one line in the table of types beside it:
///   StaticTranslation {Position}, KeplerTranslation {Eccentricity, SemiMajorAxis (km), Inclination, AscendingNode,
///   ArgumentOfPeriapsis, MeanAnomaly (degrees), Epoch, Period}, SpiceTranslation {Target, Observer, Frame, FixedDate,
///   TimeOffset}: a body without a known position gives a warning and no translation;
///   StaticRotation {Rotation: 3 Euler angles in radians, a quaternion x, y, z, w, or a matrix of 9 by columns},
///   ConstantRotation {RotationAxis, RotationRate (revolutions per second)}, SpiceRotation {SourceFrame,
///   DestinationFrame, FixedDate, TimeOffset};
///   StaticScale {Scale}.
/// Errors: an unknown type, and one that OpenSpace has and a later version of ours will bring; bad keys.
[[nodiscard]] Result<std::unique_ptr<Translation>> makeTranslation(const Value& table, std::string_view where);
[[nodiscard]] Result<std::unique_ptr<Rotation>> makeRotation(const Value& table, std::string_view where);
[[nodiscard]] Result<std::unique_ptr<Scale>> makeScale(const Value& table, std::string_view where);

}  // namespace meridian::scene
