#pragma once

#include <vector>

#include "globebrowsing/source/raster_reader.h"

namespace meridian::globebrowsing {

/// One resolution of a raster, and where it comes from.
struct RasterLevel {
  int width = 0;
  int height = 0;
  double scaleX = 1.0;  ///< pixels of full resolution in one of this level
  double scaleY = 1.0;
  int overview = -1;  ///< of GDAL's that it is, or that it is averaged from; -1: full resolution
  int factor = 1;     ///< so many by so many of that one's pixels are averaged into one of this
};

/// Full resolution, the overviews that the dataset has, and averaged levels beyond the coarsest of these; finest first.
[[nodiscard]] std::vector<RasterLevel> rasterLevels(GDALDataset& dataset);

/// Averages blocks of factor x factor of `from` (width x height, factor columns of a row make one; the last of a row or
/// column may be of fewer) into `to`. Absent pixels drop out; colours are weighted by their alpha.
void reduce(const Rgba* from, int width, int height, int factor, Rgba* to);
void reduce(const float* from, int width, int height, int factor, float* to);

}  // namespace meridian::globebrowsing
