#pragma once

#include <memory>
#include <span>

#include "globebrowsing/chunks/selection.h"
#include "globebrowsing/streaming/tile_residency.h"
#include "globebrowsing/tiling/tiling.h"

namespace meridian::globebrowsing {

/// Chooses the chunks of a globe that are drawn: one set for all views, without holes and without overlaps, as fine as
/// the settings ask and as what is in memory allows. A pure algorithm: it knows tiles by index only and asks a
/// TileResidency for the rest.
///
/// A steady selection (nothing new is visited) allocates nothing. One thread at a time.
class ChunkTree {
 public:
  /// The tiling must outlive the tree.
  explicit ChunkTree(const Tiling& tiling);
  ~ChunkTree();
  ChunkTree(ChunkTree&&) noexcept;
  ChunkTree& operator=(ChunkTree&&) noexcept;

  /// Selects anew, once per frame. Views that are not finite (or look nowhere) are left out; without any view left,
  /// nothing is selected and only the roots are kept. At most 32 views.
  void select(std::span<const SelectionView> views, const SelectionSettings& settings, TileResidency& residency);

  /// What to draw, from near to far; valid until the next select.
  [[nodiscard]] std::span<const SelectedChunk> selected() const;
  [[nodiscard]] const SelectionFigures& figures() const;

  /// Forgets every node, as after a change of what the globe is made of.
  void clear();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace meridian::globebrowsing
