#include "globebrowsing/source/pyramid.h"

#include <algorithm>
#include <cmath>

namespace meridian::globebrowsing {

namespace {

/// Where an unbounded column and row are within the level; `turned` when the row lies beyond a pole.
struct Cell {
  int x = 0;
  int y = 0;
  bool turned = false;
};

Cell cell(const Pyramid& pyramid, const PyramidLevel& level, int x, int y) {
  const RasterGeoreference& georeference = pyramid.georeference;
  Cell result{x, y};
  const int turn = pyramid.columnsOfTurn(level);
  if (turn > 0 && (y < 0 || y >= level.height)) {
    // The pole's own row coordinate; it need not be the raster's edge (node-registered rasters).
    const bool isFirst = y < 0;
    const bool northFirst = georeference.row(1.0) < georeference.row(-1.0);
    const double pole =
        georeference.row((isFirst == northFirst ? 1.0 : -1.0) * std::acos(0.0)) / level.scaleY + level.offsetY;
    if (std::abs(pole - (isFirst ? 0 : level.height)) < 1.0) {
      result.y = static_cast<int>(std::lround(2.0 * pole - y - 1.0));
      result.turned = true;
    }
  }
  result.y = std::clamp(result.y, 0, level.height - 1);
  if (turn > 0) {
    const int first = static_cast<int>(std::lround(georeference.firstColumn() / level.scaleX));
    const int offset = (x - first + (result.turned ? turn / 2 : 0)) % turn;
    result.x = first + (offset < 0 ? offset + turn : offset);
  }
  result.x = std::clamp(result.x, 0, level.width - 1);
  return result;
}

}  // namespace

int Pyramid::columnsOfTurn(const PyramidLevel& level) const {
  const int columns = georeference.columnsOfTurn();
  return columns == 0 ? 0 : std::max(1, static_cast<int>(std::lround(columns / level.scaleX)));
}

std::vector<WindowPiece> piecesOf(const Pyramid& pyramid, std::size_t levelNumber, const UnboundedWindow& window) {
  const PyramidLevel& level = pyramid.levels[levelNumber];
  std::vector<WindowPiece> pieces;
  for (int row = 0; row < window.height;) {
    const Cell start = cell(pyramid, level, window.x, window.y + row);
    int rows = 1;
    while (row + rows < window.height) {
      const Cell next = cell(pyramid, level, window.x, window.y + row + rows);
      if (next.y != start.y + rows || next.turned != start.turned) {
        break;
      }
      ++rows;
    }
    for (int column = 0; column < window.width;) {
      const Cell from = cell(pyramid, level, window.x + column, window.y + row);
      int columns = 1;
      while (column + columns < window.width &&
             cell(pyramid, level, window.x + column + columns, window.y + row).x == from.x + columns) {
        ++columns;
      }
      pieces.push_back({{from.x, from.y, columns, rows}, column, row});
      column += columns;
    }
    row += rows;
  }
  return pieces;
}

}  // namespace meridian::globebrowsing
