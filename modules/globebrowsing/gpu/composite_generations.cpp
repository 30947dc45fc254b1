#include "globebrowsing/gpu/composite_generations.h"

#include <algorithm>
#include <utility>

#include "globebrowsing/layers/layer_opacities.h"

namespace meridian::globebrowsing {

namespace {

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

/// Whether both layers are between steps of the same times: then one weight is right for both.
bool isBetweenTheSame(const Layer& a, const Layer& b) {
  return a.otherStep() != nullptr && b.otherStep() != nullptr && a.step()->when().instant == b.step()->when().instant &&
         a.otherStep()->when().instant == b.otherStep()->when().instant;
}

std::uint64_t settingsVersion(CompositeKind kind, const LayerManager& layers) {
  std::uint64_t sum = 0;
  for (const LayerGroupId group : layerGroups(kind)) {
    sum += layers.settingsVersion(group);
  }
  return sum;
}

}  // namespace

bool CompositeGenerations::isOutdated(CompositeKind kind, const LayerManager& layers) const {
  return version_ != settingsVersion(kind, layers);
}

void CompositeGenerations::update(CompositeKind kind, const LayerManager& layers, std::uint32_t reliefStream) {
  if (isOutdated(kind, layers)) {
    version_ = settingsVersion(kind, layers);
    layers_.clear();
    key_ = {};
    for (const LayerGroupId id : layerGroups(kind)) {
      const LayerGroup& group = layers.group(id);
      layers_.insert(layers_.end(), group.enabledLayers().begin(), group.enabledLayers().end());
      key_.append(group.structureKey());
    }
    takeSteps();
    ++changes_;
  }
  const bool coloursHeights =
      std::any_of(layers_.begin(), layers_.end(), [](const Layer* layer) { return isRelief(layer->sampling()); });
  // What a layer that comes or goes changes, its version tells.
  if (coloursHeights && reliefStream_ != reliefStream) {
    reliefStream_ = reliefStream;
    shown_.stamp = ++lastStamp_;
    next_.stamp = ++lastStamp_;  // what there is of it will do, and is composed anew after the exchange
    ++changes_;
  }
  hasSteps_ = std::any_of(layers_.begin(), layers_.end(),
                          [](const Layer* layer) { return layer->provider()->steps() != nullptr; });
  updateInterpolated();
}

/// Layers came, went or were changed: those that stay also stay at the step that is drawn.
void CompositeGenerations::takeSteps() {
  takeSteps(shown_);
  if (pair_.isMixed) {
    takeSteps(next_);  // it is drawn, and brought up to date like the shown one
    return;
  }
  // What of the next step was composed before the change will do, and is composed anew after the exchange.
  const bool isOfThese = std::equal(layers_.begin(), layers_.end(), next_.steps.begin(), next_.steps.end(),
                                    [](const Layer* layer, const LayerStepPointer& step) {
                                      return step == nullptr || step->source() == layer->provider().get();
                                    });
  if (!isOfThese) {
    dropNext();
  }
}

void CompositeGenerations::takeSteps(Generation& generation) {
  std::vector<LayerStepPointer> steps;
  bool comesWithSteps = false;
  for (const Layer* layer : layers_) {
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
    generation.stamp = ++lastStamp_;
  }
}

void CompositeGenerations::updateInterpolated() {
  interpolated_.reset();
  for (std::size_t i = layers_.size(); i-- > 0;) {
    const Layer& layer = *layers_[i];
    if (layer.otherStep() != nullptr && layer.effectiveOpacity() > 0.0 && mixesExactly(layers_, i)) {
      interpolated_ = i;
      break;
    }
  }
  if (!interpolated_ || layers_[*interpolated_]->step()->when().id != crowdedStep_) {
    crowdedStep_.reset();
  } else {
    interpolated_.reset();
  }
}

const LayerStepPointer& CompositeGenerations::stepOf(std::size_t layer, bool other) const {
  const Layer& asked = *layers_[layer];
  if (other && isBetweenTheSame(asked, *interpolated()) && mixesExactly(layers_, layer)) {
    return asked.otherStep();
  }
  return asked.step() != nullptr ? asked.step() : shown_.steps[layer];
}

bool CompositeGenerations::isOf(const Generation& generation, bool other) const {
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    if (generation.steps[i] != stepOf(i, other)) {
      return false;
    }
  }
  return true;
}

void CompositeGenerations::setSteps(Generation& generation, bool other) {
  generation.steps.resize(layers_.size());
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    generation.steps[i] = stepOf(i, other);
  }
  generation.stamp = ++lastStamp_;
  ++changes_;
}

void CompositeGenerations::follow(bool mixes, const Leave& mayBegin) {
  if (hasSteps_ || hasNext_) {
    const bool isBetween = mixes && interpolated_;
    if (isBetween && pair_.isPair) {
      keepPair();
    }
    beginNext(isBetween, mayBegin);
    weighPair(isBetween);
  }
}

/// While one layer stays between its steps, others go to theirs tile by tile, in both generations: there is no third to
/// compose them in.
void CompositeGenerations::keepPair() {
  const std::size_t layer = *interpolated_;
  const bool isShownOther = shown_.steps[layer] == stepOf(layer, true);
  if (shown_.steps[layer] != stepOf(layer, isShownOther) || next_.steps[layer] != stepOf(layer, !isShownOther)) {
    return;
  }
  if (!isOf(shown_, isShownOther)) {
    setSteps(shown_, isShownOther);
  }
  if (!isOf(next_, !isShownOther)) {
    setSteps(next_, !isShownOther);
  }
}

void CompositeGenerations::beginNext(bool isBetween, const Leave& mayBegin) {
  // Of two steps that are to be mixed, the one that is not drawn yet.
  const bool toOther = isBetween && isOf(shown_, false);
  if (hasNext_) {
    // What is on the way to the present step is finished first, or a time that runs faster would never show any.
    bool onTheWay = true;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      onTheWay = onTheWay && isOnTheWay(shown_.steps[i], next_.steps[i], stepOf(i, toOther));
    }
    if (onTheWay) {
      return;
    }
    dropNext();
  }
  if ((toOther ? mayBegin.toMix : mayBegin.toExchange) && !isOf(shown_, toOther)) {
    setSteps(next_, toOther);
    next_.since = next_.stamp;
    next_.side = shown_.side == 0 ? 1 : 0;
    hasNext_ = true;
    crowded_ = false;
  }
}

void CompositeGenerations::weighPair(bool isBetween) {
  if (!hasNext_) {
    return;
  }
  const bool isFromPresent = isBetween && isOf(shown_, false) && isOf(next_, true);
  const bool isFromOther = isBetween && isOf(shown_, true) && isOf(next_, false);
  pair_.isHeld = isFromPresent || isFromOther;
  if (pair_.isHeld) {
    const double other = interpolated()->otherWeight();
    pair_.weight = isFromPresent ? other : 1.0 - other;
  } else {
    // What was mixed is the time of before; it is exchanged as soon as the next one covers the view.
    pair_.weight = 1.0;
  }
  if (pair_.isHeld && !pair_.isPair) {
    pair_.isPair = true;
    ++changes_;
  }
}

void CompositeGenerations::endNext(bool isFilled) {
  if (!pair_.isHeld) {
    exchange();
  } else if (crowded_) {
    crowdedStep_ = interpolated()->step()->when().id;
    dropNext();
  } else {
    // What is not drawn yet is filled with the present step first: the other may be long in coming.
    pair_.isMixed = pair_.isMixed || isFilled;
  }
}

void CompositeGenerations::exchange() {
  if (crowded_ && !pair_.isMixed) {
    // Without room for both, the new ones are composed over the old.
    shown_.steps.swap(next_.steps);
    shown_.stamp = ++lastStamp_;
  } else {
    std::swap(shown_, next_);
  }
  dropNext();
  ++changes_;
}

void CompositeGenerations::dropNext() {
  next_.steps.clear();
  hasNext_ = false;
  if (pair_.isPair) {
    pair_ = {};
    ++changes_;
  }
}

}  // namespace meridian::globebrowsing
