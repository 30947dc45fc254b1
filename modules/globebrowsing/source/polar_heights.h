#pragma once

#include "globebrowsing/source/pyramid.h"

namespace meridian::globebrowsing {

/// Heights of a picture in degrees, smoothed along the parallels where these are short.
///
/// Columns of such a picture meet at the poles, so there neighbouring pixels are much nearer to each other than rows
/// are, and than what was measured: their noise and rounding would be steep ridges that run to the pole. Each row is
/// convolved with a triangle whose half width in columns is the ratio of a pixel's height to its width on the ground,
/// less 2: nothing changes before meridians are three times as close as on the equator (70 degrees in a picture of
/// square pixels), and near the pole what is left is as coarse along the parallel as along the meridian. It depends on
/// row and level alone, so neighbouring tiles agree. Pixels without a height stay so, and do not count.
class PolarHeights final : public PixelReader {
 public:
  /// The reader outlives it.
  explicit PolarHeights(PixelReader& reader) : reader_(reader) {}
  /// Whether the picture is of that kind. One that is chosen by place is left alone: near the poles it is read from
  /// coarser levels.
  [[nodiscard]] static bool concerns(const Pyramid& pyramid);

  [[nodiscard]] const Pyramid& pyramid() const override { return reader_.pyramid(); }
  [[nodiscard]] const Projection* projection() const override { return reader_.projection(); }
  [[nodiscard]] bool isPlan() const override { return reader_.isPlan(); }
  [[nodiscard]] Result<void> fetch(std::size_t level, const UnboundedWindow& window, Rgba* out,
                                   const std::stop_token& stop) override {
    return reader_.fetch(level, window, out, stop);
  }
  [[nodiscard]] Result<void> fetch(std::size_t level, const UnboundedWindow& window, float* out,
                                   const std::stop_token& stop) override;

 private:
  /// Of the triangle, in columns; at most 1 where nothing is smoothed.
  [[nodiscard]] double halfWidth(const PyramidLevel& level, int row) const;

  PixelReader& reader_;
};

}  // namespace meridian::globebrowsing
