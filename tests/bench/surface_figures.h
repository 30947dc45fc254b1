#pragma once

#include <cstddef>
#include <vector>

#include "settled_globe.h"

namespace meridian::bench {

/// What a settled view draws.
struct SurfaceFigures {
  std::size_t chunks = 0;
  std::size_t triangles = 0;  ///< skirts excluded
  std::size_t skirtTriangles = 0;
  std::size_t coveredPixels = 0;
  /// Texels per pixel along a side, at places all over the picture, ascending; never empty.
  std::vector<double> texelDensities{1.0};
  std::size_t normals = 0;   ///< texels of all chunks' normals, at the level that each is drawn with
  bool mostlyNight = false;  ///< whether more chunks are drawn with night layers than without
  double errorPixels = 0.0;  ///< greatest distance on screen from the surface drawn with a grid four times denser
};

/// The value that `part` (0..1) of them are below.
[[nodiscard]] double quantile(const std::vector<double>& ascending, double part);

[[nodiscard]] SurfaceFigures measureSurface(SettledGlobe& globe, glm::ivec2 size);

}  // namespace meridian::bench
