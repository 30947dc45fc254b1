#include "globebrowsing/source/tile_pyramid.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace meridian::globebrowsing {

namespace {

/// Of a tile: what is within this of an edge lies on it.
constexpr double tolerance = 1e-6;

std::int64_t toIndex(double value) {
  constexpr double limit = 4e18;
  return static_cast<std::int64_t>(std::clamp(value, -limit, limit));
}

}  // namespace

bool clip(TileMatrix& matrix, const Extent& extent) {
  const double width = matrix.tileWidth * matrix.pixelWidth;
  const double height = matrix.tileHeight * matrix.pixelHeight;
  const auto first = [](double distance) { return toIndex(std::floor(distance + tolerance)); };
  const auto last = [](double distance) { return toIndex(std::ceil(distance - tolerance)) - 1; };
  matrix.firstColumn = std::max(matrix.firstColumn, first((extent.west - matrix.left) / width));
  matrix.lastColumn = std::min(matrix.lastColumn, last((extent.east - matrix.left) / width));
  matrix.firstRow = std::max(matrix.firstRow, first((matrix.top - extent.north) / height));
  matrix.lastRow = std::min(matrix.lastRow, last((matrix.top - extent.south) / height));
  return matrix.firstColumn <= matrix.lastColumn && matrix.firstRow <= matrix.lastRow;
}

std::vector<TileMatrix> layOutPyramid(const MapCrs& crs, const Pyramid& pyramid) {
  const Extent& extent = pyramid.extent;
  TileMatrix matrix;
  matrix.tileWidth = pyramid.tileSize;
  matrix.tileHeight = pyramid.tileSize;
  double side = 180.0;
  matrix.left = -180.0;
  matrix.top = 90.0;
  if (crs.isWebMercator()) {
    side = 2 * webMercatorHalfWidth;
    matrix.left = -webMercatorHalfWidth;
    matrix.top = webMercatorHalfWidth;
  } else if (!crs.isGeographic()) {
    side = std::max(extent.east - extent.west, extent.north - extent.south);
    matrix.left = extent.west;
    matrix.top = extent.north;
  }
  std::vector<TileMatrix> matrices;
  constexpr int deepest = 30;
  for (int level = 0; level <= deepest; ++level) {
    const double pixel = side / pyramid.tileSize / std::ldexp(1.0, level);
    const bool isFinest = pixel <= pyramid.finestPixel || level == deepest;
    if (pyramid.coarsestPixel <= 0.0 || pixel <= pyramid.coarsestPixel || isFinest) {
      TileMatrix next = matrix;
      next.identifier = std::to_string(level);
      next.pixelWidth = pixel;
      next.pixelHeight = pixel;
      // Extents over the antimeridian, and those of 0 to 360 degrees, lie beside the grid's own turn.
      next.firstColumn = toIndex(-std::ldexp(4.0, level));
      next.lastColumn = toIndex(std::ldexp(4.0, level));
      next.lastRow = toIndex(std::ldexp(1.0, level)) - 1;
      if (clip(next, extent)) {
        matrices.insert(matrices.begin(), next);
      }
    }
    if (isFinest) {
      break;
    }
  }
  return matrices;
}

Result<void> setMatrices(TileService& service, std::vector<TileMatrix> matrices, const Extent& extent) {
  std::erase_if(matrices, [&](TileMatrix& matrix) {
    return !std::isfinite(matrix.left) || !std::isfinite(matrix.top) || !std::isfinite(matrix.pixelWidth) ||
           !std::isfinite(matrix.pixelHeight) || !(matrix.pixelWidth > 0.0) || !(matrix.pixelHeight > 0.0) ||
           matrix.tileWidth < 1 || matrix.tileHeight < 1 || !clip(matrix, extent);
  });
  if (matrices.empty()) {
    return failure("the service has no tiles within its extent", service.where, "check the extent and the levels");
  }
  std::stable_sort(matrices.begin(), matrices.end(),
                   [](const TileMatrix& a, const TileMatrix& b) { return a.pixelHeight < b.pixelHeight; });
  const TileMatrix& first = matrices.front();
  Extent union_{first.left, first.top, first.left, first.top};
  bool isFirst = true;
  for (const TileMatrix& matrix : matrices) {
    const double width = matrix.tileWidth * matrix.pixelWidth;
    const double height = matrix.tileHeight * matrix.pixelHeight;
    const Extent own{matrix.left + static_cast<double>(matrix.firstColumn) * width,
                     matrix.top - static_cast<double>(matrix.lastRow + 1) * height,
                     matrix.left + static_cast<double>(matrix.lastColumn + 1) * width,
                     matrix.top - static_cast<double>(matrix.firstRow) * height};
    union_ = isFirst ? own
                     : Extent{std::min(union_.west, own.west), std::min(union_.south, own.south),
                              std::max(union_.east, own.east), std::max(union_.north, own.north)};
    isFirst = false;
  }
  service.west = std::max(extent.west, union_.west);
  service.south = std::max(extent.south, union_.south);
  service.east = std::min(extent.east, union_.east);
  service.north = std::min(extent.north, union_.north);
  service.matrices = std::move(matrices);
  return {};
}

}  // namespace meridian::globebrowsing
