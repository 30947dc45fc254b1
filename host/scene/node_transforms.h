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

class Scene;

/// What a transform is made from.
struct TransformRequest {
  Value table;
  std::string where;             ///< the asset's file and line, for errors
  std::string path;              ///< of the table within the node's: "Transform.Translation"
  std::string folder;            ///< of the asset file; relative paths start there
  std::string node;              ///< the identifier of the node that is being made
  const Scene* scene = nullptr;  ///< outlives the transform; null: there are no other nodes

  /// The place of a key for errors: "earth.asset:12: Transform.Translation.Position".
  [[nodiscard]] std::string place(std::string_view key) const {
    return where + ": " + path + (key.empty() ? "" : ".") + std::string(key);
  }
};

/// From an asset's table, by its `Type`. Each type is one class and one line in the table of types beside it:
///   StaticTranslation {Position}, KeplerTranslation {Eccentricity, SemiMajorAxis (km), Inclination, AscendingNode,
///   ArgumentOfPeriapsis, MeanAnomaly (degrees), Epoch, Period}, SpiceTranslation {Target, Observer, Frame, FixedDate,
///   TimeOffset}: a body without a known position gives a warning and no translation;
///   StaticRotation {Rotation: 3 Euler angles in radians, a quaternion x, y, z, w, or a matrix of 9 by columns},
///   ConstantRotation {RotationAxis, RotationRate (revolutions per second)}, SpiceRotation {SourceFrame,
///   DestinationFrame, FixedDate, TimeOffset};
///   StaticScale {Scale}, NonUniformStaticScale {Scale}: the geometric mean, for our frames are similarities,
///   TimeDependentScale {ReferenceDate, Speed, ClampToPositive};
///   GlobeTranslation and GlobeRotation (globe_transforms.h), FixedRotation (fixed_rotation.h);
///   Lua* {Script} (lua_transforms.h), Multi* {Translations, Rotations, Scales} and Timeline* {Keyframes,
///   ShouldInterpolate} (composed_transforms.h); a list of tables is a Multi*;
///   GPTranslation and HorizonsTranslation, which need files that we do not read: a warning and no translation.
/// Scales stay within 1e-30 .. 1e30, whatever an asset says. Errors: an unknown type; bad keys.
[[nodiscard]] Result<std::unique_ptr<Translation>> makeTranslation(const TransformRequest& request);
[[nodiscard]] Result<std::unique_ptr<Rotation>> makeRotation(const TransformRequest& request);
[[nodiscard]] Result<std::unique_ptr<Scale>> makeScale(const TransformRequest& request);

}  // namespace meridian::scene
