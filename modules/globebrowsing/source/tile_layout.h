#pragma once

#include <glm/vec2.hpp>

namespace meridian::globebrowsing {

/// Where a tile's samples lie in its unit square.
enum class Registration {
  PixelCentred,   ///< samples are areas: the outermost centres lie half a sample inside the edges
  NodeRegistered  ///< samples are points: the outermost lie on the edges, shared with the neighbours
};

/// The grid of samples of one tile: square, row 0 in the north, column 0 in the west, with a border that repeats what
/// lies beyond the edges.
struct TileLayout {
  int interior = 0;  ///< samples a side within the unit square; at least 1 (nodes: 2)
  int border = 0;    ///< further samples on each side
  Registration registration = Registration::PixelCentred;

  /// Samples a side, border included.
  [[nodiscard]] constexpr int size() const { return interior + 2 * border; }
  /// Unit squares between neighbouring samples.
  [[nodiscard]] constexpr double spacing() const {
    return registration == Registration::PixelCentred ? 1.0 / interior : 1.0 / (interior - 1);
  }
  /// Of the sample in that column and row (0 .. size() - 1): within 0..1 but for the border. Nodes on the edges come
  /// out as exactly 0 and 1.
  [[nodiscard]] glm::dvec2 uv(int column, int row) const {
    const double shift = registration == Registration::PixelCentred ? 0.5 : 0.0;
    const double count = registration == Registration::PixelCentred ? interior : interior - 1;
    return {(column - border + shift) / count, (row - border + shift) / count};
  }

  bool operator==(const TileLayout&) const = default;
};

/// The layouts of all tiles (docs/architecture.md, Sizes and budgets).
inline constexpr TileLayout colourLayout{512, 8, Registration::PixelCentred};
inline constexpr TileLayout heightLayout{129, 1, Registration::NodeRegistered};
/// Heights that colours are made from: a sample for each pixel of a colour tile, and one more around, for gradients.
inline constexpr TileLayout reliefLayout{colourLayout.interior, colourLayout.border + 1, Registration::PixelCentred};

}  // namespace meridian::globebrowsing
