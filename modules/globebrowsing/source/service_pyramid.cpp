#include "globebrowsing/source/service_pyramid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace meridian::globebrowsing {

namespace {

constexpr double mostPixels = 1 << 30;  // a side; columns and rows are ints
/// Of a pixel, that corners and scales are off by because services round them.
constexpr double rounding = 0.02;

bool isUsable(const TileMatrix& matrix) {
  return matrix.tileWidth > 0 && matrix.tileHeight > 0 && matrix.tileWidth <= (1 << 14) &&
         matrix.tileHeight <= (1 << 14) && matrix.pixelWidth > 0.0 && matrix.pixelHeight > 0.0 &&
         std::isfinite(matrix.pixelWidth) && std::isfinite(matrix.pixelHeight) && std::abs(matrix.left) < 1e15 &&
         std::abs(matrix.top) < 1e15 && matrix.firstColumn <= matrix.lastColumn && matrix.firstRow <= matrix.lastRow;
}

/// A place counted in pixels from a corner, taken for a pixel's edge where it is one but for rounding.
double snapped(double pixels) {
  const double whole = std::round(pixels);
  return std::abs(pixels - whole) < rounding ? whole : pixels;
}

struct Rectangle {
  double west = 0.0;
  double south = 0.0;
  double east = 0.0;
  double north = 0.0;
};

/// The extent of the data within the globe, in units of the CRS. Nearly a whole turn, or nearly up to a pole, is meant
/// to be exactly that.
Rectangle extentOf(const TileService& service, const CrsReach& reach) {
  Rectangle extent{service.west, service.south, service.east, service.north};
  if (reach.turn > 0.0) {
    const double slack = reach.turn * 1e-6;
    if (extent.east - extent.west > reach.turn - slack) {
      const double antimeridian = reach.middle - reach.turn / 2;
      const bool holdsTurn = extent.west <= antimeridian + slack && extent.east >= antimeridian + reach.turn - slack;
      extent.west = holdsTurn ? antimeridian : extent.west;
      extent.east = extent.west + reach.turn;
    }
    const double south = std::min(reach.south, reach.north);
    const double north = std::max(reach.south, reach.north);
    extent.south = extent.south < south + slack ? south : extent.south;
    extent.north = extent.north > north - slack ? north : extent.north;
  }
  return extent;
}

/// Full resolution: the extent on the grid of that matrix.
PixelGrid gridOf(const TileMatrix& matrix, const Rectangle& extent) {
  const double x0 = std::floor(snapped((extent.west - matrix.left) / matrix.pixelWidth));
  const double y0 = std::floor(snapped((matrix.top - extent.north) / matrix.pixelHeight));
  const double x1 = std::ceil(snapped((extent.east - matrix.left) / matrix.pixelWidth));
  const double y1 = std::ceil(snapped((matrix.top - extent.south) / matrix.pixelHeight));
  PixelGrid grid{matrix.left + x0 * matrix.pixelWidth, matrix.top - y0 * matrix.pixelHeight, matrix.pixelWidth,
                 matrix.pixelHeight};
  if (x1 - x0 <= mostPixels && y1 - y0 <= mostPixels) {
    grid.width = static_cast<int>(x1 - x0);
    grid.height = static_cast<int>(y1 - y0);
  }
  return grid;
}

}  // namespace

void ServicePyramid::addLevel(const TileMatrix& matrix, std::size_t number, const PixelGrid& full) {
  const double x = snapped((full.left - matrix.left) / matrix.pixelWidth);
  const double y = snapped((matrix.top - full.top) / matrix.pixelHeight);
  PyramidLevel level;
  level.scaleX = matrix.pixelWidth / full.pixelWidth;
  level.scaleY = matrix.pixelHeight / full.pixelHeight;
  level.offsetX = x - std::floor(x);
  level.offsetY = y - std::floor(y);
  level.width = std::max(1, static_cast<int>(std::ceil(snapped(full.width / level.scaleX + level.offsetX))));
  level.height = std::max(1, static_cast<int>(std::ceil(snapped(full.height / level.scaleY + level.offsetY))));
  pyramid_.levels.push_back(level);
  levels_.push_back(
      {matrix, number, static_cast<std::int64_t>(std::floor(x)), static_cast<std::int64_t>(std::floor(y))});
}

Result<ServicePyramid> ServicePyramid::of(const TileService& service) {
  const auto reach = reachOf(service.crs, service.where);
  if (!reach) {
    return tl::make_unexpected(reach.error());
  }
  const Rectangle extent = extentOf(service, *reach);
  if (!(extent.east > extent.west) || !(extent.north > extent.south) || !std::isfinite(extent.east - extent.west) ||
      !std::isfinite(extent.north - extent.south)) {
    return failure("the extent of the tile service is empty", service.where,
                   "give west, south, east and north in units of its CRS, east greater than west");
  }
  std::vector<std::size_t> order(service.matrices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return service.matrices[a].pixelHeight < service.matrices[b].pixelHeight;
  });
  std::optional<ServicePyramid> result;
  PixelGrid full;
  for (const std::size_t number : order) {
    const TileMatrix& matrix = service.matrices[number];
    if (!isUsable(matrix)) {
      continue;
    }
    if (!result) {
      full = gridOf(matrix, extent);
      if (full.width < 1 || full.height < 1) {
        continue;  // too fine to be counted
      }
      auto georeference = RasterGeoreference::of(service.crs, full, service.where);
      if (!georeference) {
        return tl::make_unexpected(georeference.error());
      }
      result = ServicePyramid({service.where, std::move(*georeference), {}, true});
    }
    result->addLevel(matrix, number, full);
  }
  if (!result) {
    return failure("the tile service has no tile matrix that could be used", service.where,
                   "give at least one level with its pixel size, tile size and corner");
  }
  return std::move(*result);
}

bool ServicePyramid::has(std::size_t level, const TileAddress& address) const {
  const TileMatrix& matrix = levels_[level].matrix;
  return address.column >= matrix.firstColumn && address.column <= matrix.lastColumn &&
         address.row >= matrix.firstRow && address.row <= matrix.lastRow;
}

}  // namespace meridian::globebrowsing
