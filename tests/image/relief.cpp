#include "relief.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace meridian::globebrowsing::test {

namespace {

constexpr double degree = std::numbers::pi / 180.0;

}  // namespace

Foot footOf(const glm::dvec3& position, const glm::dvec3& radii) {
  const glm::dvec3 squares = radii * radii;
  // The foot is r^2 p / (r^2 + t), where t makes the sum of (r p / (r^2 + t))^2 one; here the sum is not below one.
  double t = std::max({radii.x * std::abs(position.x) - squares.x, radii.y * std::abs(position.y) - squares.y,
                       radii.z * std::abs(position.z) - squares.z});
  glm::dvec3 scaled{0.0};
  for (int i = 0; i < 60; ++i) {
    const glm::dvec3 divided = 1.0 / (squares + t);
    scaled = radii * position * divided;
    const double excess = glm::dot(scaled, scaled) - 1.0;
    const double step = excess / (2.0 * glm::dot(scaled * scaled, divided));
    t += step;
    if (std::abs(step) <= 1e-15 * squares.x) {
      break;
    }
  }
  const glm::dvec3 outward = position / (squares + t);
  const double length = glm::length(outward);
  return {outward / length, t * length};
}

glm::dvec3 normalAt(double latitudeDegrees, double longitudeDegrees) {
  const double latitude = latitudeDegrees * degree;
  const double longitude = longitudeDegrees * degree;
  return {std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude)};
}

glm::dvec3 positionOf(const glm::dvec3& normal, double height, const glm::dvec3& radii) {
  return radii * radii * normal / glm::length(radii * normal) + height * normal;
}

std::optional<glm::dvec3> firstHit(const Relief& relief, const glm::dvec3& origin, const glm::dvec3& direction,
                                   double precision) {
  const double outer = std::max({relief.radii.x, relief.radii.y, relief.radii.z}) + relief.highest;
  const double along = -glm::dot(origin, direction);
  const glm::dvec3 nearest = origin + direction * along;
  const double half = outer * outer - glm::dot(nearest, nearest);
  if (half < 0.0 || along + std::sqrt(half) < 0.0) {
    return std::nullopt;
  }
  const double last = along + std::sqrt(half);
  const double safe = 1.0 / (1.0 + relief.steepest);
  for (double t = std::max(0.0, along - std::sqrt(half)); t <= last;) {
    const Foot foot = footOf(origin + direction * t, relief.radii);
    const double clearance = foot.height - relief.height(foot.normal);
    if (clearance <= precision * t) {
      return foot.normal;
    }
    t += safe * clearance;
  }
  return std::nullopt;
}

}  // namespace meridian::globebrowsing::test
