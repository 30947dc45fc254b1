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
/// A tile splits while any view asks for it:
/// - for its colours, wherever the view looks, while the evaluator finds it too coarse at its nearest point (and, for
///   evaluators limited by data, finer colours exist);
/// - for its surface, while its geometric error at 8 segments a side (from level 4 on 16) appears larger than
///   settings.maximumErrorPixels on the view's picture, weighed by the slant at which it is seen, or its edge times
///   2^-23 (the precision of a float along it) exceeds 0.05 pixel. Tiles below one that split for its surface alone
///   draw its composite, so that relief does not force colours to split.
/// What remains are the target chunks; each is drawn with the fewest segments that keep the
/// error.
///
/// Targets and roots are wanted. While a target has no surface, the nearest ancestor that has one is drawn in place of
/// everything below it (a kick); ancestors are not loaded for that, except every third level, as something to start
/// with. A target with a surface is drawn at once, its colours coming from an ancestor until its own are there. While a
/// target is not complete but finer chunks were drawn in the last frame, those stay (zooming out). So what is seen is
/// covered exactly once, as long as the roots can be drawn.
///
/// What all views cull, by frustum or horizon, is neither drawn nor descended into. What only the frustum culls is
/// kept, and with settings.prefetch also wanted, after everything needed now. Tiles that are culled or split by heights
/// of before have their shapes made anew, after everything needed now as well.
///
/// However many chunks the settings ask for, a selection ends: past settings.mostVisited tiles none splits. Then all
/// errors allowed are multiplied (figures().coarsening) until the whole selection stays below that, within a few
/// frames; until it does it is not at its target. They fall again when there is room.
///
/// A steady selection (nothing new is visited) allocates nothing. Nodes that are not visited for a while are reclaimed.
/// One thread at a time.
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
