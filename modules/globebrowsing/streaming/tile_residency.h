#pragma once

#include <array>

#include "globebrowsing/tiling/tile_index.h"

namespace meridian::globebrowsing {

/// The range of heights, in metres above the ellipsoid, that a tile's surface is known to stay within.
struct HeightRange {
  double minimum = 0.0;
  double maximum = 0.0;
};

/// What is wrong with a tile's surface drawn with 2, 4, 8, 16, 32 segments a side.
struct SurfaceErrors {
  static constexpr std::size_t steps = 5;
  std::array<double, steps> vertical{};  ///< metres between it and its height tile's nodes
  std::array<double, steps> along{};     ///< metres that what lies on it is shifted: parallels drawn as chords
  /// Metres by which its edges may miss a neighbour's that has the same vertices: it is made from other data.
  double unlike = 0.0;
};

/// What selection may know of what is in memory. Declared here so that the chunk tree needs neither OpenGL nor layers;
/// implemented by gpu/. All calls on the render thread, for tiles of the globe's tiling; none allocates in a steady
/// frame.
class TileResidency {
 public:
  enum class State {
    Nothing,   ///< it cannot be drawn yet
    Drawable,  ///< its surface is there; its colours come from an ancestor, or are of an earlier setting
    Complete   ///< nothing that it wants is missing (what failed for good counts as there)
  };

  virtual ~TileResidency() = default;

  // `colourLevel`: of the tile whose composite the tile draws, its own level or an ancestor's. A tile that is there
  // because relief needs it draws the composite of the tile at which colours were fine enough.

  /// Asks for all that the tile needs, this frame; a greater priority is served first. What is not asked for again in
  /// the next frame is cancelled or becomes evictable. `views`: bit i where view i is not complete without it.
  virtual void want(const TileIndex& index, int colourLevel, double priority, std::uint32_t views) = 0;
  /// Asks for the tile's shape alone, this frame, if it has one that shows other heights than it should by now. For
  /// tiles that are not drawn: by its heights such a tile would be culled, or split, for ever.
  virtual void renewShape(const TileIndex& index, double priority, std::uint32_t views) = 0;
  /// Keeps what the tile has from being evicted this frame, without asking for more.
  virtual void keep(const TileIndex& index, int colourLevel) = 0;
  [[nodiscard]] virtual State state(const TileIndex& index, int colourLevel) const = 0;

  /// Of the tile's own height tile, else of its nearest ancestor with one, else of the layers' declared range.
  [[nodiscard]] virtual HeightRange heightRange(const TileIndex& index) const = 0;
  /// Grows whenever heightRange(index) may have changed; equal numbers mean an equal range.
  [[nodiscard]] virtual unsigned heightVersion(const TileIndex& index) const = 0;
  /// Estimated from the ellipsoid and the nearest ancestor while there is no height tile.
  [[nodiscard]] virtual SurfaceErrors surfaceErrors(const TileIndex& index) const = 0;
  /// Whether some enabled colour layer has finer data within this tile than the tile's own composite shows.
  [[nodiscard]] virtual bool hasFinerColours(const TileIndex& index) const = 0;
};

}  // namespace meridian::globebrowsing
