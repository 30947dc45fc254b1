#include "host/navigation/geodetic_pose.h"

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace meridian::navigation {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
/// Nearer to straight up or down than this the heading is the camera's up.
constexpr double verticalLimit = 1e-9;

/// East, north and up at a place, as columns. By the angles alone, so that it is defined at the poles.
glm::dmat3 localAxes(double latitude, double longitude) {
  const double sinLat = std::sin(latitude);
  const double cosLat = std::cos(latitude);
  const double sinLon = std::sin(longitude);
  const double cosLon = std::cos(longitude);
  return {
      {-sinLon, cosLon, 0.0}, {-sinLat * cosLon, -sinLat * sinLon, cosLat}, {cosLat * cosLon, cosLat * sinLon, sinLat}};
}

}  // namespace

Pose poseFromGeodetic(const Ground& ground, const GeodeticPose& pose) {
  const double sinHeading = std::sin(pose.heading);
  const double cosHeading = std::cos(pose.heading);
  const double sinPitch = std::sin(pose.pitch);
  const double cosPitch = std::cos(pose.pitch);
  const glm::dvec3 ahead(sinHeading * cosPitch, cosHeading * cosPitch, sinPitch);
  const glm::dvec3 right(cosHeading, -sinHeading, 0.0);
  const glm::dvec3 up = glm::cross(right, ahead);
  const double sinRoll = std::sin(pose.roll);
  const double cosRoll = std::cos(pose.roll);
  const glm::dmat3 localFromCamera(cosRoll * right - sinRoll * up, sinRoll * right + cosRoll * up, -ahead);
  const glm::dmat3 axes = localAxes(pose.position.latitude, pose.position.longitude);
  return {ground.cartesian(pose.position), glm::normalize(glm::quat_cast(axes * localFromCamera))};
}

GeodeticPose geodeticFromPose(const Ground& ground, const Pose& pose) {
  GeodeticPose result;
  result.position = ground.geodetic(pose.position);
  const glm::dmat3 localFromModel = glm::transpose(localAxes(result.position.latitude, result.position.longitude));
  const glm::dvec3 ahead = localFromModel * pose.ahead();
  const glm::dvec3 up = localFromModel * pose.up();
  const double level = std::hypot(ahead.x, ahead.y);
  result.pitch = std::atan2(ahead.z, level);
  if (level < verticalLimit) {
    // Looking down, up points where one would look when raising the head; looking up, the other way.
    const double sign = ahead.z < 0.0 ? 1.0 : -1.0;
    result.heading = std::atan2(sign * up.x, sign * up.y);
    return result;
  }
  result.heading = std::atan2(ahead.x, ahead.y);
  const glm::dvec3 levelRight(ahead.y / level, -ahead.x / level, 0.0);
  result.roll = std::atan2(glm::dot(up, levelRight), glm::dot(up, glm::cross(levelRight, ahead)));
  return result;
}

Result<GeodeticPose> geodeticPoseFromText(std::string_view text) {
  constexpr std::string_view remedy =
      "write LAT,LON,ALT or LAT,LON,ALT,HEADING,PITCH, degrees and metres: 27.9,86.9,20000,0,-30";
  std::array<double, 5> numbers{0.0, 0.0, 0.0, 0.0, -90.0};
  std::size_t count = 0;
  for (std::string_view rest = text; count < numbers.size();) {
    const std::size_t comma = rest.find(',');
    std::string_view part = rest.substr(0, comma);
    while (part.starts_with(' ')) {
      part.remove_prefix(1);
    }
    while (part.ends_with(' ')) {
      part.remove_suffix(1);
    }
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), numbers[count]);
    if (error != std::errc() || end != part.data() + part.size() || !std::isfinite(numbers[count])) {
      return failure("expected a finite number, found '" + std::string(part) + "'", std::string(text),
                     std::string(remedy));
    }
    ++count;
    if (comma == std::string_view::npos) {
      rest = {};
      break;
    }
    rest.remove_prefix(comma + 1);
    if (count == numbers.size()) {
      return failure("expected 3 or 5 numbers, found more", std::string(text), std::string(remedy));
    }
  }
  if (count != 3 && count != 5) {
    return failure("expected 3 or 5 numbers, found " + std::to_string(count), std::string(text), std::string(remedy));
  }
  if (std::abs(numbers[0]) > 90.0 || std::abs(numbers[4]) > 90.0 || std::abs(numbers[1]) > 360.0) {
    return failure("a latitude or pitch outside -90..90 or a longitude outside -360..360", std::string(text),
                   std::string(remedy));
  }
  return GeodeticPose{{numbers[0] * degree, std::remainder(numbers[1], 360.0) * degree, numbers[2]},
                      std::remainder(numbers[3], 360.0) * degree,
                      numbers[4] * degree};
}

}  // namespace meridian::navigation
