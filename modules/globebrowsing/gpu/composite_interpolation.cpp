// The part of CompositeStore that mixes the composites of two steps in time while a layer is between them.

#include <algorithm>

#include "globebrowsing/gpu/composite_store.h"

namespace meridian::globebrowsing {

namespace {

/// Whether both layers are between steps of the same times: then one weight is right for both.
bool isBetweenTheSame(const Layer& a, const Layer& b) {
  return a.otherStep() != nullptr && b.otherStep() != nullptr && a.step()->when().instant == b.step()->when().instant &&
         a.otherStep()->when().instant == b.otherStep()->when().instant;
}

}  // namespace

void CompositeStore::updateInterpolation(KindState& state) const {
  state.interpolated.reset();
  for (std::size_t i = state.layers.size(); i-- > 0;) {
    const Layer& layer = *state.layers[i];
    if (layer.otherStep() != nullptr && layer.effectiveOpacity() > 0.0 && mixesExactly(state.layers, i)) {
      state.interpolated = i;
      break;
    }
  }
  if (!state.interpolated || state.layers[*state.interpolated]->step()->when().id != state.crowdedStep) {
    state.crowdedStep.reset();
  } else {
    state.interpolated.reset();
  }
}

std::optional<CompositeKind> CompositeStore::kindBetweenSteps() const {
  const auto isBetween = [this](CompositeKind kind) { return of(kind).interpolated || of(kind).pair.isMixed; };
  if (interpolates_ && isBetween(*fading_)) {
    return fading_;
  }
  const auto found = std::find_if(allCompositeKinds.begin(), allCompositeKinds.end(), isBetween);
  return found == allCompositeKinds.end() ? std::nullopt : std::optional(*found);
}

bool CompositeStore::isInterpolated(CompositeKind kind) const {
  return interpolates_ && fading_ == kind && of(kind).interpolated;
}

const LayerStepPointer& CompositeStore::stepOf(const KindState& state, std::size_t layer, bool other) const {
  const Layer& asked = *state.layers[layer];
  if (other && isBetweenTheSame(asked, *state.layers[*state.interpolated]) && mixesExactly(state.layers, layer)) {
    return asked.otherStep();
  }
  return asked.step() != nullptr ? asked.step() : state.shown.steps[layer];
}

bool CompositeStore::isOf(const KindState& state, const Generation& generation, bool other) const {
  for (std::size_t i = 0; i < state.layers.size(); ++i) {
    if (generation.steps[i] != stepOf(state, i, other)) {
      return false;
    }
  }
  return true;
}

/// While one layer stays between its steps, others go to theirs tile by tile, in both generations: there is no third to
/// compose them in.
void CompositeStore::keepPair(CompositeKind kind) {
  KindState& state = of(kind);
  if (!state.pair.isPair || !isInterpolated(kind)) {
    return;
  }
  const std::size_t layer = *state.interpolated;
  const bool isShownOther = state.shown.steps[layer] == stepOf(state, layer, true);
  if (state.shown.steps[layer] != stepOf(state, layer, isShownOther) ||
      state.next.steps[layer] != stepOf(state, layer, !isShownOther)) {
    return;
  }
  const auto take = [&](Generation& generation, bool other) {
    if (isOf(state, generation, other)) {
      return;
    }
    for (std::size_t i = 0; i < state.layers.size(); ++i) {
      generation.steps[i] = stepOf(state, i, other);
    }
    generation.stamp = ++state.lastStamp;
    facts_.clear();
  };
  take(state.shown, isShownOther);
  take(state.next, !isShownOther);
}

void CompositeStore::weighPair(CompositeKind kind) {
  KindState& state = of(kind);
  Pair& pair = state.pair;
  if (!state.hasNext) {
    return;
  }
  const bool isBetween = isInterpolated(kind);
  const bool isFromPresent = isBetween && isOf(state, state.shown, false) && isOf(state, state.next, true);
  const bool isFromOther = isBetween && isOf(state, state.shown, true) && isOf(state, state.next, false);
  pair.isHeld = isFromPresent || isFromOther;
  if (pair.isHeld) {
    const double other = state.layers[*state.interpolated]->otherWeight();
    pair.weight = isFromPresent ? other : 1.0 - other;
  } else {
    pair.weight = 1.0;  // what was mixed is the time of before; it is exchanged as soon as the next one covers the view
  }
  if (pair.isHeld && !pair.isPair) {
    pair.isPair = true;
    facts_.clear();
  }
}

void CompositeStore::endNext(KindState& state) {
  if (!state.pair.isHeld) {
    exchange(state);
  } else if (state.crowded) {
    state.crowdedStep = state.layers[*state.interpolated]->step()->when().id;
    dropNext(state);
  } else {
    // What is not drawn yet is filled with the present step first: the other may be long in coming.
    state.pair.isMixed = state.pair.isMixed || !state.drawn.empty() || missing_ == 0;
  }
}

std::optional<CompositeKey> CompositeStore::pairedKey(const CompositeKey& key) const {
  const KindState& state = of(key.kind);
  return state.pair.isMixed ? std::optional(CompositeKey{key.kind, key.index, state.next.side}) : std::nullopt;
}

std::optional<CompositeStore::Placement> CompositeStore::pairedPlacement(const CompositeKey& other,
                                                                         Placement placement) {
  const std::optional<Placement> second = placeAt(other, placement.transform);
  const double weight = of(other.kind).pair.weight;
  if (!second) {
    return std::nullopt;
  }
  if (weight >= 1.0) {
    return second;
  }
  if (weight > 0.0 && mixing_ == other.kind) {
    placement.otherSlot = second->slot;
    placement.otherWeight = static_cast<float>(weight);
  }
  return placement;
}

}  // namespace meridian::globebrowsing
