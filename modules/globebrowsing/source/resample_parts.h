#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <stop_token>

#include "globebrowsing/source/kernel.h"
#include "globebrowsing/source/raster_access.h"

namespace meridian::globebrowsing {

/// The level of a raster that a tile is made from, and by how much kernels are wider than a pixel of it.
struct Sampling {
  std::size_t level = 0;
  double stretchX = 1.0;
  double stretchY = 1.0;
};

/// The angle between the tile's samples, the same for every tile of a level whatever its shape.
[[nodiscard]] double nominalSpacing(const Tiling& tiling, const TileIndex& index, const TileLayout& layout);
/// `columnSpacing` at least the nominal one: that of columns where they are set wider than rows.
[[nodiscard]] Sampling chooseSampling(const RasterAccess& access, double spacing, double columnSpacing);

/// A sample's colour, premultiplied by its alpha of 0..1.
struct ColourSum {
  float red = 0.0F;
  float green = 0.0F;
  float blue = 0.0F;
  float alpha = 0.0F;
};
[[nodiscard]] Rgba toRgba(const ColourSum& sum);

inline constexpr float noHeight = std::numeric_limits<float>::quiet_NaN();
/// Of the triangle's weight that must be present for a height.
inline constexpr double leastPresent = 0.5 - 1e-9;

/// Whether that column or row of full resolution, counted from an edge, is within the raster (or on its very edge).
[[nodiscard]] inline bool isWithin(double place, int size) {
  return place >= -1e-6 && place <= size + 1e-6;
}

/// Samples at arbitrary places, given in pixels of full resolution; outside the raster nothing is written.
[[nodiscard]] Result<void> samplePoints(const RasterAccess& access, RasterHandle& handle, const Sampling& sampling,
                                        std::span<const double> columns, std::span<const double> rows, Rgba* out,
                                        const std::stop_token& stop);
[[nodiscard]] Result<void> samplePoints(const RasterAccess& access, RasterHandle& handle, const Sampling& sampling,
                                        std::span<const double> columns, std::span<const double> rows, float* out,
                                        const std::stop_token& stop);

/// A tile whose columns are meridians and rows parallels, from a raster alike.
struct TileRequest {
  const Tiling& tiling;
  TileIndex index;
  TileLayout layout;
};
[[nodiscard]] Result<void> sampleRows(const RasterAccess& access, RasterHandle& handle, const TileRequest& tile,
                                      Rgba* out, const std::stop_token& stop);
[[nodiscard]] Result<void> sampleRows(const RasterAccess& access, RasterHandle& handle, const TileRequest& tile,
                                      float* out, const std::stop_token& stop);

}  // namespace meridian::globebrowsing
