#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <stop_token>

#include "globebrowsing/source/kernel.h"
#include "globebrowsing/source/pyramid.h"
#include "globebrowsing/source/resample.h"

namespace meridian::globebrowsing {

/// The level of a picture that samples are made from, and by how much kernels are wider than a pixel of it.
struct Sampling {
  std::size_t level = 0;
  double stretchX = 1.0;
  double stretchY = 1.0;

  bool operator==(const Sampling&) const = default;
};

/// The angle between the tile's samples, the same for every tile of a level whatever its shape.
[[nodiscard]] double nominalSpacing(const Tiling& tiling, const TileIndex& index, const TileLayout& layout);

/// How far apart a tile's samples are.
struct SampleSpacing {
  double nominal = 0.0;
  /// Radians of longitude between columns. 0: as far as rows, and only place and level count, so that tiles of unlike
  /// width agree on their shared nodes.
  double columns = 0.0;
};
/// One sampling for the whole picture. Not for pictures that are chosen by place.
[[nodiscard]] Sampling chooseSampling(const Pyramid& pyramid, const SampleSpacing& spacing);
/// For samples on a parallel; the picture is geographic. Where it is chosen by place, the answer changes by steps, so
/// that many rows in turn have the same.
[[nodiscard]] Sampling chooseSampling(const Pyramid& pyramid, const SampleSpacing& spacing, double latitude);
/// For a sample at a place of full resolution.
[[nodiscard]] Sampling chooseSampling(const Pyramid& pyramid, const SampleSpacing& spacing, double column, double row);

/// Whether the picture, which is chosen by place, has finer pixels there than samples are apart; a projected one,
/// anywhere.
[[nodiscard]] bool isFinerAt(const Pyramid& pyramid, const SampleSpacing& spacing, const GeodeticPosition& place);

/// Whether the picture reaches into the tile; may be true for a near miss, never false for a hit.
[[nodiscard]] bool reaches(const RasterGeoreference& georeference, const Tiling& tiling, const TileIndex& index);

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

/// Samples at arbitrary places, given in pixels of full resolution; outside the raster nothing is written. `out` is
/// null for a plan, here and below.
[[nodiscard]] Result<void> samplePoints(PixelReader& reader, const Sampling& sampling, std::span<const double> columns,
                                        std::span<const double> rows, Rgba* out, const std::stop_token& stop);
[[nodiscard]] Result<void> samplePoints(PixelReader& reader, const Sampling& sampling, std::span<const double> columns,
                                        std::span<const double> rows, float* out, const std::stop_token& stop);

struct TileRequest {
  const Tiling& tiling;
  TileIndex index;
  TileLayout layout;
};
/// A tile whose columns are meridians and rows parallels, from a picture alike.
[[nodiscard]] Result<void> sampleRows(PixelReader& reader, const TileRequest& tile, Rgba* out,
                                      const std::stop_token& stop);
[[nodiscard]] Result<void> sampleRows(PixelReader& reader, const TileRequest& tile, float* out,
                                      const std::stop_token& stop);

/// Any tile from any picture.
[[nodiscard]] Result<void> sampleTile(PixelReader& reader, const TileRequest& tile, Rgba* out,
                                      const std::stop_token& stop);
[[nodiscard]] Result<void> sampleTile(PixelReader& reader, const TileRequest& tile, float* out,
                                      const std::stop_token& stop);

/// The whole of resampleColours and resampleHeights; the picture overlaps the tile.
[[nodiscard]] Result<ColourPixels> readColours(PixelReader& reader, const TileRequest& tile,
                                               const std::stop_token& stop);
[[nodiscard]] Result<HeightPixels> readHeights(PixelReader& reader, const TileRequest& tile,
                                               const std::stop_token& stop);

}  // namespace meridian::globebrowsing
