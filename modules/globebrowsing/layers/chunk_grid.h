#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace meridian::globebrowsing {

/// The vertices that every chunk is drawn with: a grid of 33 x 33, row by row from the north-west, then a skirt: once
/// more the vertices of the west, east, north and south edge, in that order, each from its north or west end.
///
/// A chunk draws with 2, 4, 8, 16 or 32 segments a side (step 0..4) by an index list that skips vertices, so density
/// never touches vertex data. One that tapers to a pole draws with half as many columns as rows, and its last row with
/// one triangle a column, whose tip has the longitude of the column's middle. Cells are cut from their north-west to
/// their south-east corner.
namespace chunk_grid {

inline constexpr int segments = 32;
inline constexpr int side = segments + 1;
inline constexpr int steps = 5;
inline constexpr int gridVertices = side * side;
inline constexpr int skirtVertices = 4 * side;
inline constexpr int vertexCount = gridVertices + skirtVertices;

enum class Columns : std::uint8_t { Full, HalfToNorthPole, HalfToSouthPole };
inline constexpr std::array<Columns, 3> allColumns{Columns::Full, Columns::HalfToNorthPole, Columns::HalfToSouthPole};

/// Segments a side at that step: 2, 4, 8, 16, 32.
[[nodiscard]] constexpr int segmentsAt(int step) {
  return 2 << step;
}
/// Segments along the north and the south edge.
[[nodiscard]] constexpr int columnsAt(int step, Columns columns) {
  return columns == Columns::Full ? segmentsAt(step) : segmentsAt(step) / 2;
}

/// The grid column and row of a vertex (of the edge below it, for a skirt vertex).
struct Place {
  int column = 0;
  int row = 0;
  bool skirt = false;
};
[[nodiscard]] Place place(int vertex);

/// Triangles, counter-clockwise seen from outside: first the grid's, then the skirts', which face away from the chunk.
/// `edges`: bits 0..3 for the skirts of the west, east, north and south edge.
[[nodiscard]] std::vector<std::uint16_t> indices(int step, Columns columns, unsigned edges);
inline constexpr unsigned edgeSets = 16;
/// How many of the indices are the grid's.
[[nodiscard]] constexpr int gridIndexCount(int step, Columns columns) {
  const int triangles = 2 * segmentsAt(step) * columnsAt(step, columns);
  return 3 * (columns == Columns::Full ? triangles : triangles - columnsAt(step, columns));
}

}  // namespace chunk_grid

}  // namespace meridian::globebrowsing
