#include "globebrowsing/gpu/surface_store.h"

#include <algorithm>

#include <fmt/format.h>

#include "globebrowsing/layers/compose_heights.h"
#include "globebrowsing/providers/raw_tile_job.h"

namespace meridian::globebrowsing {

namespace {

/// What is known of tiles long gone is dropped when it is of that many.
constexpr std::size_t mostFiner = 1 << 15;

/// Raw heights of all layers -> one surface.
class SurfaceJob final : public TileJob {
 public:
  struct Part {
    TileDataPointer tile;
    LayerSettings settings;
    double opacity = 1.0;
  };

  SurfaceJob(std::shared_ptr<const Tiling> tiling, const TileIndex& index, std::vector<Part> parts)
      : tiling_(std::move(tiling)), index_(index), parts_(std::move(parts)) {}

  Result<TileDataPointer> run(const std::stop_token& /*stop*/) override {
    std::vector<HeightPart> heights;
    heights.reserve(parts_.size());
    for (const Part& part : parts_) {
      heights.push_back({&static_cast<const HeightTile&>(*part.tile).pixels(), part.settings, part.opacity});
    }
    return std::make_shared<const ChunkSurface>(*tiling_, index_, composeHeights(heights, heightLayout).metres);
  }

 private:
  std::shared_ptr<const Tiling> tiling_;
  TileIndex index_;
  std::vector<Part> parts_;
};

}  // namespace

SurfaceStore::SurfaceStore(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
                           std::uint32_t capacity)
    : tiling_(std::move(tiling)), layers_(layers), streamer_(streamer), pool_(capacity) {
  resident_.reserve(capacity);
  arrivals_.reserve(capacity);
  finer_.reserve(mostFiner);
}

SurfaceStore::~SurfaceStore() {
  streamer_.forget(stream_);
}

void SurfaceStore::beginFrame(std::uint64_t frame) {
  frame_ = frame;
  arrivals_.clear();
  const LayerGroup& heights = layers_.group(LayerGroupId::HeightLayers);
  if (stream_ == 0 || heights.settingsVersion() != heightsVersion_) {
    heightsVersion_ = heights.settingsVersion();
    streamer_.forget(stream_);
    stream_ = streamer_.newStream();
    gathered_.resize(heights.enabledLayers().size());
    finer_.clear();
  }
  if (finer_.size() > mostFiner) {
    finer_.clear();
  }
  opening_.update(heights.enabledLayers());
}

bool SurfaceStore::gather(const TileIndex& index, double priority) {
  const std::vector<Layer*>& enabled = layers_.group(LayerGroupId::HeightLayers).enabledLayers();
  bool all = true;
  for (std::size_t i = 0; i < enabled.size(); ++i) {
    const Layer& layer = *enabled[i];
    gathered_[i] = {};
    if (layer.isReady() && layer.step()->tiles()->overlaps(*tiling_, index)) {
      gathered_[i] = streamer_.request({layer.stream(), index}, priority, [&] {
        return std::make_unique<HeightJob>(layer.step()->tiles(), tiling_, index);
      });
      all = all && gathered_[i].state != TileAnswer::State::Pending;
    }
  }
  return all;
}

bool SurfaceStore::want(const TileIndex& index, double priority) {
  pool_.slots().use(index, frame_);
  const auto resident = resident_.find(index);
  if (resident != resident_.end() && resident->second.stream == stream_) {
    return true;
  }
  if (opening_.waits()) {
    return false;
  }
  const TileKey key{stream_, index};
  TileAnswer answer = streamer_.peek(key);
  if (answer.state == TileAnswer::State::Absent && !gather(index, priority)) {
    return false;
  }
  answer = streamer_.request(key, priority, [&] {
    const std::vector<Layer*>& enabled = layers_.group(LayerGroupId::HeightLayers).enabledLayers();
    std::vector<SurfaceJob::Part> parts;
    for (std::size_t i = 0; i < enabled.size(); ++i) {
      if (gathered_[i].state == TileAnswer::State::Ready) {
        parts.push_back({*gathered_[i].data, enabled[i]->settings(), enabled[i]->effectiveOpacity()});
      }
    }
    return std::make_unique<SurfaceJob>(tiling_, index, std::move(parts));
  });
  if (answer.state == TileAnswer::State::Ready) {
    arrivals_.push_back({index, priority, *answer.data});
  }
  return false;
}

void SurfaceStore::keep(const TileIndex& index) {
  pool_.slots().use(index, frame_);
}

void SurfaceStore::upload(graphics::UploadBudget& budget) {
  std::sort(arrivals_.begin(), arrivals_.end(),
            [](const Arrival& a, const Arrival& b) { return a.priority > b.priority; });
  const graphics::UploadBudget::Span span(budget);
  full_ = false;
  for (const Arrival& arrival : arrivals_) {
    if (!budget.left()) {
      break;
    }
    full_ = !place(arrival) || full_;
  }
  arrivals_.clear();
}

bool SurfaceStore::place(const Arrival& arrival) {
  std::optional<std::uint32_t> slot = pool_.slots().use(arrival.index, frame_);
  if (!slot) {
    slot = pool_.slots().take(arrival.index, frame_, [this](const TileIndex& evicted) { resident_.erase(evicted); });
  }
  if (!slot) {
    return false;
  }
  auto surface = std::static_pointer_cast<const ChunkSurface>(arrival.data);
  pool_.upload(*slot, *surface);
  lowest_ = std::min(lowest_, surface->heightRange().minimum);
  highest_ = std::max(highest_, surface->heightRange().maximum);
  resident_[arrival.index] = {std::move(surface), stream_, ++lastStamp_};
  deepest_ = std::max(deepest_, int{arrival.index.level});
  return true;
}

const ChunkSurface* SurfaceStore::find(const TileIndex& index) const {
  const auto found = resident_.find(index);
  return found == resident_.end() ? nullptr : found->second.surface.get();
}

bool SurfaceStore::hasFinerHeights(const TileIndex& index) const {
  if (const auto found = finer_.find(index); found != finer_.end()) {
    return found->second;
  }
  const std::vector<Layer*>& enabled = layers_.group(LayerGroupId::HeightLayers).enabledLayers();
  const bool finer = std::any_of(enabled.begin(), enabled.end(), [&](const Layer* layer) {
    return layer->isReady() && layer->step()->tiles()->hasFinerHeights(*tiling_, index);
  });
  return finer_.emplace(index, finer).first->second;
}

SurfaceStore::Nearest SurfaceStore::nearest(const TileIndex& index) const {
  std::optional<TileIndex> at = index;
  while (at) {
    if (const auto found = resident_.find(*at); found != resident_.end()) {
      return {found->second.surface.get(), at->level, found->second.stamp};
    }
    at = tiling_->parent(*at);
  }
  return {};
}

std::string SurfaceStore::waitingFor() const {
  for (const Layer* layer : layers_.group(LayerGroupId::HeightLayers).enabledLayers()) {
    if (layer->awaitsData()) {
      return fmt::format("{} is being opened", layer->uri());
    }
  }
  return {};
}

}  // namespace meridian::globebrowsing
