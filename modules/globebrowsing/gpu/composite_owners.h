#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <utility>

#include "globebrowsing/gpu/composite_generations.h"
#include "globebrowsing/gpu/height_composition.h"

namespace meridian::globebrowsing {

/// Which tiles have composites of their own: those that show more than their parent's would. The others draw an
/// ancestor's. What was found is kept until a generation changes. Owned by CompositeStore; render thread only.
class CompositeOwners {
 public:
  using Generations = std::array<CompositeGenerations, compositeKindCount>;

  /// All outlive it. `relief` makes the heights that layers colour.
  CompositeOwners(std::shared_ptr<const Tiling> tiling, const Generations& generations, const HeightComposition& relief)
      : tiling_(std::move(tiling)), generations_(generations), relief_(relief) {
    facts_.reserve(mostFacts);
  }

  /// The tile whose composite a tile draws, of at most that level; `next`: in the next generation.
  [[nodiscard]] AncestorPlace owner(CompositeKind kind, bool next, const TileIndex& index, int mostLevel) const;
  /// Whether some enabled layer has finer data within the tile than the tile's own composites show.
  [[nodiscard]] bool hasFiner(const TileIndex& index) const { return facts(index).finer; }

 private:
  /// Facts of tiles long gone are dropped when there are that many.
  static constexpr std::size_t mostFacts = 1 << 15;
  /// What is known of a tile as long as no generation changes.
  struct Facts {
    std::array<std::array<std::uint8_t, 2>, compositeKindCount> ownerLevels{};  ///< in the shown and next generation
    bool finer = false;
  };

  [[nodiscard]] const Facts& facts(const TileIndex& index) const;
  [[nodiscard]] bool anyFiner(const CompositeGenerations& generations, bool next, const TileIndex& index) const;
  /// Whether that layer shows more in composites that are finer than the tile's.
  [[nodiscard]] bool isFiner(const Layer& layer, const LayerStepPointer& step, const TileIndex& index) const;

  std::shared_ptr<const Tiling> tiling_;
  const Generations& generations_;
  const HeightComposition& relief_;
  mutable std::unordered_map<TileIndex, Facts> facts_;
  mutable std::uint64_t changes_ = 0;  ///< of all generations, that facts_ are of
};

}  // namespace meridian::globebrowsing
