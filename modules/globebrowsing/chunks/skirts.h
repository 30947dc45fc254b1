#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "globebrowsing/chunks/node_pool.h"
#include "globebrowsing/chunks/selection.h"
#include "globebrowsing/tiling/tiling.h"

namespace meridian::globebrowsing {

/// How far each drawn chunk's skirts must reach down so that no gap is left between chunks.
///
/// Along an edge that two drawn chunks share, both draw lines that stay within their own `error` of the surface there,
/// so the lines are at most the sum of both errors apart, whichever lies higher. The higher one's skirt closes the gap
/// if it reaches down that sum; as either may be higher, both get it: own error + the greatest error of the neighbours
/// drawn beyond its edges. Where levels differ, the finer one's nodes also show relief that the coarser one's nodes do
/// not have; that adds the coarser one's error at 32 segments, which bounds what its next refinement brings. Half a
/// pixel (settings.maximumErrorPixels) at the chunk's distance covers rounding and blending of heights. Where neither's
/// edge holds the other's (rows of fewer columns beside deeper tiles) the greatest error drawn below the neighbour
/// stands for those beyond the edge. Where both are of one level and density, and the whole edge is shared (not
/// where rows of fewer columns begin, nor where a tile that touches a pole ends), they draw the very same vertices
/// along it, and where nothing is drawn beyond it nothing can gape: such edges get no skirt. So T-junctions of any
/// difference in level and density are closed, without looking at the neighbour's vertices.
class SkirtFitter {
 public:
  /// Sets every chunk's skirt; `numbers` are the chunks' nodes, in the same order. `metresPerPixel` is at a metre's
  /// distance.
  struct Drawn {
    std::span<SelectedChunk> chunks;
    std::span<const NodeNumber> numbers;
    double allowedPixels = 0.5;
    double metresPerPixel = 0.0;
  };
  void fit(const Tiling& tiling, NodePool& pool, const Drawn& drawn);

 private:
  struct Slot {
    TileIndex index;
    std::int32_t chunk = empty;
    double error = 0.0;  ///< metres: of the chunk, or the greatest of those below
  };
  static constexpr std::int32_t empty = -1;
  static constexpr std::int32_t interior = -2;  ///< something below it is drawn

  void fill(NodePool& pool, const Drawn& drawn);
  [[nodiscard]] Slot& slotOf(const TileIndex& index);
  [[nodiscard]] const Slot* drawnAt(const Tiling& tiling, TileIndex index);

  std::vector<Slot> slots_;
  std::size_t filled_ = 0;
};

}  // namespace meridian::globebrowsing
