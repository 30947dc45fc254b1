// The part of CompositeStore that gathers what composites are made from.

#include <algorithm>
#include <span>

#include "globebrowsing/gpu/composite_store.h"
#include "globebrowsing/providers/raw_tile_job.h"

namespace meridian::globebrowsing {

void CompositeStore::keepStandIns() {
  keepRoots(streamer_, *tiling_, relief_.stream());
  for (const KindState& state : kinds_) {
    for (const LayerStepPointer& step : state.shown.steps) {
      if (step != nullptr) {
        keepRoots(streamer_, *tiling_, step->stream());
      }
    }
  }
}

void CompositeStore::request(Request request, const LayerOpacity& other) {
  const KindState& state = of(request.key.kind);
  // Many chunks may draw the same ancestor's composite.
  if (std::any_of(requests_.begin(), requests_.end(), [&](const Request& r) { return r.key == request.key; })) {
    return;
  }
  const bool isNext = &generationOf(request.key) == &state.next;
  request.isMissing = request.isMissing && (!isNext || state.pair.isMixed);
  missing_ += request.isMissing ? 1 : 0;
  if (composer_->ready(request.key.kind) && !state.opening.waits()) {
    request.firstPart = parts_.size();
    const Lack lack = gather(request.key, request.priority, other);
    request.partCount = parts_.size() - request.firstPart;
    request.lack = lack.coarser;
    if (lack.coarser == 0 || (!lack.comesSoon && isGain(request))) {
      requests_.push_back(request);
    } else {
      parts_.resize(request.firstPart);
    }
  }
}

bool CompositeStore::isGain(const Request& request) const {
  const std::span<const CompositionPart> parts(parts_.data() + request.firstPart, request.partCount);
  const CompositeKey& key = request.key;
  const std::optional<std::uint32_t> first = slots_.peek({key.kind, key.index, of(key.kind).shown.side});
  if (key.side == CompositeKey::fadeSide && first && request.lack > slotContents_[*first].lack) {
    return false;  // the layer that is late would fade, too
  }
  const std::optional<std::uint32_t> slot = slots_.peek(key);
  const auto hasSomething = [](const CompositionPart& part) {
    return part.tile != nullptr || part.relief != nullptr || part.layer->sampling() == Sampling::SolidColor;
  };
  const bool isEmpty = std::none_of(parts.begin(), parts.end(), hasSomething);
  if (!slot) {
    return !isEmpty;
  }
  const Contents& there = slotContents_[*slot];
  if (isEmpty) {
    // An ancestor's composite is better than nothing, unless what is drawn is no longer enabled.
    return std::any_of(there.layers.begin(), there.layers.end(), [&parts](const LayerOpacity& layer) {
      return std::none_of(parts.begin(), parts.end(),
                          [&](const CompositionPart& part) { return part.layer->version() == layer.version; });
    });
  }
  const auto isThere = [](const CompositionPart& part, const LayerOpacity& layer) {
    return part.layer->version() == layer.version && part.opacity == layer.opacity;
  };
  return there.stamp != generationOf(key).stamp || request.lack < there.lack ||
         !std::equal(parts.begin(), parts.end(), there.layers.begin(), there.layers.end(), isThere);
}

bool CompositeStore::showsEarlier(const CompositeKey& key) const {
  const std::optional<std::uint32_t> slot = slots_.peek(key);
  const Generation& generation = generationOf(key);
  return slot && slotContents_[*slot].stamp >= generation.since && slotContents_[*slot].stamp != generation.stamp;
}

bool CompositeStore::mayLack(const Layer& layer, const CompositeKey& key) const {
  return layer.provider()->steps() == nullptr || (&generationOf(key) == &of(key.kind).shown && !showsEarlier(key));
}

Lack CompositeStore::gather(const CompositeKey& key, double priority, const LayerOpacity& other) {
  Lack lack;
  const KindState& state = of(key.kind);
  const Generation& generation = generationOf(key);
  for (std::size_t i = 0; i < state.layers.size(); ++i) {
    const LayerOpacity& now = state.fade.opacities()[i];
    CompositionPart part;
    part.layer = state.layers[i];
    part.opacity = now.version == other.version ? other.opacity : now.opacity;
    lack += gatherPart(part, generation.steps[i], key, priority);
    parts_.push_back(part);
  }
  return lack;
}

Lack CompositeStore::gatherPart(CompositionPart& part, const LayerStepPointer& step, const CompositeKey& key,
                                double priority) {
  const bool colourHeights = isRelief(part.layer->sampling());
  if (!colourHeights && (part.layer->sampling() != Sampling::Tile || step == nullptr)) {
    return {};
  }
  const auto hasFinerData = [&](const TileIndex& tile) {
    return colourHeights ? relief_.hasFiner(tile) : step->tiles()->hasFinerColours(*tiling_, tile);
  };
  TileIndex index = key.index;
  while (index.level > 0 && !hasFinerData(*tiling_->parent(index))) {
    part.transform = part.transform.then(tiling_->inParent(index));
    index = *tiling_->parent(index);
  }
  TileAnswer answer;
  if (colourHeights) {
    part.key = {relief_.stream(), index};
    part.pixelMetres = pixelMetres(*tiling_, key.index);
    answer = relief_.request(index, priority, showsEarlier(key));
  } else if (const std::shared_ptr<TileProvider>& tiles = step->tiles(); tiles->overlaps(*tiling_, index)) {
    part.key = {step->stream(), index};
    answer = streamer_.request(part.key, priority, [&] { return std::make_unique<ColourJob>(tiles, tiling_, index); });
  }
  Lack lack{colourHeights ? relief_.lack(index) : 0};
  const TileDataPointer* data = answer.data;
  if (answer.state == TileAnswer::State::Pending) {
    if (!answer.isLate || !mayLack(*part.layer, key)) {
      return {Lack::everything, true};
    }
    const StandIn standIn = findStandIn(streamer_, *tiling_, part.key);
    part.key.index = standIn.index;
    part.transform = part.transform.then(standIn.within);
    data = standIn.tile;
    lack = {standIn.coarser};
  }
  if (data != nullptr) {
    held_.push_back(*data);
    part.tile = colourHeights ? nullptr : &static_cast<const ColourTile&>(*held_.back());
    part.relief = colourHeights ? &static_cast<const ReliefTile&>(*held_.back()) : nullptr;
  }
  return lack;
}

}  // namespace meridian::globebrowsing
