#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "globebrowsing/source/raster_source.h"

class GDALDataset;
class GDALRasterBand;

namespace meridian::globebrowsing {

using Rgba = std::array<std::uint8_t, 4>;  ///< not premultiplied; alpha 0 where there are no data

/// Pixels of a level, columns from x, rows from y.
struct PixelWindow {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  bool operator==(const PixelWindow&) const = default;
};

/// How a raster's bands become colours.
struct ColourRule {
  std::array<int, 3> bands{1, 1, 1};  ///< of red, green and blue
  int alphaBand = 0;                  ///< 0: none
  std::vector<Rgba> palette{};
  bool isByte = true;  ///< values are taken as they are
  std::array<double, 4> scale{1, 1, 1, 1};
  std::array<double, 4> offset{};
  std::array<std::optional<double>, 3> noData{};
  bool hasMask = false;

  [[nodiscard]] bool isGrey() const { return bands[0] == bands[1] && bands[1] == bands[2]; }
};

/// How band 1 becomes metres.
struct HeightRule {
  double scale = 1.0;
  double offset = 0.0;
  std::optional<double> noData{};
  bool isSignedByte = false;  ///< bytes over 127 are negative
  bool isWide = false;        ///< values need a double
  bool hasMask = false;
  HeightLimits limits{};  ///< metres; what is beyond has no data
};

/// What was found wrong while reading, beside errors.
struct ReadNotes {
  std::optional<double> implausible{};  ///< metres, beyond the limits
  std::string warning{};                ///< of GDAL's
};

/// From the bands' descriptions; for samples without a natural range also from their statistics, which may read.
[[nodiscard]] Result<ColourRule> colourRule(GDALDataset& dataset, const std::string& where);
[[nodiscard]] HeightRule heightRule(GDALDataset& dataset, const RasterDescription& description);

/// What of a raster is read: a window of its overview of that number (-1: full resolution), of `step` x `step` pixels
/// only the nearest one.
struct ReadRequest {
  int overview = -1;
  PixelWindow window{};
  int step = 1;
  [[nodiscard]] int columns() const { return (window.width - 1) / step + 1; }
  [[nodiscard]] int rows() const { return (window.height - 1) / step + 1; }
};

/// Read into rows of request.columns() pixels. Adds to the notes.
[[nodiscard]] Result<void> readPixels(GDALDataset& dataset, const ColourRule& rule, const ReadRequest& request,
                                      Rgba* out, const std::string& where, ReadNotes& notes);
[[nodiscard]] Result<void> readPixels(GDALDataset& dataset, const HeightRule& rule, const ReadRequest& request,
                                      float* out, const std::string& where, ReadNotes& notes);

}  // namespace meridian::globebrowsing
