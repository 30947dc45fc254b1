#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "globebrowsing/source/pyramid.h"
#include "globebrowsing/source/tile_service.h"

namespace meridian::globebrowsing {

/// A tile of a level, and what of it lies in a window.
struct TilePart {
  TileAddress address;
  PixelWindow pixels;  ///< of the level
  int column = 0;      ///< of its first pixel, within the tile
  int row = 0;
};

/// A tile service as a pyramid of pixels: its extent is the picture, its finest matrix full resolution, each matrix a
/// level with a corner and a scale of its own. Matrices need neither nest nor share a corner, nor end where the globe
/// does. Immutable, safe from any thread.
class ServicePyramid {
 public:
  /// Matrices that would be wider than 2^30 pixels within the extent are left out. Errors: no matrix that is usable, a
  /// CRS that PROJ rejects, an extent outside the globe.
  [[nodiscard]] static Result<ServicePyramid> of(const TileService& service);

  [[nodiscard]] const Pyramid& pyramid() const { return pyramid_; }
  /// Pixels of its tiles.
  [[nodiscard]] int tileWidth(std::size_t level) const { return levels_[level].matrix.tileWidth; }
  [[nodiscard]] int tileHeight(std::size_t level) const { return levels_[level].matrix.tileHeight; }

  /// Whether the service has that tile, by what it says of itself.
  [[nodiscard]] bool has(std::size_t level, const TileAddress& address) const;
  /// Calls visit(part) for each tile that a window within the level meets, whether the service has it or not.
  template <class Visit>
  void forEachTile(std::size_t level, const PixelWindow& window, Visit&& visit) const {
    const Level& l = levels_[level];
    const std::int64_t left = l.firstColumn + window.x;
    const std::int64_t top = l.firstRow + window.y;
    for (std::int64_t r = floorDivide(top, l.matrix.tileHeight); r * l.matrix.tileHeight < top + window.height; ++r) {
      for (std::int64_t c = floorDivide(left, l.matrix.tileWidth); c * l.matrix.tileWidth < left + window.width; ++c) {
        const std::int64_t x0 = std::max(left, c * l.matrix.tileWidth);
        const std::int64_t y0 = std::max(top, r * l.matrix.tileHeight);
        const std::int64_t x1 = std::min(left + window.width, (c + 1) * l.matrix.tileWidth);
        const std::int64_t y1 = std::min(top + window.height, (r + 1) * l.matrix.tileHeight);
        visit(TilePart{{l.number, c, r},
                       {static_cast<int>(x0 - l.firstColumn), static_cast<int>(y0 - l.firstRow),
                        static_cast<int>(x1 - x0), static_cast<int>(y1 - y0)},
                       static_cast<int>(x0 - c * l.matrix.tileWidth),
                       static_cast<int>(y0 - r * l.matrix.tileHeight)});
      }
    }
  }

 private:
  struct Level {
    TileMatrix matrix;
    std::size_t number = 0;        ///< in TileService::matrices
    std::int64_t firstColumn = 0;  ///< of the level's first pixel, counted from the matrix's corner
    std::int64_t firstRow = 0;
  };
  struct Frame;

  explicit ServicePyramid(Pyramid pyramid) : pyramid_(std::move(pyramid)) {}
  [[nodiscard]] static std::int64_t floorDivide(std::int64_t a, std::int64_t b) {
    return a >= 0 ? a / b : -((b - 1 - a) / b);
  }
  void addLevel(const TileMatrix& matrix, std::size_t number, const PixelGrid& full);

  Pyramid pyramid_;
  std::vector<Level> levels_;  ///< of the pyramid's
};

}  // namespace meridian::globebrowsing
