#include "globebrowsing/gpu/composite_store.h"

#include <algorithm>

#include <fmt/format.h>

#include "globebrowsing/providers/raw_tile_job.h"
#include "globebrowsing/source/tile_layout.h"

namespace meridian::globebrowsing {

namespace {

/// Facts of tiles long gone are dropped when there are that many.
constexpr std::size_t mostFacts = 1 << 15;

/// The tile's unit square in the composite's texture, whose interior lies within a border.
glm::vec4 textureTransform(const UnitSquareTransform& transform) {
  const glm::dvec2 offset =
      (double{colourLayout.border} + double{colourLayout.interior} * transform.offset) / double{colourLayout.size()};
  const glm::dvec2 scale = double{colourLayout.interior} * transform.scale / double{colourLayout.size()};
  return glm::vec4(glm::vec2(offset), glm::vec2(scale));
}

bool isTile(const Layer& layer) {
  return layer.sampling() == Sampling::Tile;
}

}  // namespace

CompositeStore::CompositeStore(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
                               std::unique_ptr<Composer> composer, std::uint32_t capacity)
    : tiling_(std::move(tiling)),
      layers_(layers),
      streamer_(streamer),
      composer_(std::move(composer)),
      slots_(capacity),
      slotVersions_(capacity) {
  facts_.reserve(mostFacts);
}

void CompositeStore::beginFrame(std::uint64_t frame) {
  frame_ = frame;
  missing_ = 0;
  requests_.clear();
  parts_.clear();
  held_.clear();
  composer_->beginFrame(frame);
  bool changed = facts_.size() > mostFacts;
  for (const CompositeKind kind : allCompositeKinds) {
    const LayerGroup& group = layers_.group(layerGroup(kind));
    std::uint64_t& version = versions_[static_cast<std::size_t>(kind)];
    changed = changed || version != group.settingsVersion();
    version = group.settingsVersion();
    openings_[static_cast<std::size_t>(kind)].update(group);
    if (inUse(kind)) {
      composer_->setStructure(kind, group.structureKey());
    }
  }
  if (changed) {
    facts_.clear();
  }
}

void CompositeStore::endFrame() {
  composer_->endFrame();
}

bool CompositeStore::inUse(CompositeKind kind) const {
  return kind == CompositeKind::Base || !layers_.group(layerGroup(kind)).enabledLayers().empty();
}

bool CompositeStore::anyFiner(CompositeKind kind, const TileIndex& index) const {
  const std::vector<Layer*>& enabled = layers_.group(layerGroup(kind)).enabledLayers();
  return std::any_of(enabled.begin(), enabled.end(), [&](const Layer* layer) {
    return isTile(*layer) && layer->isReady() && layer->provider()->hasFinerColours(*tiling_, index);
  });
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

bool CompositeStore::hasFiner(const TileIndex& index) const {
  return facts(index).finer;
}

TileIndex CompositeStore::owner(CompositeKind kind, const TileIndex& index, int colourLevel) const {
  const int level = std::min<int>(colourLevel, facts(index).ownerLevel[static_cast<std::size_t>(kind)]);
  TileIndex found = index;
  while (found.level > level) {
    found = *tiling_->parent(found);
  }
  return found;
}

CompositeStore::State CompositeStore::stateOf(const CompositeKey& key) const {
  const std::optional<std::uint32_t> slot = slots_.peek(key);
  return {slot.has_value(), slot && slotVersions_[*slot] == versions_[static_cast<std::size_t>(key.kind)]};
}

CompositeStore::State CompositeStore::state(const TileIndex& index, int colourLevel) const {
  State all;
  for (const CompositeKind kind : allCompositeKinds) {
    if (inUse(kind)) {
      const State one = stateOf({kind, owner(kind, index, colourLevel)});
      all = {all.present && one.present, all.current && one.current};
    }
  }
  return all;
}

CompositeStore::State CompositeStore::want(const TileIndex& index, int colourLevel, double priority) {
  State all;
  for (const CompositeKind kind : allCompositeKinds) {
    if (inUse(kind)) {
      const State one = wantComposite({kind, owner(kind, index, colourLevel)}, priority);
      all = {all.present && one.present, all.current && one.current};
    }
  }
  return all;
}

CompositeStore::State CompositeStore::wantComposite(const CompositeKey& key, double priority) {
  slots_.use(key, frame_);
  const State state = stateOf(key);
  if (state.current) {
    return state;
  }
  // Many chunks may draw the same ancestor's composite.
  if (std::any_of(requests_.begin(), requests_.end(), [&](const Request& r) { return r.key == key; })) {
    return state;
  }
  ++missing_;
  if (composer_->ready(key.kind) && !openings_[static_cast<std::size_t>(key.kind)].waits()) {
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
  for (const Layer* layer : layers_.group(layerGroup(key.kind)).enabledLayers()) {
    CompositionPart part{layer, nullptr, {}, {}};
    TileIndex index = key.index;
    while (isTile(*layer) && index.level > 0 &&
           !layer->provider()->hasFinerColours(*tiling_, *tiling_->parent(index))) {
      part.transform = part.transform.then(tiling_->inParent(index));
      index = *tiling_->parent(index);
    }
    if (isTile(*layer) && layer->isReady() && layer->provider()->overlaps(*tiling_, index)) {
      part.key = {layer->stream(), index};
      const TileAnswer answer = streamer_.request(
          part.key, priority, [&] { return std::make_unique<ColourJob>(layer->provider(), tiling_, index); });
      all = all && answer.state != TileAnswer::State::Pending;
      if (answer.state == TileAnswer::State::Ready) {
        held_.push_back(*answer.data);
        part.tile = &static_cast<const ColourTile&>(*held_.back());
      }
    }
    parts_.push_back(part);
  }
  return all;
}

void CompositeStore::keep(const TileIndex& index, int colourLevel) {
  for (const CompositeKind kind : allCompositeKinds) {
    if (inUse(kind)) {
      slots_.use({kind, owner(kind, index, colourLevel)}, frame_);
    }
  }
}

void CompositeStore::compose(double milliseconds) {
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
      ++unplaced_;  // those after it may have a slot already
      continue;
    }
    --missing_;
    spent += composer_->estimatedMilliseconds(request.partCount);
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
  slotVersions_[*slot] = versions_[static_cast<std::size_t>(request.key.kind)];
  return Composed::Done;
}

std::optional<CompositeStore::Placement> CompositeStore::place(CompositeKind kind, const TileIndex& index,
                                                               int colourLevel) {
  UnitSquareTransform transform;
  TileIndex at = index;
  const int ownerLevel = std::min<int>(colourLevel, facts(index).ownerLevel[static_cast<std::size_t>(kind)]);
  while (true) {
    if (at.level <= ownerLevel) {
      // What this frame draws must still be there when the next composes, or chunks without a composite would flicker.
      if (const std::optional<std::uint32_t> slot = slots_.use({kind, at}, frame_ + 1)) {
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
    for (const Layer* layer : layers_.group(layerGroup(kind)).enabledLayers()) {
      const TileProvider::State state = layer->provider()->state();
      if (isTile(*layer) && (state == TileProvider::State::NotOpened || state == TileProvider::State::Opening)) {
        return fmt::format("{} is being opened", layer->uri());
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
