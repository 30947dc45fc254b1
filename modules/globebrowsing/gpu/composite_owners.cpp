#include "globebrowsing/gpu/composite_owners.h"

#include <algorithm>

namespace meridian::globebrowsing {

AncestorPlace CompositeOwners::owner(CompositeKind kind, bool next, const TileIndex& index, int mostLevel) const {
  const int level = facts(index).ownerLevels[static_cast<std::size_t>(kind)][next ? 1 : 0];
  return ancestorAt(*tiling_, index, std::min(mostLevel, level));
}

const CompositeOwners::Facts& CompositeOwners::facts(const TileIndex& index) const {
  std::uint64_t changes = 0;
  for (const CompositeGenerations& generations : generations_) {
    changes += generations.changes();
  }
  if (changes != changes_ || facts_.size() > mostFacts) {
    changes_ = changes;
    facts_.clear();
  }
  if (const auto found = facts_.find(index); found != facts_.end()) {
    return found->second;
  }
  Facts made;
  const std::optional<TileIndex> parent = tiling_->parent(index);
  for (std::size_t i = 0; i < compositeKindCount; ++i) {
    const CompositeGenerations& generations = generations_[i];
    for (std::size_t next = 0; next < (generations.hasNext() ? 2 : 1); ++next) {
      // The tile's own composite is worth having only where it shows more than its parent's.
      const bool own = !parent || anyFiner(generations, next != 0, *parent);
      made.ownerLevels[i][next] = own ? index.level : facts(*parent).ownerLevels[i][next];
    }
    made.finer = made.finer || anyFiner(generations, false, index);
  }
  return facts_.emplace(index, made).first->second;
}

bool CompositeOwners::anyFiner(const CompositeGenerations& generations, bool next, const TileIndex& index) const {
  const auto isFinerIn = [&](const CompositeGenerations::Generation& generation) {
    const std::vector<Layer*>& layers = generations.layers();
    for (std::size_t i = 0; i < layers.size(); ++i) {
      if (isFiner(*layers[i], generation.steps[i], index)) {
        return true;
      }
    }
    return false;
  };
  const bool isPair = generations.pair().isPair;
  return ((!next || isPair) && isFinerIn(generations.shown())) || ((next || isPair) && isFinerIn(generations.next()));
}

bool CompositeOwners::isFiner(const Layer& layer, const LayerStepPointer& step, const TileIndex& index) const {
  if (isRelief(layer.sampling())) {
    // Lines are as thin as the composite lets them be, however coarse the heights are, as long as their slope tells
    // where they are.
    constexpr int levelsOfLines = 6;
    const int coarser = layer.sampling() == Sampling::Isolines ? levelsOfLines : 0;
    return index.level < coarser || relief_.hasFiner(ancestorAt(*tiling_, index, index.level - coarser).index);
  }
  return layer.sampling() == Sampling::Tile && step != nullptr && step->tiles()->hasFinerColours(*tiling_, index);
}

}  // namespace meridian::globebrowsing
