#pragma once

#include <cmath>

#include <GeographicLib/Geocentric.hpp>
#include <glm/geometric.hpp>

#include "host/api/renderable.h"

namespace meridian::test {

/// WGS84 by GeographicLib, with terrain of one height everywhere.
class SmoothGround final : public Renderable, public Ground {
 public:
  explicit SmoothGround(double terrain = 0.0) : Renderable("SmoothGround"), terrain_(terrain) {}
  [[nodiscard]] Ground* ground() override { return this; }
  [[nodiscard]] double boundingSphere() const override { return 6378137.0; }
  [[nodiscard]] glm::dvec3 radii() const override { return {6378137.0, 6378137.0, 6356752.314245}; }
  [[nodiscard]] glm::dvec3 cartesian(const GeodeticPosition& p) const override {
    glm::dvec3 result;
    GeographicLib::Geocentric::WGS84().Forward(p.latitude / degree, p.longitude / degree, p.height, result.x, result.y,
                                               result.z);
    return result;
  }
  [[nodiscard]] GeodeticPosition geodetic(const glm::dvec3& p) const override {
    GeodeticPosition result;
    GeographicLib::Geocentric::WGS84().Reverse(p.x, p.y, p.z, result.latitude, result.longitude, result.height);
    return {result.latitude * degree, result.longitude * degree, result.height};
  }
  [[nodiscard]] glm::dvec3 normal(double latitude, double longitude) const override {
    return {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude)};
  }
  [[nodiscard]] double heightAt(double /*latitude*/, double /*longitude*/) const override { return terrain_; }
  [[nodiscard]] std::optional<glm::dvec3> pick(const glm::dvec3&, const glm::dvec3&) const override {
    return std::nullopt;
  }
  [[nodiscard]] Settled settled(std::size_t /*view*/) const override { return {}; }

 private:
  static constexpr double degree = 3.14159265358979323846 / 180.0;
  double terrain_;
};

}  // namespace meridian::test
