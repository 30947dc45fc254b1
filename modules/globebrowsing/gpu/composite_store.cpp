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
/// Of composites of the next step in time: among the tiles that selection needs (1 to 2), roots before all (3).
constexpr double nextPriority = 1.5;
constexpr double nextRootPriority = 3.0;

/// The tile's unit square in the composite's texture, whose interior lies within a border.
glm::vec4 textureTransform(const UnitSquareTransform& transform) {
  const glm::dvec2 offset =
      (double{colourLayout.border} + double{colourLayout.interior} * transform.offset) / double{colourLayout.size()};
  const glm::dvec2 scale = double{colourLayout.interior} * transform.scale / double{colourLayout.size()};
  return glm::vec4(glm::vec2(offset), glm::vec2(scale));
}

}  // namespace

CompositeStore::CompositeStore(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
                               std::unique_ptr<Composer> composer, std::uint32_t capacity)
    : tiling_(tiling),
      layers_(layers),
      composer_(std::move(composer)),
      gathering_(tiling, layers, streamer),
      owners_(std::move(tiling), generations_, gathering_.relief()),
      slots_(capacity),
      slotContents_(capacity) {}

void CompositeStore::beginFrame(std::uint64_t frame) {
  frame_ = frame;
  lackedSome_ = missing_ > 0;
  missing_ = 0;
  composer_->beginFrame(frame);
  gathering_.beginFrame();
  for (const CompositeKind kind : allCompositeKinds) {
    of(kind).isExchanged = false;
    updateKind(kind);
  }
  updateMixing();
  for (const CompositeKind kind : allCompositeKinds) {
    // Where nothing is drawn the last step is finished first as well, or a surface that is still filled never would be.
    // One that is not shown yet keeps it: whoever waits for it to be filled takes it at any time.
    const bool mayBegin = !of(kind).drawn.empty() || !lackedSome_;
    generations(kind).follow(interpolates_ && fading_ == kind, {mayBegin, mayBegin && isShown_});
  }
}

void CompositeStore::updateKind(CompositeKind kind) {
  CompositeGenerations& generations = this->generations(kind);
  generations.update(kind, layers_, gathering_.relief().stream());
  gathering_.keepStandIns(generations.shown().steps);
  of(kind).opening.update(generations.layers());
  of(kind).fade.update(generations.layers(), frame_);
  if (kind == CompositeKind::Base || !generations.layers().empty()) {
    composer_->programs().setStructure(kind, generations.key());
  }
}

void CompositeStore::endFrame() {
  composer_->endFrame();
}

const CompositeContents* CompositeStore::find(const CompositeKey& key) const {
  const std::optional<std::uint32_t> slot = slots_.peek(key);
  return slot ? &slotContents_[*slot] : nullptr;
}

CompositeStore::State CompositeStore::stateOf(const CompositeKey& key) const {
  const CompositeContents* contents = find(key);
  if (contents == nullptr) {
    return {false, false};
  }
  const CompositeGenerations::Generation& generation = generations(key.kind).of(key.side);
  if (contents->stamp < generation.since || contents->stamp != generation.stamp) {
    return {contents->stamp >= generation.since, false};
  }
  if (contents->lack > 0) {
    return {true, false};
  }
  if (difference(contents->layers, of(key.kind).fade.opacities()).kind == OpacityDifference::Kind::None) {
    return {true, true};
  }
  const std::optional<Mixture> mixed = mixture(key);
  return {true, mixed && mixed->exact};
}

template <class Use>
void CompositeStore::forEachKey(const TileIndex& index, int colourLevel, Use use) const {
  for (const CompositeKind kind : allCompositeKinds) {
    if (inUse(kind)) {
      const TileIndex owner = owners_.owner(kind, false, index, colourLevel).index;
      use(CompositeKey{kind, owner, generations(kind).shown().side});
      if (generations(kind).pair().isMixed) {
        use(CompositeKey{kind, owner, generations(kind).next().side});
      }
    }
  }
}

CompositeStore::State CompositeStore::state(const TileIndex& index, int colourLevel) const {
  State all;
  forEachKey(index, colourLevel, [&](const CompositeKey& key) { all &= stateOf(key); });
  return all;
}

CompositeStore::State CompositeStore::want(const TileIndex& index, int colourLevel, double priority) {
  State all;
  forEachKey(index, colourLevel, [&](const CompositeKey& key) { all &= wantComposite(key, priority); });
  return all;
}

void CompositeStore::keep(const TileIndex& index, int colourLevel) {
  forEachKey(index, colourLevel, [&](const CompositeKey& key) {
    slots_.use(key, frame_);
    if (mixture(key)) {
      useOther(key, frame_);
    }
  });
}

CompositeStore::State CompositeStore::wantComposite(const CompositeKey& key, double priority) {
  slots_.use(key, frame_);
  const State state = stateOf(key);
  const CompositeGenerations& generations = this->generations(key.kind);
  const bool isNext = generations.isNext(key.side);
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
  if (state.current || (isNext && state.present && !generations.pair().isMixed)) {
    return state;
  }
  if (state.present && generations.hasNext() && !generations.pair().isPair) {
    priority -= soonReplaced;
  }
  if (state.present && find(key)->drawn + 1 < frame_) {
    priority -= unseen;
  }
  if (const std::optional<LayerOpacity> other = otherEnd(key)) {
    request({.key = {key.kind, key.index, CompositeKey::fadeSide}, .priority = priority, .other = *other});
  } else {
    request({key, priority});
  }
  return state;
}

void CompositeStore::request(CompositeGathering::Request request) {
  const CompositeKey& key = request.key;
  const CompositeGenerations& generations = this->generations(key.kind);
  // Many chunks may draw the same ancestor's composite.
  if (gathering_.isQueued(key)) {
    return;
  }
  request.isMissing = request.isMissing && (!generations.isNext(key.side) || generations.pair().isMixed);
  missing_ += request.isMissing ? 1 : 0;
  if (!of(key.kind).opening.waits()) {
    request.generations = &generations;
    request.opacities = &of(key.kind).fade.opacities();
    request.there = find(key);
    const CompositeContents* first = find({key.kind, key.index, generations.shown().side});
    if (key.side == CompositeKey::fadeSide && first != nullptr) {
      request.mostLack = first->lack;  // a layer that is late would fade, too
    }
    gathering_.request(request);
  }
}

CompositeKey CompositeStore::nextKey(CompositeKind kind, const TileIndex& index, int colourLevel) const {
  return {kind, owners_.owner(kind, true, index, colourLevel).index, generations(kind).next().side};
}

bool CompositeStore::nextCovers(CompositeKind kind) const {
  const auto isPresent = [&](const CompositeGathering::Drawn& tile) {
    return stateOf(nextKey(kind, tile.index, tile.colourLevel)).present;
  };
  const std::vector<CompositeGathering::Drawn>& drawn = of(kind).drawn;
  if (!isShown_ && !generations(kind).pair().isHeld) {
    return generations(kind).pair().isMixed;  // no other has been wanted as a whole
  }
  for (int root = 0; root < tiling_->rootCount(); ++root) {
    if ((!drawn.empty() || generations(kind).pair().isHeld) &&
        !isPresent({{static_cast<std::uint8_t>(root), 0, 0, 0}})) {
      return false;
    }
  }
  return std::all_of(drawn.begin(), drawn.end(), isPresent);
}

void CompositeStore::wantNext(CompositeKind kind) {
  for (int root = 0; root < tiling_->rootCount(); ++root) {
    wantComposite(nextKey(kind, {static_cast<std::uint8_t>(root), 0, 0, 0}, 0), nextRootPriority);
  }
  for (const CompositeGathering::Drawn& drawn : of(kind).drawn) {
    wantComposite(nextKey(kind, drawn.index, drawn.colourLevel), nextPriority);
  }
}

void CompositeStore::compose(double milliseconds) {
  for (const CompositeKind kind : allCompositeKinds) {
    if (generations(kind).hasNext()) {
      wantNext(kind);
    }
    if (generations(kind).hasSteps()) {
      gathering_.fetchAhead(generations(kind).layers(), of(kind).drawn);
    }
  }
  double spent = 0.0;
  unplaced_ = 0;
  for (const CompositeGathering::Queued& queued : gathering_.sorted()) {
    if (spent >= milliseconds) {
      break;
    }
    if (!composer_->canCompose(queued.key.kind, gathering_.parts(queued))) {
      continue;  // its tiles come meanwhile
    }
    const Composed composed = composeOne(queued);
    if (composed == Composed::NoRawTiles) {
      break;
    }
    if (composed == Composed::NoSlot) {
      noteFull(queued.key);
      continue;  // those after it may have a slot already
    }
    missing_ -= queued.isMissing && queued.lack == 0 ? 1 : 0;
    spent += composer_->estimatedMilliseconds(gathering_.parts(queued));
  }
  for (const CompositeKind kind : allCompositeKinds) {
    CompositeGenerations& generations = this->generations(kind);
    if (generations.hasNext() && (generations.isCrowded() || nextCovers(kind))) {
      const std::uint64_t shown = generations.shown().stamp;
      const bool wasMixed = generations.pair().isMixed;
      generations.endNext(!of(kind).drawn.empty() || missing_ == 0);
      of(kind).isExchanged = generations.shown().stamp != shown || generations.pair().isMixed != wasMixed;
    }
  }
  isDrawnOld_ = true;
}

void CompositeStore::noteFull(const CompositeKey& key) {
  // Second composites only use what room there is.
  if (interpolates_ && generations(*fading_).pair().isPair) {
    generations(*fading_).setCrowded();
  } else if (mixing_ && (key.side == CompositeKey::fadeSide || mixedLast_)) {
    of(*mixing_).noRoomToFade = true;
  } else if (generations(key.kind).isNext(key.side)) {
    generations(key.kind).setCrowded();
  } else {
    ++unplaced_;
  }
}

CompositeStore::Composed CompositeStore::composeOne(const CompositeGathering::Queued& queued) {
  std::optional<std::uint32_t> slot = slots_.use(queued.key, frame_);
  const bool had = slot.has_value();
  if (!had) {
    slot = slots_.take(queued.key, frame_, [](const CompositeKey&) {});
  }
  if (!slot) {
    return Composed::NoSlot;
  }
  const std::span<const CompositionPart> parts = gathering_.parts(queued);
  if (!composer_->compose(*slot, queued.key.kind, parts)) {
    if (!had) {
      slots_.release([&](const CompositeKey& key) { return key == queued.key; });
    }
    return Composed::NoRawTiles;
  }
  ++composedCount_;
  CompositeContents& contents = slotContents_[*slot];
  contents.stamp = generations(queued.key.kind).of(queued.key.side).stamp;
  contents.lack = queued.lack;
  contents.layers.clear();
  for (const CompositionPart& part : parts) {
    contents.layers.push_back({part.layer->version(), part.opacity});
  }
  return Composed::Done;
}

void CompositeStore::beginDrawing() {
  if (isDrawnOld_) {
    isDrawnOld_ = false;
    for (Kind& kind : kinds_) {
      kind.drawn.clear();
    }
  }
}

std::optional<CompositeStore::Placement> CompositeStore::place(CompositeKind kind, const TileIndex& index,
                                                               int colourLevel) {
  const CompositeGenerations& generations = this->generations(kind);
  beginDrawing();
  if (generations.hasSteps()) {
    of(kind).drawn.push_back({index, colourLevel});
  }
  AncestorPlace at = owners_.owner(kind, false, index, colourLevel);
  std::optional<Placement> alone;  // of the nearest tile that has one of two composites to be mixed
  while (true) {
    const std::optional<Placement> own =
        placeAt({kind, at.index, generations.shown().side}, textureTransform(at.transform));
    const std::optional<Placement> placement =
        own && generations.pair().isMixed ? pairedPlacement({kind, at.index, generations.next().side}, *own) : own;
    if (placement) {
      return placement;
    }
    alone = alone ? alone : own;
    const std::optional<TileIndex> parent = tiling_->parent(at.index);
    if (!parent) {
      return alone;
    }
    at = {*parent, at.transform.then(tiling_->inParent(at.index))};
  }
}

std::optional<CompositeStore::Placement> CompositeStore::placeAt(const CompositeKey& key, const glm::vec4& transform) {
  const std::optional<std::uint32_t> slot = slots_.peek(key);
  if (!slot || slotContents_[*slot].stamp < generations(key.kind).of(key.side).since) {
    return std::nullopt;
  }
  // What this frame draws must still be there when the next composes, or chunks without a composite would flicker.
  slots_.use(key, frame_ + 1);
  slotContents_[*slot].drawn = frame_;
  return mixedPlacement(key, {*slot, transform});
}

std::string CompositeStore::waitingFor(bool areTilesStale) const {
  bool isMixed = false;
  for (const CompositeKind kind : allCompositeKinds) {
    const CompositeGenerations& generations = this->generations(kind);
    isMixed = isMixed || generations.pair().isMixed;
    if (generations.isOutdated(kind, layers_)) {
      return "layers have changed";
    }
    if (of(kind).isExchanged) {
      return "layers show another time since this frame";
    }
    for (std::size_t i = 0; i < generations.layers().size(); ++i) {
      const Layer& layer = *generations.layers()[i];
      if (layer.awaitsData()) {
        return fmt::format("{} is being opened", layer.uri());
      }
      if (isShown_ && !generations.pair().isHeld && layer.step() != generations.shown().steps[i]) {
        return fmt::format("{} shows another time", layer.uri());
      }
    }
    if (isShown_ && generations.interpolated() != nullptr && !generations.pair().isMixed &&
        kindBetweenSteps() == kind) {
      return fmt::format("{} shows one of two times", generations.interpolated()->uri());
    }
    if (inUse(kind) && composer_->programs().isOwnPending(kind)) {
      return "a composition program is being built";
    }
  }
  const std::size_t waiting = missing_ - unplaced_;
  // Of a mixed pair the second composites are missing without having been wanted.
  return waiting > 0 && (areTilesStale || isMixed) ? fmt::format("{} composites are waiting", waiting) : std::string();
}

}  // namespace meridian::globebrowsing
