#include "globebrowsing/gpu/height_composition.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "globebrowsing/layers/compose_heights.h"
#include "globebrowsing/providers/raw_tile_job.h"

namespace meridian::globebrowsing {

namespace {

/// What is known of tiles long gone is dropped when it is of that many.
constexpr std::size_t mostFiner = 1 << 15;
constexpr std::size_t mostLacks = 1 << 12;

/// Raw heights of all layers -> one tile.
class HeightCompositionJob final : public TileJob {
 public:
  struct Part {
    TileDataPointer tile;
    LayerSettings settings;
    double opacity = 1.0;
    UnitSquareTransform within;
  };
  struct Target {
    std::shared_ptr<const Tiling> tiling;
    TileIndex index;
    TileLayout layout;
    HeightComposition::Make make = nullptr;
  };

  HeightCompositionJob(Target target, std::vector<Part> parts) : target_(std::move(target)), parts_(std::move(parts)) {}

  Result<TileDataPointer> run(const std::stop_token& /*stop*/) override {
    std::vector<HeightPart> heights;
    heights.reserve(parts_.size());
    for (const Part& part : parts_) {
      heights.push_back(
          {&static_cast<const HeightTile&>(*part.tile).pixels(), part.settings, part.opacity, part.within});
    }
    const HeightLimits limits = target_.tiling->ellipsoid().heightLimits();
    return target_.make(*target_.tiling, target_.index, composeHeights(heights, target_.layout, limits).metres);
  }

 private:
  Target target_;
  std::vector<Part> parts_;
};

}  // namespace

HeightComposition::HeightComposition(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
                                     const TileLayout& layout, Make make)
    : tiling_(std::move(tiling)), layers_(layers), streamer_(streamer), layout_(layout), make_(make) {
  finer_.reserve(mostFiner);
}

HeightComposition::~HeightComposition() {
  streamer_.forget(stream_);
}

void HeightComposition::beginFrame() {
  const LayerGroup& heights = layers_.group(LayerGroupId::HeightLayers);
  if (stream_ == 0 || heights.settingsVersion() != version_) {
    version_ = heights.settingsVersion();
    streamer_.forget(stream_);
    stream_ = streamer_.newStream();
    takeLayers();
    finer_.clear();
    lacks_.clear();
  }
  if (finer_.size() > mostFiner) {
    finer_.clear();
  }
  if (lacks_.size() > mostLacks) {
    // Which tiles are to be made anew is forgotten with it: so all are others.
    lacks_.clear();
    streamer_.forget(stream_);
    stream_ = streamer_.newStream();
  }
  opening_.update(enabled());
  for (std::size_t i = 0; i < enabled().size(); ++i) {
    const Layer& layer = *enabled()[i];
    if (layer.isReady()) {
      const std::uint32_t stream = streamOf(*layer.step());
      keepRoots(streamer_, *tiling_, stream);
      if (shown_[i].step == layer.step() && streamer_.pending(stream) == 0) {
        shown_[i].former.reset();
      }
    }
    if (const LayerStep* former = formerOf(i)) {
      keepRoots(streamer_, *tiling_, streamOf(*former));
    }
  }
}

void HeightComposition::takeLayers() {
  std::vector<Shown> shown;
  for (const Layer* layer : enabled()) {
    const auto known =
        std::find_if(shown_.begin(), shown_.end(), [&](const Shown& each) { return each.uri == layer->uri(); });
    shown.push_back(known == shown_.end() ? Shown{layer->uri(), nullptr, nullptr} : std::move(*known));
  }
  shown_ = std::move(shown);
  gathered_.resize(enabled().size());
}

std::uint32_t HeightComposition::streamOf(const LayerStep& step) const {
  return layout_ == reliefLayout ? step.reliefStream() : step.stream();
}

const LayerStep* HeightComposition::formerOf(std::size_t layer) const {
  const Shown& shown = shown_[layer];
  return shown.step != enabled()[layer]->step() ? shown.step.get() : shown.former.get();
}

const LayerStep* HeightComposition::sourceOf(std::size_t layer) const {
  const Layer& asked = *enabled()[layer];
  return asked.isReady() ? asked.step().get() : asked.isOpening() ? formerOf(layer) : nullptr;
}

Lack HeightComposition::gather(const TileIndex& index, double priority, bool showsEarlier) {
  Lack lack;
  for (std::size_t i = 0; i < enabled().size(); ++i) {
    gathered_[i] = {};
    const LayerStep* source = sourceOf(i);
    if (source == nullptr || !source->tiles()->overlaps(*tiling_, index)) {
      continue;
    }
    if (enabled()[i]->isReady()) {
      lack += gatherLayer(i, index, priority, showsEarlier);
    } else {  // all tiles are others once it is open
      const StandIn standIn = findStandIn(streamer_, *tiling_, {streamOf(*source), index});
      gathered_[i] = {standIn.tile, standIn.within};
    }
  }
  return lack;
}

Lack HeightComposition::gatherLayer(std::size_t layer, const TileIndex& index, double priority, bool showsEarlier) {
  const Layer& asked = *enabled()[layer];
  const LayerStep& step = *asked.step();
  const TileKey key{streamOf(step), index};
  const TileAnswer own = streamer_.request(
      key, priority, [&] { return std::make_unique<HeightJob>(step.tiles(), tiling_, index, layout_); });
  if (own.state != TileAnswer::State::Pending) {
    gathered_[layer].tile = own.data;
    if (Shown& shown = shown_[layer]; own.data != nullptr && shown.step != asked.step()) {
      shown.former = std::exchange(shown.step, asked.step());
    }
    return {};
  }
  if (!own.isLate || (showsEarlier && asked.provider()->steps() != nullptr)) {
    return {Lack::everything, true};
  }
  StandIn standIn = findStandIn(streamer_, *tiling_, key);
  if (const LayerStep* former = formerOf(layer)) {
    const StandIn earlier = findStandIn(streamer_, *tiling_, {streamOf(*former), index});
    standIn = earlier.coarser < standIn.coarser ? earlier : standIn;
  }
  gathered_[layer] = {standIn.tile, standIn.within};
  return {std::max(standIn.coarser, 1U)};
}

unsigned HeightComposition::lack(const TileIndex& index) const {
  const auto found = lacks_.find(index);
  return found == lacks_.end() ? 0 : found->second;
}

TileAnswer HeightComposition::request(const TileIndex& index, double priority, bool showsEarlier) {
  if (opening_.waits()) {
    return {TileAnswer::State::Pending};
  }
  const TileKey key{stream_, index};
  const bool isMade = streamer_.peek(key).state != TileAnswer::State::Absent;
  const unsigned lackOfMade = isMade ? lack(index) : std::numeric_limits<unsigned>::max();
  if (lackOfMade > 0) {
    const Lack now = gather(index, priority, showsEarlier);
    if (!isMade && now.comesSoon) {
      return {TileAnswer::State::Pending};
    }
    if (now.coarser < lackOfMade && !now.comesSoon) {
      streamer_.drop(key);
      lacks_.erase(index);
      if (now.coarser > 0) {
        lacks_.emplace(index, now.coarser);
      }
    }
  }
  return streamer_.request(key, priority, [&] {
    std::vector<HeightCompositionJob::Part> parts;
    for (std::size_t i = 0; i < enabled().size(); ++i) {
      if (gathered_[i].tile != nullptr) {
        parts.push_back(
            {*gathered_[i].tile, enabled()[i]->settings(), enabled()[i]->effectiveOpacity(), gathered_[i].within});
      }
    }
    return std::make_unique<HeightCompositionJob>(HeightCompositionJob::Target{tiling_, index, layout_, make_},
                                                  std::move(parts));
  });
}

bool HeightComposition::hasFiner(const TileIndex& index) const {
  if (const auto found = finer_.find(index); found != finer_.end()) {
    return found->second;
  }
  bool finer = false;
  for (std::size_t i = 0; i < enabled().size() && !finer; ++i) {
    const LayerStep* source = sourceOf(i);
    finer = source != nullptr && source->tiles()->hasFiner(*tiling_, index, layout_);
  }
  return finer_.emplace(index, finer).first->second;
}

}  // namespace meridian::globebrowsing
