#pragma once

#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include "globebrowsing/source/raster_georeference.h"
#include "globebrowsing/source/raster_reader.h"

namespace meridian::globebrowsing {

/// One resolution of a picture.
struct PyramidLevel {
  int width = 0;
  int height = 0;
  double scaleX = 1.0;  ///< pixels of full resolution in one of this level
  double scaleY = 1.0;
  /// Of full resolution's upper left corner, in pixels of this level: levels need not share their corners.
  double offsetX = 0.0;
  double offsetY = 0.0;

  /// Where a place in pixels of full resolution is on this level, pixel i centred on i.
  [[nodiscard]] double centreX(double column) const { return column / scaleX + offsetX - 0.5; }
  [[nodiscard]] double centreY(double row) const { return row / scaleY + offsetY - 0.5; }
};

/// A picture of (part of) a globe at several resolutions, without its pixels.
struct Pyramid {
  std::string where;  ///< for errors
  RasterGeoreference georeference;
  std::vector<PyramidLevel> levels{};  ///< finest first; the first is full resolution but for its offset
  /// Every level costs transfers: then the level is that whose pixels cover as much as a sample does where the sample
  /// lies, whatever the projection stretches. Else that whose pixels at the picture's middle are no larger than
  /// samples.
  bool isChosenByPlace = false;

  /// Columns of a whole turn at that level; 0 when the picture does not go round.
  [[nodiscard]] int columnsOfTurn(const PyramidLevel& level) const;
};

/// Columns and rows of a level that may run over its edges: x beyond a whole turn goes round, y beyond a pole goes down
/// the other side, anything else repeats the edge.
using UnboundedWindow = PixelWindow;

/// A part of an unbounded window that lies in one piece within the level.
struct WindowPiece {
  PixelWindow from;
  int column = 0;  ///< of its first pixel in the window
  int row = 0;
};
[[nodiscard]] std::vector<WindowPiece> piecesOf(const Pyramid& pyramid, std::size_t level,
                                                const UnboundedWindow& window);

/// The pixels of a pyramid, for one thread at a time: all that resampling needs of whatever has pixels.
class PixelReader {
 public:
  virtual ~PixelReader() = default;
  [[nodiscard]] virtual const Pyramid& pyramid() const = 0;
  /// Null when the georeference needs none.
  [[nodiscard]] virtual const Projection* projection() const = 0;
  /// A plan has no pixels: fetch notes the windows and leaves `out`, which is null, alone. It is asked for each
  /// sample's own pixels, so that it notes none that no sample needs.
  [[nodiscard]] virtual bool isPlan() const { return false; }
  /// `out`: rows of window.width pixels.
  [[nodiscard]] virtual Result<void> fetch(std::size_t level, const UnboundedWindow& window, Rgba* out,
                                           const std::stop_token& stop) = 0;
  [[nodiscard]] virtual Result<void> fetch(std::size_t level, const UnboundedWindow& window, float* out,
                                           const std::stop_token& stop) = 0;
};

}  // namespace meridian::globebrowsing
