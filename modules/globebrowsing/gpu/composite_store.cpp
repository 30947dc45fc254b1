#include "globebrowsing/gpu/composite_store.h"

#include <algorithm>

#include <fmt/format.h>

#include "globebrowsing/providers/raw_tile_job.h"
#include "globebrowsing/source/tile_layout.h"

namespace meridian::globebrowsing {

namespace {

/// Facts of tiles long gone are dropped when there are that many.
constexpr std::size_t mostFacts = 1 << 15;
/// Of composites of the next step in time: among the tiles that selection needs (1 to 2), roots before all (3).
constexpr double nextPriority = 1.5;
constexpr double nextRootPriority = 3.0;
/// Less for what is drawn and will be exchanged soon.
constexpr double soonReplaced = 4.0;
/// Of raw tiles that nobody sees yet: after all others.
constexpr double aheadPriority = -5.0;
/// At most that share of the tile cache is fetched ahead for each kind.
constexpr std::size_t aheadShare = 8;

/// The tile's unit square in the composite's texture, whose interior lies within a border.
glm::vec4 textureTransform(const UnitSquareTransform& transform) {
  const glm::dvec2 offset =
      (double{colourLayout.border} + double{colourLayout.interior} * transform.offset) / double{colourLayout.size()};
  const glm::dvec2 scale = double{colourLayout.interior} * transform.scale / double{colourLayout.size()};
  return glm::vec4(glm::vec2(offset), glm::vec2(scale));
}

TileIndex ancestorOf(const Tiling& tiling, TileIndex index, int level) {
  while (index.level > level) {
    index = *tiling.parent(index);
  }
  return index;
}

bool isTile(const Layer& layer) {
  return layer.sampling() == Sampling::Tile;
}

TileDataPointer makeRelief(const Tiling& tiling, const TileIndex& index, std::vector<float> heights) {
  return std::make_shared<const ReliefTile>(tiling, index, heights);
}

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

CompositeStore::CompositeStore(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
                               std::unique_ptr<Composer> composer, std::uint32_t capacity)
    : tiling_(tiling),
      layers_(layers),
      streamer_(streamer),
      composer_(std::move(composer)),
      relief_(std::move(tiling), layers, streamer, reliefLayout, makeRelief),
      slots_(capacity),
      slotStamps_(capacity) {
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
}

bool CompositeStore::updateKind(CompositeKind kind) {
  KindState& state = of(kind);
  const LayerGroup& group = layers_.group(layerGroup(kind));
  const std::vector<Layer*>& enabled = group.enabledLayers();
  const bool colourHeights =
      std::any_of(enabled.begin(), enabled.end(), [](const Layer* layer) { return isRelief(layer->sampling()); });
  const std::uint32_t reliefStream = colourHeights ? relief_.stream() : 0;
  const bool changed = state.version != group.settingsVersion() || state.reliefStream != reliefStream;
  if (changed) {
    state.version = group.settingsVersion();
    state.reliefStream = reliefStream;
    takeSteps(state, enabled);
    state.shown.stamp = ++state.lastStamp;
  }
  state.opening.update(group);
  if (inUse(kind)) {
    composer_->setStructure(kind, group.structureKey());
  }
  state.hasSteps = std::any_of(enabled.begin(), enabled.end(),
                               [](const Layer* layer) { return layer->provider()->steps() != nullptr; });
  if (state.hasSteps) {
    beginNext(state, enabled);
  }
  return changed;
}

/// Layers came, went or were changed: those that stay also stay at the step that is drawn.
void CompositeStore::takeSteps(KindState& state, const std::vector<Layer*>& enabled) {
  std::vector<LayerStepPointer> steps;
  for (const Layer* layer : enabled) {
    const auto drawn = std::find_if(state.shown.steps.begin(), state.shown.steps.end(), [layer](const auto& step) {
      return step != nullptr && step->source() == layer->provider().get();
    });
    steps.push_back(drawn != state.shown.steps.end() ? *drawn : layer->step());
  }
  state.shown.steps = std::move(steps);
  if (state.hasNext && state.next.steps.size() == enabled.size() &&
      std::equal(enabled.begin(), enabled.end(), state.next.steps.begin(), [](const Layer* layer, const auto& step) {
        return step == nullptr || step->source() == layer->provider().get();
      })) {
    // What of the next step was composed before the change will do, and is composed anew after the exchange.
    state.next.stamp = ++state.lastStamp;
  } else {
    state.hasNext = false;
  }
}

void CompositeStore::beginNext(KindState& state, const std::vector<Layer*>& enabled) {
  if (state.hasNext) {
    // What is on the way to the present step is finished first, or a time that runs faster would never show any.
    bool onTheWay = true;
    for (std::size_t i = 0; i < enabled.size(); ++i) {
      onTheWay = onTheWay && isOnTheWay(state.shown.steps[i], state.next.steps[i], enabled[i]->step());
    }
    if (onTheWay) {
      return;
    }
    state.hasNext = false;
  }
  // Where nothing is drawn the last step is finished first as well, or a surface that is still filled never would be.
  if (state.drawn.empty() && lackedSome_) {
    return;
  }
  const auto isOther = [](const Layer* layer, const LayerStepPointer& step) {
    return layer->step() != nullptr && layer->step() != step;
  };
  if (std::equal(enabled.begin(), enabled.end(), state.shown.steps.begin(),
                 [&](const Layer* layer, const LayerStepPointer& step) { return !isOther(layer, step); })) {
    return;
  }
  state.next.steps.clear();
  for (std::size_t i = 0; i < enabled.size(); ++i) {
    state.next.steps.push_back(enabled[i]->step() != nullptr ? enabled[i]->step() : state.shown.steps[i]);
  }
  state.next.side = state.shown.side == 0 ? 1 : 0;
  state.next.since = state.next.stamp = ++state.lastStamp;
  state.hasNext = true;
  state.crowded = false;
  state.nextOwnerLevels.clear();
}

void CompositeStore::exchange(KindState& state) {
  if (state.crowded) {
    // Without room for both, the new ones are composed over the old.
    state.shown.steps.swap(state.next.steps);
    state.shown.stamp = ++state.lastStamp;
  } else {
    std::swap(state.shown, state.next);
  }
  state.next.steps.clear();
  state.hasNext = false;
  facts_.clear();
}

bool CompositeStore::nextCovers(CompositeKind kind) const {
  const KindState& state = of(kind);
  for (int root = 0; root < tiling_->rootCount(); ++root) {
    const TileIndex index{static_cast<std::uint8_t>(root), 0, 0, 0};
    if (!state.drawn.empty() && !stateOf(nextKey(kind, index, 0)).present) {
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
  for (const Layer* layer : layers_.group(layerGroup(kind)).enabledLayers()) {
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

void CompositeStore::endFrame() {
  composer_->endFrame();
}

bool CompositeStore::inUse(CompositeKind kind) const {
  return kind == CompositeKind::Base || !layers_.group(layerGroup(kind)).enabledLayers().empty();
}

bool CompositeStore::anyFiner(CompositeKind kind, const Generation& generation, const TileIndex& index) const {
  const std::vector<Layer*>& enabled = layers_.group(layerGroup(kind)).enabledLayers();
  for (std::size_t i = 0; i < enabled.size() && i < generation.steps.size(); ++i) {
    if (isFiner(*enabled[i], generation.steps[i], index)) {
      return true;
    }
  }
  return false;
}

bool CompositeStore::isFiner(const Layer& layer, const LayerStepPointer& step, const TileIndex& index) const {
  if (isRelief(layer.sampling())) {
    // Lines are as thin as the composite lets them be, however coarse the heights are.
    return layer.sampling() == Sampling::Isolines ? index.level < maximumLevel : relief_.hasFiner(index);
  }
  return isTile(layer) && step != nullptr && step->tiles()->hasFinerColours(*tiling_, index);
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
    const bool own = !parent || anyFiner(kind, of(kind).shown, *parent);
    made.ownerLevel[i] = own ? index.level : facts(*parent).ownerLevel[i];
    made.finer = made.finer || (inUse(kind) && anyFiner(kind, of(kind).shown, index));
  }
  return facts_.emplace(index, made).first->second;
}

std::uint8_t CompositeStore::nextOwnerLevel(CompositeKind kind, const TileIndex& index) const {
  KindState& state = kinds_[static_cast<std::size_t>(kind)];
  if (const auto found = state.nextOwnerLevels.find(index); found != state.nextOwnerLevels.end()) {
    return found->second;
  }
  const std::optional<TileIndex> parent = tiling_->parent(index);
  const bool own = !parent || anyFiner(kind, state.next, *parent);
  const std::uint8_t level = own ? index.level : nextOwnerLevel(kind, *parent);
  state.nextOwnerLevels.emplace(index, level);
  return level;
}

bool CompositeStore::hasFiner(const TileIndex& index) const {
  return facts(index).finer;
}

CompositeKey CompositeStore::shownKey(CompositeKind kind, const TileIndex& index, int colourLevel) const {
  const int level = std::min<int>(colourLevel, facts(index).ownerLevel[static_cast<std::size_t>(kind)]);
  return {kind, ancestorOf(*tiling_, index, level), of(kind).shown.side};
}

CompositeKey CompositeStore::nextKey(CompositeKind kind, const TileIndex& index, int colourLevel) const {
  const int level = std::min<int>(colourLevel, nextOwnerLevel(kind, index));
  return {kind, ancestorOf(*tiling_, index, level), of(kind).next.side};
}

const CompositeStore::Generation& CompositeStore::generationOf(const CompositeKey& key) const {
  const KindState& state = of(key.kind);
  return state.hasNext && key.side == state.next.side ? state.next : state.shown;
}

CompositeStore::State CompositeStore::stateOf(const CompositeKey& key) const {
  const std::optional<std::uint32_t> slot = slots_.peek(key);
  const Generation& generation = generationOf(key);
  return {slot && slotStamps_[*slot] >= generation.since, slot && slotStamps_[*slot] == generation.stamp};
}

CompositeStore::State CompositeStore::state(const TileIndex& index, int colourLevel) const {
  State all;
  for (const CompositeKind kind : allCompositeKinds) {
    if (inUse(kind)) {
      const State one = stateOf(shownKey(kind, index, colourLevel));
      all = {all.present && one.present, all.current && one.current};
    }
  }
  return all;
}

CompositeStore::State CompositeStore::want(const TileIndex& index, int colourLevel, double priority) {
  State all;
  for (const CompositeKind kind : allCompositeKinds) {
    if (inUse(kind)) {
      const State one = wantComposite(shownKey(kind, index, colourLevel), priority);
      all = {all.present && one.present, all.current && one.current};
    }
  }
  return all;
}

CompositeStore::State CompositeStore::wantComposite(const CompositeKey& key, double priority) {
  slots_.use(key, frame_);
  const State state = stateOf(key);
  const bool isNext = &generationOf(key) == &of(key.kind).next;
  // What of the next step is there already is brought up to date after the exchange: settings that change all the time
  // would put that off for ever.
  if (state.current || (isNext && state.present)) {
    return state;
  }
  // Many chunks may draw the same ancestor's composite.
  if (std::any_of(requests_.begin(), requests_.end(), [&](const Request& r) { return r.key == key; })) {
    return state;
  }
  missing_ += isNext ? 0 : 1;
  if (state.present && of(key.kind).hasNext) {
    priority -= soonReplaced;
  }
  if (composer_->ready(key.kind) && !of(key.kind).opening.waits()) {
    Request request{key, priority, parts_.size(), 0};
    if (gather(key, priority)) {
      request.partCount = parts_.size() - request.firstPart;
      requests_.push_back(request);
    } else {
      parts_.resize(request.firstPart);
    }
  }
  return state;
}

bool CompositeStore::gather(const CompositeKey& key, double priority) {
  bool all = true;
  const std::vector<Layer*>& enabled = layers_.group(layerGroup(key.kind)).enabledLayers();
  const Generation& generation = generationOf(key);
  for (std::size_t i = 0; i < enabled.size(); ++i) {
    CompositionPart part;
    part.layer = enabled[i];
    all = gatherPart(part, generation.steps[i], key, priority) && all;
    parts_.push_back(part);
  }
  return all;
}

bool CompositeStore::gatherPart(CompositionPart& part, const LayerStepPointer& step, const CompositeKey& key,
                                double priority) {
  const bool colourHeights = isRelief(part.layer->sampling());
  if (!colourHeights && (!isTile(*part.layer) || step == nullptr)) {
    return true;
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
    answer = relief_.request(index, priority);
  } else if (const std::shared_ptr<TileProvider>& tiles = step->tiles(); tiles->overlaps(*tiling_, index)) {
    part.key = {step->stream(), index};
    answer = streamer_.request(part.key, priority, [&] { return std::make_unique<ColourJob>(tiles, tiling_, index); });
  }
  if (answer.state == TileAnswer::State::Ready) {
    held_.push_back(*answer.data);
    part.tile = colourHeights ? nullptr : &static_cast<const ColourTile&>(*held_.back());
    part.relief = colourHeights ? &static_cast<const ReliefTile&>(*held_.back()) : nullptr;
  }
  return answer.state != TileAnswer::State::Pending;
}

void CompositeStore::keep(const TileIndex& index, int colourLevel) {
  for (const CompositeKind kind : allCompositeKinds) {
    if (inUse(kind)) {
      slots_.use(shownKey(kind, index, colourLevel), frame_);
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
    const bool isNext = &generationOf(request.key) == &of(request.key.kind).next;
    if (composed == Composed::NoSlot) {
      of(request.key.kind).crowded = of(request.key.kind).crowded || isNext;
      unplaced_ += isNext ? 0 : 1;
      continue;  // those after it may have a slot already
    }
    missing_ -= isNext ? 0 : 1;
    spent += composer_->estimatedMilliseconds({parts_.data() + request.firstPart, request.partCount});
  }
  for (const CompositeKind kind : allCompositeKinds) {
    KindState& state = of(kind);
    if (state.hasNext && (state.crowded || nextCovers(kind))) {
      exchange(state);
    }
    state.wasDrawn = !state.drawn.empty();
    state.drawn.clear();
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
  slotStamps_[*slot] = generationOf(request.key).stamp;
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
  while (true) {
    if (at.level <= ownerLevel) {
      // What this frame draws must still be there when the next composes, or chunks without a composite would flicker.
      const CompositeKey key{kind, at, state.shown.side};
      const std::optional<std::uint32_t> slot = slots_.peek(key);
      if (slot && slotStamps_[*slot] >= state.shown.since) {
        slots_.use(key, frame_ + 1);
        return Placement{*slot, textureTransform(transform)};
      }
    }
    const std::optional<TileIndex> parent = tiling_->parent(at);
    if (!parent) {
      return std::nullopt;
    }
    transform = transform.then(tiling_->inParent(at));
    at = *parent;
  }
}

std::string CompositeStore::waitingFor() const {
  for (const CompositeKind kind : allCompositeKinds) {
    const std::vector<Layer*>& enabled = layers_.group(layerGroup(kind)).enabledLayers();
    const KindState& state = of(kind);
    for (std::size_t i = 0; i < enabled.size(); ++i) {
      if (enabled[i]->awaitsData()) {
        return fmt::format("{} is being opened", enabled[i]->uri());
      }
      if (state.wasDrawn && i < state.shown.steps.size() && enabled[i]->step() != state.shown.steps[i]) {
        return fmt::format("{} shows another time", enabled[i]->uri());
      }
    }
    if (inUse(kind) && !composer_->ownProgramReady(kind) && !composer_->ownProgramFailed(kind)) {
      return "a composition program is being built";
    }
  }
  const std::size_t waiting = missing_ - unplaced_;
  return waiting > 0 ? fmt::format("{} composites are waiting", waiting) : std::string();
}

}  // namespace meridian::globebrowsing
