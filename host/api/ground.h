#pragma once

#include <cstddef>
#include <optional>

#include <glm/vec3.hpp>

#include "host/api/geodetic_position.h"
#include "host/api/settled.h"

namespace meridian {

/// What the host may ask of a globe: so cameras, flights and placed nodes work on any body without knowing how it is
/// drawn. Positions are in the globe's model space: metres, +z the north pole, +x the prime meridian.
class Ground {
 public:
  virtual ~Ground() = default;

  /// The reference ellipsoid's semi-axes along x, y and z.
  [[nodiscard]] virtual glm::dvec3 radii() const = 0;
  [[nodiscard]] virtual glm::dvec3 cartesian(const GeodeticPosition& position) const = 0;
  [[nodiscard]] virtual GeodeticPosition geodetic(const glm::dvec3& position) const = 0;
  /// The ellipsoid's outward unit normal.
  [[nodiscard]] virtual glm::dvec3 normal(double latitude, double longitude) const = 0;

  /// Metres of the drawn surface above the ellipsoid, from the finest height tile in memory there; 0 without any.
  [[nodiscard]] virtual double heightAt(double latitude, double longitude) const = 0;
  /// The first point of the drawn surface that the ray meets; `direction` need not be of unit length.
  [[nodiscard]] virtual std::optional<glm::dvec3> pick(const glm::dvec3& origin, const glm::dvec3& direction) const = 0;

  /// Of the last frame's view of that number.
  [[nodiscard]] virtual Settled settled(std::size_t view) const = 0;
};

}  // namespace meridian
