// The part of CompositeStore that draws two composites mixed: of two steps in time, or while a layer fades.

#include <algorithm>

#include "globebrowsing/gpu/composite_store.h"

namespace meridian::globebrowsing {

namespace {

/// Of composites that only put an end to mixing: after all that can be seen.
constexpr double endOfMixing = 6.0;

}  // namespace

std::optional<CompositeKind> CompositeStore::kindBetweenSteps() const {
  const auto isBetween = [this](CompositeKind kind) {
    return generations(kind).interpolated() != nullptr || generations(kind).pair().isMixed;
  };
  if (interpolates_ && isBetween(*fading_)) {
    return fading_;
  }
  const auto found = std::find_if(allCompositeKinds.begin(), allCompositeKinds.end(), isBetween);
  return found == allCompositeKinds.end() ? std::nullopt : std::optional(*found);
}

void CompositeStore::updateMixing() {
  const bool goesOn = fading_ && !interpolates_ && (of(*fading_).fade.moves() || drewMixed_);
  mixedLast_ = drewMixed_;
  drewMixed_ = false;
  if (!goesOn) {
    fading_ = kindBetweenSteps();
    interpolates_ = fading_.has_value();
  }
  if (!goesOn && !interpolates_) {
    const auto found = std::find_if(allCompositeKinds.begin(), allCompositeKinds.end(),
                                    [this](CompositeKind kind) { return of(kind).fade.mixes(); });
    fading_ = found == allCompositeKinds.end() ? std::nullopt : std::optional(*found);
  }
  for (Kind& kind : kinds_) {
    kind.noRoomToFade = kind.noRoomToFade && kind.fade.moves();
  }
}

std::optional<CompositeStore::Mixture> CompositeStore::mixture(const CompositeKey& key) const {
  if (mixing_ != key.kind || interpolates_) {
    return std::nullopt;
  }
  const CompositeContents* first = find(key);
  const std::optional<std::uint32_t> other = slots_.peek({key.kind, key.index, CompositeKey::fadeSide});
  if (first == nullptr || !other || first->stamp != slotContents_[*other].stamp) {
    return std::nullopt;
  }
  const LayerOpacities& now = of(key.kind).fade.opacities();
  const LayerOpacities& made = first->layers;
  const OpacityDifference between = difference(made, slotContents_[*other].layers);
  if (between.kind != OpacityDifference::Kind::OneOpacity) {
    return std::nullopt;
  }
  const float weight = mixingWeight(between.first, between.second, opacityOf(now, between.version));
  const OpacityDifference lack = difference(made, now);
  const bool isLack = lack.kind == OpacityDifference::Kind::None ||
                      (lack.kind == OpacityDifference::Kind::OneOpacity && lack.version == between.version);
  return Mixture{*other, std::clamp(weight, 0.0F, 1.0F), isLack && weight >= 0.0F && weight <= 1.0F};
}

std::optional<LayerOpacity> CompositeStore::otherEnd(const CompositeKey& key) const {
  const FadeWatch& fade = of(key.kind).fade;
  const CompositeGenerations& generations = this->generations(key.kind);
  const CompositeContents* first = find(key);
  if (mixing_ != key.kind || !fade.moves() || of(key.kind).noRoomToFade || interpolates_ || generations.hasNext() ||
      first == nullptr || first->stamp != generations.shown().stamp) {
    return std::nullopt;
  }
  const OpacityDifference lack = difference(first->layers, fade.opacities());
  if (lack.kind != OpacityDifference::Kind::OneOpacity || !fade.mixes(lack.version)) {
    return std::nullopt;
  }
  return LayerOpacity{lack.version, fade.end(lack.version, lack.first)};
}

void CompositeStore::endMixing(const CompositeKey& key, const Mixture& mixture, double priority) {
  if (mixture.weight >= 1.0F) {
    slots_.exchange(key, {key.kind, key.index, CompositeKey::fadeSide});
  } else if (mixture.weight > 0.0F && !of(key.kind).fade.moves()) {
    request({key, priority - endOfMixing, false});
  }
}

CompositeStore::Placement CompositeStore::mixedPlacement(const CompositeKey& key, Placement placement) {
  const std::optional<Mixture> mixed = mixture(key);
  if (!mixed || mixed->weight <= 0.0F) {
    return placement;
  }
  drewMixed_ = true;
  useOther(key, frame_ + 1);
  if (mixed->weight >= 1.0F) {
    placement.slot = mixed->slot;
  } else {
    placement.otherSlot = mixed->slot;
    placement.otherWeight = mixed->weight;
  }
  return placement;
}

std::optional<CompositeStore::Placement> CompositeStore::pairedPlacement(const CompositeKey& other,
                                                                         Placement placement) {
  const std::optional<Placement> second = placeAt(other, placement.transform);
  const double weight = generations(other.kind).pair().weight;
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

/// Second composites are kept only as long as there is room for all first ones.
void CompositeStore::useOther(const CompositeKey& key, std::uint64_t frame) {
  if (!of(key.kind).noRoomToFade) {
    slots_.use({key.kind, key.index, CompositeKey::fadeSide}, frame);
  }
}

}  // namespace meridian::globebrowsing
