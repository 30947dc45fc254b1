#pragma once

#include <filesystem>

#include <glm/vec3.hpp>

#include "relief.h"

namespace meridian::globebrowsing::test {

/// A small square with much finer waves of colour than its surroundings, in degrees about its middle.
struct Spot {
  double latitude = 0.0;
  double longitude = 0.0;
  double half = 0.0;   ///< of its width; 0: there is none
  double waves = 0.0;  ///< in half its width
};

/// A body whose colour and relief are known everywhere: smooth functions of the ellipsoid's normal, so without a seam
/// at the antimeridian or a pinch at the poles. All that is asked of it here is worked out without the product's code.
struct SmoothWorld {
  const char* name = "";
  glm::dvec3 radii{1.0};        ///< metres
  double relief = 0.0;          ///< metres: heights are within +-relief
  double waves = 1.0;           ///< of the relief in a radian of the normal; the least slope is relief * waves / radius
  bool nodeRegistered = false;  ///< its height raster has values on both poles and both sides of the antimeridian
  Spot spot{};
  int columns = 2048;  ///< of the global rasters, half as many rows; and of the spot's, with as many rows

  /// Metres above the ellipsoid, where its unit normal is `normal`.
  [[nodiscard]] double height(const glm::dvec3& normal) const;
  /// RGB, 0..255: red in wide, green in middling, blue in narrow waves, none below 50 or above 230; in the spot up to
  /// 20 more or less of each.
  [[nodiscard]] glm::dvec3 colour(const glm::dvec3& normal) const;
  /// The same for rays.
  [[nodiscard]] Relief surface() const;

  /// Writes the functions as GeoTIFFs, global ones and one of the spot. Throws std::runtime_error when GDAL cannot.
  void writeColours(const std::filesystem::path& file) const;
  void writeSpot(const std::filesystem::path& file) const;
  void writeHeights(const std::filesystem::path& file) const;
};

}  // namespace meridian::globebrowsing::test
