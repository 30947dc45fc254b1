#include "globebrowsing/layers/chunk_grid.h"

#include <cassert>

namespace meridian::globebrowsing::chunk_grid {

namespace {

std::uint16_t gridVertex(int column, int row) {
  return static_cast<std::uint16_t>(row * side + column);
}

/// The vertex at `along` on an edge (west, east, north, south), on the surface or at the foot of its skirt.
std::uint16_t edgeVertex(int edge, int along) {
  switch (edge) {
    case 0:
      return gridVertex(0, along);
    case 1:
      return gridVertex(segments, along);
    case 2:
      return gridVertex(along, 0);
    default:
      return gridVertex(along, segments);
  }
}

std::uint16_t footVertex(int edge, int along) {
  return static_cast<std::uint16_t>(gridVertices + edge * side + along);
}

}  // namespace

Place place(int vertex) {
  assert(vertex >= 0 && vertex < vertexCount);
  if (vertex < gridVertices) {
    return {vertex % side, vertex / side, false};
  }
  const int edge = (vertex - gridVertices) / side;
  const int along = (vertex - gridVertices) % side;
  Place edgePlace = place(edgeVertex(edge, along));
  edgePlace.skirt = true;
  return edgePlace;
}

std::vector<std::uint16_t> indices(int step, Columns columns, unsigned edges) {
  const int down = segments / segmentsAt(step);
  const int across = segments / columnsAt(step, columns);
  std::vector<std::uint16_t> out;
  const int most = gridIndexCount(step, columns) + 4 * 6 * segmentsAt(step);
  out.reserve(static_cast<std::size_t>(most));
  for (int row = 0; row < segments; row += down) {
    for (int column = 0; column < segments; column += across) {
      const std::uint16_t northWest = gridVertex(column, row);
      const std::uint16_t northEast = gridVertex(column + across, row);
      const std::uint16_t southWest = gridVertex(column, row + down);
      const std::uint16_t southEast = gridVertex(column + across, row + down);
      if (columns == Columns::HalfToNorthPole && row == 0) {
        out.insert(out.end(), {gridVertex(column + across / 2, row), southWest, southEast});
      } else if (columns == Columns::HalfToSouthPole && row + down == segments) {
        out.insert(out.end(), {northWest, gridVertex(column + across / 2, row + down), northEast});
      } else {
        out.insert(out.end(), {northWest, southWest, southEast, northWest, southEast, northEast});
      }
    }
  }
  for (int edge = 0; edge < 4; ++edge) {
    if ((edges >> static_cast<unsigned>(edge) & 1U) == 0) {
      continue;
    }
    // Going south along the west edge, the outside is to the right; likewise going west-to-east along the south one.
    const bool outsideOnRight = edge == 0 || edge == 3;
    const int stride = edge < 2 ? down : across;
    for (int along = 0; along < segments; along += stride) {
      const int first = outsideOnRight ? along : along + stride;
      const int second = outsideOnRight ? along + stride : along;
      const std::uint16_t top = edgeVertex(edge, first);
      const std::uint16_t next = edgeVertex(edge, second);
      const std::uint16_t foot = footVertex(edge, first);
      const std::uint16_t nextFoot = footVertex(edge, second);
      out.insert(out.end(), {top, foot, nextFoot, top, nextFoot, next});
    }
  }
  return out;
}

}  // namespace meridian::globebrowsing::chunk_grid
