#include "globebrowsing/gpu/composite_store.h"

#include <algorithm>

#include <fmt/format.h>

#include "globebrowsing/source/tile_layout.h"

namespace meridian::globebrowsing {

namespace {

/// Less for what is drawn and will be exchanged soon.
constexpr double soonReplaced = 4.0;
/// Less for what is there, and not drawn, as roots: who changes a layer wants to see that.
constexpr double unseen = 4.0;

/// The tile's unit square in the composite's texture, whose interior lies within a border.
glm::vec4 textureTransform(const UnitSquareTransform& transform) {
  const glm::dvec2 offset =
      (double{colourLayout.border} + double{colourLayout.interior} * transform.offset) / double{colourLayout.size()};
  const glm::dvec2 scale = double{colourLayout.interior} * transform.scale / double{colourLayout.size()};
  return glm::vec4(glm::vec2(offset), glm::vec2(scale));
}

TileDataPointer makeRelief(const Tiling& tiling, const TileIndex& index, std::vector<float>&& heights) {
  return std::make_shared<const ReliefTile>(tiling, index, heights);
}

}  // namespace

CompositeStore::CompositeStore(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
                               std::unique_ptr<Composer> composer, std::uint32_t capacity)
    : tiling_(tiling),
      layers_(layers),
      streamer_(streamer),
      composer_(std::move(composer)),
      relief_(std::move(tiling), layers, streamer, reliefLayout, makeRelief),
      slots_(capacity),
      slotContents_(capacity) {
  facts_.reserve(mostFacts);
}

void CompositeStore::beginFrame(std::uint64_t frame) {
  frame_ = frame;
  lackedSome_ = missing_ > 0;
  missing_ = 0;
  requests_.clear();
  parts_.clear();
  held_.clear();
  composer_->beginFrame(frame);
  relief_.beginFrame();
  bool changed = facts_.size() > mostFacts;
  for (const CompositeKind kind : allCompositeKinds) {
    changed = updateKind(kind) || changed;
  }
  if (changed) {
    facts_.clear();
  }
  keepStandIns();
  updateFading();
  for (const CompositeKind kind : allCompositeKinds) {
    if (of(kind).hasSteps || of(kind).hasNext) {
      beginNext(kind);
      weighPair(kind);
    }
  }
}

std::uint64_t CompositeStore::settingsVersion(CompositeKind kind) const {
  std::uint64_t sum = 0;
  for (const LayerGroupId group : layerGroups(kind)) {
    sum += layers_.group(group).settingsVersion();
  }
  return sum;
}

bool CompositeStore::updateKind(CompositeKind kind) {
  KindState& state = of(kind);
  bool changed = state.version != settingsVersion(kind);
  if (changed) {
    state.version = settingsVersion(kind);
    takeLayers(kind);
    takeSteps(state);
  }
  const bool coloursHeights = std::any_of(state.layers.begin(), state.layers.end(),
                                          [](const Layer* layer) { return isRelief(layer->sampling()); });
  // What a layer that comes or goes changes, its version tells.
  if (coloursHeights && state.reliefStream != relief_.stream()) {
    state.reliefStream = relief_.stream();
    state.shown.stamp = ++state.lastStamp;
    state.next.stamp = ++state.lastStamp;  // what there is of it will do, and is composed anew after the exchange
    changed = true;
  }
  state.opening.update(state.layers);
  state.fade.update(state.layers, frame_);
  if (inUse(kind)) {
    composer_->setStructure(kind, state.key);
  }
  state.hasSteps = std::any_of(state.layers.begin(), state.layers.end(),
                               [](const Layer* layer) { return layer->provider()->steps() != nullptr; });
  updateInterpolation(state);
  return changed;
}

void CompositeStore::takeLayers(CompositeKind kind) {
  KindState& state = of(kind);
  state.layers.clear();
  state.key = {};
  for (const LayerGroupId id : layerGroups(kind)) {
    const LayerGroup& group = layers_.group(id);
    state.layers.insert(state.layers.end(), group.enabledLayers().begin(), group.enabledLayers().end());
    state.key.append(group.structureKey());
  }
}

void CompositeStore::endFrame() {
  composer_->endFrame();
}

bool CompositeStore::inUse(CompositeKind kind) const {
  return kind == CompositeKind::Base || !of(kind).layers.empty();
}

bool CompositeStore::anyFiner(CompositeKind kind, const Generation& generation, const TileIndex& index) const {
  const std::vector<Layer*>& enabled = of(kind).layers;
  for (std::size_t i = 0; i < enabled.size() && i < generation.steps.size(); ++i) {
    if (isFiner(*enabled[i], generation.steps[i], index)) {
      return true;
    }
  }
  return false;
}

bool CompositeStore::anyFiner(CompositeKind kind, const TileIndex& index) const {
  const KindState& state = of(kind);
  return anyFiner(kind, state.shown, index) || (state.pair.isPair && anyFiner(kind, state.next, index));
}

bool CompositeStore::isFiner(const Layer& layer, const LayerStepPointer& step, const TileIndex& index) const {
  if (isRelief(layer.sampling())) {
    // Lines are as thin as the composite lets them be, however coarse the heights are, as long as their slope tells
    // where they are.
    constexpr int levelsOfLines = 6;
    const int coarser = layer.sampling() == Sampling::Isolines ? levelsOfLines : 0;
    return index.level < coarser || relief_.hasFiner(ancestor(index, index.level - coarser));
  }
  return layer.sampling() == Sampling::Tile && step != nullptr && step->tiles()->hasFinerColours(*tiling_, index);
}

const CompositeStore::Facts& CompositeStore::facts(const TileIndex& index) const {
  if (const auto found = facts_.find(index); found != facts_.end()) {
    return found->second;
  }
  Facts made;
  const std::optional<TileIndex> parent = tiling_->parent(index);
  for (const CompositeKind kind : allCompositeKinds) {
    const auto i = static_cast<std::size_t>(kind);
    // The tile's own composite is worth having only where it shows more than its parent's.
    const bool own = !parent || anyFiner(kind, *parent);
    made.ownerLevel[i] = own ? index.level : facts(*parent).ownerLevel[i];
    made.finer = made.finer || (inUse(kind) && anyFiner(kind, index));
  }
  return facts_.emplace(index, made).first->second;
}

TileIndex CompositeStore::ancestor(TileIndex index, int level) const {
  while (index.level > level) {
    index = *tiling_->parent(index);
  }
  return index;
}

bool CompositeStore::hasFiner(const TileIndex& index) const {
  return facts(index).finer;
}

CompositeKey CompositeStore::shownKey(CompositeKind kind, const TileIndex& index, int colourLevel) const {
  const int level = std::min<int>(colourLevel, facts(index).ownerLevel[static_cast<std::size_t>(kind)]);
  return {kind, ancestor(index, level), of(kind).shown.side};
}

const CompositeStore::Generation& CompositeStore::generationOf(const CompositeKey& key) const {
  const KindState& state = of(key.kind);
  return state.hasNext && key.side == state.next.side ? state.next : state.shown;
}

CompositeStore::State CompositeStore::stateOf(const CompositeKey& key) const {
  const std::optional<std::uint32_t> slot = slots_.peek(key);
  if (!slot) {
    return {false, false};
  }
  const Contents& contents = slotContents_[*slot];
  const Generation& generation = generationOf(key);
  if (contents.stamp < generation.since || contents.stamp != generation.stamp) {
    return {contents.stamp >= generation.since, false};
  }
  if (contents.lack > 0) {
    return {true, false};
  }
  if (difference(contents.layers, of(key.kind).fade.opacities()).kind == OpacityDifference::Kind::None) {
    return {true, true};
  }
  const std::optional<Mixture> mixed = mixture(key);
  return {true, mixed && mixed->exact};
}

CompositeStore::State CompositeStore::state(const TileIndex& index, int colourLevel) const {
  State all;
  for (const CompositeKind kind : allCompositeKinds) {
    if (inUse(kind)) {
      const CompositeKey key = shownKey(kind, index, colourLevel);
      all &= stateOf(key);
      if (const std::optional<CompositeKey> other = pairedKey(key)) {
        all &= stateOf(*other);
      }
    }
  }
  return all;
}

CompositeStore::State CompositeStore::want(const TileIndex& index, int colourLevel, double priority) {
  State all;
  for (const CompositeKind kind : allCompositeKinds) {
    if (inUse(kind)) {
      const CompositeKey key = shownKey(kind, index, colourLevel);
      all &= wantComposite(key, priority);
      if (const std::optional<CompositeKey> other = pairedKey(key)) {
        all &= wantComposite(*other, priority);
      }
    }
  }
  return all;
}

CompositeStore::State CompositeStore::wantComposite(const CompositeKey& key, double priority) {
  slots_.use(key, frame_);
  const State state = stateOf(key);
  const bool isNext = &generationOf(key) == &of(key.kind).next;
  if (!isNext && state.present) {
    if (const std::optional<Mixture> mixed = mixture(key)) {
      useOther(key, frame_);
      if (state.current) {
        endMixing(key, *mixed, priority);
      }
    }
  }
  // What of the next step is there already is brought up to date after the exchange: settings that change all the time
  // would put that off for ever.
  const Pair& pair = of(key.kind).pair;
  if (state.current || (isNext && state.present && !pair.isMixed)) {
    return state;
  }
  if (state.present && of(key.kind).hasNext && !pair.isPair) {
    priority -= soonReplaced;
  }
  if (state.present && slotContents_[*slots_.peek(key)].drawn + 1 < frame_) {
    priority -= unseen;
  }
  if (const std::optional<LayerOpacity> other = otherEnd(key)) {
    request({{key.kind, key.index, CompositeKey::fadeSide}, priority}, *other);
  } else {
    request({key, priority});
  }
  return state;
}

void CompositeStore::keep(const TileIndex& index, int colourLevel) {
  for (const CompositeKind kind : allCompositeKinds) {
    if (inUse(kind)) {
      const CompositeKey key = shownKey(kind, index, colourLevel);
      slots_.use(key, frame_);
      if (const std::optional<CompositeKey> other = pairedKey(key)) {
        slots_.use(*other, frame_);
      }
      if (mixture(key)) {
        useOther(key, frame_);
      }
    }
  }
}

void CompositeStore::compose(double milliseconds) {
  for (const CompositeKind kind : allCompositeKinds) {
    if (of(kind).hasNext) {
      wantNext(kind);
    }
    if (of(kind).hasSteps) {
      fetchAhead(kind);
    }
  }
  std::sort(requests_.begin(), requests_.end(),
            [](const Request& a, const Request& b) { return a.priority > b.priority; });
  double spent = 0.0;
  unplaced_ = 0;
  for (const Request& request : requests_) {
    if (spent >= milliseconds) {
      break;
    }
    const Composed composed = composeOne(request);
    if (composed == Composed::NoRawTiles) {
      break;
    }
    if (composed == Composed::NoSlot) {
      noteFull(request);
      continue;  // those after it may have a slot already
    }
    missing_ -= request.isMissing && request.lack == 0 ? 1 : 0;
    spent += composer_->estimatedMilliseconds({parts_.data() + request.firstPart, request.partCount});
  }
  for (const CompositeKind kind : allCompositeKinds) {
    KindState& state = of(kind);
    if (state.hasNext && (state.crowded || nextCovers(kind))) {
      endNext(state);
    }
    state.wasDrawn = !state.drawn.empty();
    state.drawn.clear();
  }
}

void CompositeStore::noteFull(const Request& request) {
  KindState& state = of(request.key.kind);
  // Second composites only use what room there is.
  if (interpolates_ && of(*fading_).pair.isPair) {
    of(*fading_).crowded = true;
  } else if (mixing_ && (request.key.side == CompositeKey::fadeSide || mixedLast_)) {
    of(*mixing_).noRoomToFade = true;
  } else if (&generationOf(request.key) == &state.next) {
    state.crowded = true;
  } else {
    ++unplaced_;
  }
}

CompositeStore::Composed CompositeStore::composeOne(const Request& request) {
  std::optional<std::uint32_t> slot = slots_.use(request.key, frame_);
  const bool had = slot.has_value();
  if (!had) {
    slot = slots_.take(request.key, frame_, [](const CompositeKey&) {});
  }
  if (!slot) {
    return Composed::NoSlot;
  }
  const std::span<const CompositionPart> parts(parts_.data() + request.firstPart, request.partCount);
  if (!composer_->compose(*slot, request.key.kind, parts)) {
    if (!had) {
      slots_.release([&](const CompositeKey& key) { return key == request.key; });
    }
    return Composed::NoRawTiles;
  }
  ++composedCount_;
  Contents& contents = slotContents_[*slot];
  contents.stamp = generationOf(request.key).stamp;
  contents.lack = request.lack;
  contents.layers.clear();
  for (const CompositionPart& part : parts) {
    contents.layers.push_back({part.layer->version(), part.opacity});
  }
  return Composed::Done;
}

std::optional<CompositeStore::Placement> CompositeStore::place(CompositeKind kind, const TileIndex& index,
                                                               int colourLevel) {
  KindState& state = of(kind);
  if (state.hasSteps) {
    state.drawn.push_back({index, colourLevel});
  }
  UnitSquareTransform transform;
  TileIndex at = index;
  const int ownerLevel = std::min<int>(colourLevel, facts(index).ownerLevel[static_cast<std::size_t>(kind)]);
  std::optional<Placement> alone;  // of the nearest tile that has one of two composites to be mixed
  while (true) {
    if (at.level <= ownerLevel) {
      const CompositeKey key{kind, at, state.shown.side};
      const std::optional<Placement> own = placeAt(key, textureTransform(transform));
      const std::optional<CompositeKey> other = pairedKey(key);
      const std::optional<Placement> placement = own && other ? pairedPlacement(*other, *own) : own;
      if (placement) {
        return placement;
      }
      alone = alone ? alone : own;
    }
    const std::optional<TileIndex> parent = tiling_->parent(at);
    if (!parent) {
      return alone;
    }
    transform = transform.then(tiling_->inParent(at));
    at = *parent;
  }
}

std::optional<CompositeStore::Placement> CompositeStore::placeAt(const CompositeKey& key, const glm::vec4& transform) {
  const std::optional<std::uint32_t> slot = slots_.peek(key);
  if (!slot || slotContents_[*slot].stamp < generationOf(key).since) {
    return std::nullopt;
  }
  // What this frame draws must still be there when the next composes, or chunks without a composite would flicker.
  slots_.use(key, frame_ + 1);
  slotContents_[*slot].drawn = frame_;
  return mixedPlacement(key, {*slot, transform});
}

std::string CompositeStore::waitingFor() const {
  for (const CompositeKind kind : allCompositeKinds) {
    const KindState& state = of(kind);
    if (state.version != settingsVersion(kind)) {
      return "layers have changed";
    }
    const std::vector<Layer*>& enabled = state.layers;
    for (std::size_t i = 0; i < enabled.size(); ++i) {
      if (enabled[i]->awaitsData()) {
        return fmt::format("{} is being opened", enabled[i]->uri());
      }
      if (state.wasDrawn && !state.pair.isHeld && i < state.shown.steps.size() &&
          enabled[i]->step() != state.shown.steps[i]) {
        return fmt::format("{} shows another time", enabled[i]->uri());
      }
    }
    if (state.wasDrawn && state.interpolated && !state.pair.isMixed && kindBetweenSteps() == kind) {
      return fmt::format("{} shows one of two times", enabled[*state.interpolated]->uri());
    }
    if (inUse(kind) && !composer_->ownProgramReady(kind) && !composer_->ownProgramFailed(kind)) {
      return "a composition program is being built";
    }
  }
  const std::size_t waiting = missing_ - unplaced_;
  return waiting > 0 ? fmt::format("{} composites are waiting", waiting) : std::string();
}

}  // namespace meridian::globebrowsing
