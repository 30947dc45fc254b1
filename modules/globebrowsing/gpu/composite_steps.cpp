// The part of CompositeStore that follows its layers' steps in time.

#include <algorithm>

#include "globebrowsing/gpu/composite_store.h"
#include "globebrowsing/providers/raw_tile_job.h"
#include "globebrowsing/source/tile_layout.h"

namespace meridian::globebrowsing {

namespace {

/// Of composites of the next step in time: among the tiles that selection needs (1 to 2), roots before all (3).
constexpr double nextPriority = 1.5;
constexpr double nextRootPriority = 3.0;
/// Of raw tiles that nobody sees yet: after all others.
constexpr double aheadPriority = -5.0;
/// At most that share of the tile cache is fetched ahead for each kind.
constexpr std::size_t aheadShare = 8;

/// Whether going from one step to another may lead over `step`: it is the first, the other, or between them in time.
bool isOnTheWay(const LayerStepPointer& from, const LayerStepPointer& step, const LayerStepPointer& to) {
  if (from == nullptr || step == nullptr || to == nullptr || step == from || step == to) {
    return true;
  }
  const Time a = from->when().begin;
  const Time b = step->when().begin;
  const Time c = to->when().begin;
  return (a < b && b < c) || (c < b && b < a);
}

}  // namespace

/// Layers came, went or were changed: those that stay also stay at the step that is drawn.
void CompositeStore::takeSteps(KindState& state) {
  const std::vector<Layer*>& enabled = state.layers;
  takeSteps(state, state.shown);
  if (state.pair.isMixed) {
    takeSteps(state, state.next);  // it is drawn, and brought up to date like the shown one
    return;
  }
  // What of the next step was composed before the change will do, and is composed anew after the exchange.
  const bool isOfThese = std::equal(enabled.begin(), enabled.end(), state.next.steps.begin(), state.next.steps.end(),
                                    [](const Layer* layer, const LayerStepPointer& step) {
                                      return step == nullptr || step->source() == layer->provider().get();
                                    });
  if (!isOfThese) {
    dropNext(state);
  }
}

void CompositeStore::takeSteps(KindState& state, Generation& generation) {
  std::vector<LayerStepPointer> steps;
  bool comesWithSteps = false;
  for (const Layer* layer : state.layers) {
    const auto drawn = std::find_if(generation.steps.begin(), generation.steps.end(), [layer](const auto& step) {
      return step != nullptr && step->source() == layer->provider().get();
    });
    const bool isNew = drawn == generation.steps.end();
    steps.push_back(isNew ? layer->step() : *drawn);
    // A layer that comes back may find composites of its own, of another step.
    comesWithSteps = comesWithSteps || (isNew && layer->provider()->steps() != nullptr);
  }
  generation.steps = std::move(steps);
  if (comesWithSteps) {
    generation.stamp = ++state.lastStamp;
  }
}

void CompositeStore::beginNext(CompositeKind kind) {
  KindState& state = of(kind);
  keepPair(kind);
  // Of two steps that are to be mixed, the one that is not drawn yet.
  const bool toOther = isInterpolated(kind) && isOf(state, state.shown, false);
  if (state.hasNext) {
    // What is on the way to the present step is finished first, or a time that runs faster would never show any.
    bool onTheWay = true;
    for (std::size_t i = 0; i < state.layers.size(); ++i) {
      onTheWay = onTheWay && isOnTheWay(state.shown.steps[i], state.next.steps[i], stepOf(state, i, toOther));
    }
    if (onTheWay) {
      return;
    }
    dropNext(state);
  }
  // Where nothing is drawn the last step is finished first as well, or a surface that is still filled never would be.
  if (state.drawn.empty() && lackedSome_) {
    return;
  }
  if (isOf(state, state.shown, toOther)) {
    return;
  }
  state.next.steps.clear();
  for (std::size_t i = 0; i < state.layers.size(); ++i) {
    state.next.steps.push_back(stepOf(state, i, toOther));
  }
  state.next.side = state.shown.side == 0 ? 1 : 0;
  state.next.since = state.next.stamp = ++state.lastStamp;
  state.hasNext = true;
  state.crowded = false;
  state.nextOwnerLevels.clear();
}

void CompositeStore::dropNext(KindState& state) {
  state.next.steps.clear();
  state.hasNext = false;
  if (state.pair.isPair) {
    state.pair = {};
    facts_.clear();
  }
}

void CompositeStore::exchange(KindState& state) {
  if (state.crowded && !state.pair.isMixed) {
    // Without room for both, the new ones are composed over the old.
    state.shown.steps.swap(state.next.steps);
    state.shown.stamp = ++state.lastStamp;
  } else {
    std::swap(state.shown, state.next);
  }
  dropNext(state);
  facts_.clear();
}

bool CompositeStore::nextCovers(CompositeKind kind) const {
  const KindState& state = of(kind);
  for (int root = 0; root < tiling_->rootCount(); ++root) {
    const TileIndex index{static_cast<std::uint8_t>(root), 0, 0, 0};
    if ((!state.drawn.empty() || state.pair.isHeld) && !stateOf(nextKey(kind, index, 0)).present) {
      return false;
    }
  }
  return std::all_of(state.drawn.begin(), state.drawn.end(), [&](const Drawn& drawn) {
    return stateOf(nextKey(kind, drawn.index, drawn.colourLevel)).present;
  });
}

void CompositeStore::wantNext(CompositeKind kind) {
  for (int root = 0; root < tiling_->rootCount(); ++root) {
    wantComposite(nextKey(kind, {static_cast<std::uint8_t>(root), 0, 0, 0}, 0), nextRootPriority);
  }
  for (const Drawn& drawn : of(kind).drawn) {
    wantComposite(nextKey(kind, drawn.index, drawn.colourLevel), nextPriority);
  }
}

void CompositeStore::fetchAhead(CompositeKind kind) {
  const std::size_t tileBytes = std::size_t{4} * colourLayout.size() * colourLayout.size();
  std::size_t left = streamer_.budget() / aheadShare / tileBytes;
  for (const Layer* layer : of(kind).layers) {
    double priority = aheadPriority;
    for (const LayerStepPointer& step : layer->ahead()) {
      const std::shared_ptr<TileProvider>& tiles = step->tiles();
      for (const Drawn& drawn : of(kind).drawn) {
        TileIndex index = drawn.index;
        while (index.level > 0 &&
               (index.level > drawn.colourLevel || !tiles->hasFinerColours(*tiling_, *tiling_->parent(index)))) {
          index = *tiling_->parent(index);
        }
        if (!tiles->overlaps(*tiling_, index)) {
          continue;
        }
        if (left == 0) {
          return;
        }
        --left;
        streamer_.request({step->stream(), index}, priority,
                          [&] { return std::make_unique<ColourJob>(tiles, tiling_, index); });
      }
      priority -= 1.0;
    }
  }
}

std::uint8_t CompositeStore::nextOwnerLevel(CompositeKind kind, const TileIndex& index) const {
  KindState& state = kinds_[static_cast<std::size_t>(kind)];
  if (const auto found = state.nextOwnerLevels.find(index); found != state.nextOwnerLevels.end()) {
    return found->second;
  }
  if (state.nextOwnerLevels.size() > mostFacts) {
    state.nextOwnerLevels.clear();
  }
  const std::optional<TileIndex> parent = tiling_->parent(index);
  const bool own = !parent || anyFiner(kind, state.next, *parent);
  const std::uint8_t level = own ? index.level : nextOwnerLevel(kind, *parent);
  state.nextOwnerLevels.emplace(index, level);
  return level;
}

CompositeKey CompositeStore::nextKey(CompositeKind kind, const TileIndex& index, int colourLevel) const {
  const int ownerLevel =
      of(kind).pair.isPair ? facts(index).ownerLevel[static_cast<std::size_t>(kind)] : nextOwnerLevel(kind, index);
  const int level = std::min(colourLevel, ownerLevel);
  return {kind, ancestor(index, level), of(kind).next.side};
}

}  // namespace meridian::globebrowsing
