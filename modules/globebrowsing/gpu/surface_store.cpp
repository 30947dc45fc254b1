#include "globebrowsing/gpu/surface_store.h"

#include <algorithm>

#include <fmt/format.h>

namespace meridian::globebrowsing {

namespace {

TileDataPointer makeSurface(const Tiling& tiling, const TileIndex& index, std::vector<float>&& heights) {
  return std::make_shared<const ChunkSurface>(tiling, index, std::move(heights));
}

}  // namespace

SurfaceStore::SurfaceStore(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
                           std::uint32_t capacity)
    : tiling_(tiling),
      layers_(layers),
      heights_(std::move(tiling), layers, streamer, heightLayout, makeSurface),
      pool_(capacity) {
  resident_.reserve(capacity);
  arrivals_.reserve(capacity);
}

void SurfaceStore::beginFrame(std::uint64_t frame) {
  frame_ = frame;
  arrivals_.clear();
  const std::uint32_t before = heights_.stream();
  heights_.beginFrame();
  if (heights_.stream() != before) {
    outdated_ = resident_.size();
  }
  if (heights_.stream() != before || evicted_.size() > mostEvicted) {
    evicted_.clear();
  }
}

bool SurfaceStore::want(const TileIndex& index, double priority) {
  pool_.slots().use(index, frame_);
  const auto resident = resident_.find(index);
  const bool isCurrent = resident != resident_.end() && resident->second.stream == heights_.stream();
  if (isCurrent && resident->second.lack == 0) {
    return true;
  }
  const TileAnswer answer = heights_.request(index, priority, resident != resident_.end() && !isCurrent);
  const unsigned lack = heights_.lack(index);
  if (answer.state == TileAnswer::State::Ready && (!isCurrent || lack < resident->second.lack)) {
    arrivals_.push_back({index, priority, *answer.data, lack});
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
    slot = pool_.slots().take(arrival.index, frame_, [this](const TileIndex& evicted) { evict(evicted); });
  }
  if (!slot) {
    return false;
  }
  auto surface = std::static_pointer_cast<const ChunkSurface>(arrival.data);
  pool_.upload(*slot, *surface);
  lowest_ = std::min(lowest_, surface->heightRange().minimum);
  highest_ = std::max(highest_, surface->heightRange().maximum);
  Resident& resident = resident_[arrival.index];
  outdated_ -= resident.surface != nullptr && isOutdated(resident) ? 1 : 0;
  resident = {std::move(surface), heights_.stream(), ++lastStamp_, arrival.lack};
  outdated_ += isOutdated(resident) ? 1 : 0;
  evicted_.erase(arrival.index);
  deepest_ = std::max(deepest_, int{arrival.index.level});
  return true;
}

void SurfaceStore::evict(const TileIndex& index) {
  const auto gone = resident_.find(index);
  const Resident& resident = gone->second;
  if (isOutdated(resident)) {
    --outdated_;
  } else {
    evicted_[index] = {resident.surface->heightRange(), index.level, resident.stamp};
  }
  resident_.erase(gone);
}

const ChunkSurface* SurfaceStore::find(const TileIndex& index) const {
  const auto found = resident_.find(index);
  return found == resident_.end() ? nullptr : found->second.surface.get();
}

const ChunkSurface* SurfaceStore::findInForce(const TileIndex& index) const {
  const auto found = resident_.find(index);
  if (found == resident_.end() || (isOutdated(found->second) && !pool_.slots().isUsed(index, frame_))) {
    return nullptr;
  }
  return found->second.surface.get();
}

bool SurfaceStore::isOutdated(const TileIndex& index) const {
  if (outdated_ == 0) {
    return false;
  }
  const auto found = resident_.find(index);
  return found != resident_.end() && isOutdated(found->second);
}

SurfaceStore::Nearest SurfaceStore::nearest(const TileIndex& index) const {
  std::optional<TileIndex> at = index;
  while (at) {
    if (const auto found = resident_.find(*at); found != resident_.end()) {
      const Resident& resident = found->second;
      return {resident.surface.get(), at->level, resident.stamp, isOutdated(resident)};
    }
    at = tiling_->parent(*at);
  }
  return {};
}

SurfaceStore::KnownRange SurfaceStore::nearestRange(const TileIndex& index) const {
  std::optional<TileIndex> at = index;
  while (at) {
    if (const auto found = resident_.find(*at); found != resident_.end()) {
      return {found->second.surface->heightRange(), at->level, found->second.stamp};
    }
    if (const auto found = evicted_.find(*at); found != evicted_.end()) {
      return found->second;
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
