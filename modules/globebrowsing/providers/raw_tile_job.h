#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "globebrowsing/providers/raw_tile.h"
#include "globebrowsing/providers/tile_provider.h"
#include "globebrowsing/streaming/tile_job.h"

namespace meridian::globebrowsing {

/// Has a provider make one raw tile: at once, or by and by when its data come from elsewhere.
template <class Tile, class Task>
class RawTileJob final : public TileJob {
 public:
  RawTileJob(std::shared_ptr<TileProvider> provider, std::shared_ptr<const Tiling> tiling, const TileIndex& index,
             const TileLayout& layout = colourLayout)
      : provider_(std::move(provider)), tiling_(std::move(tiling)), index_(index), layout_(layout) {}

  bool prepare(double priority, const std::function<void()>& wake) override {
    if (!hasBegun_) {
      hasBegun_ = true;
      begin(task_);
    }
    return task_ == nullptr || task_->prepare(priority, wake);
  }
  void setPriority(double priority) override {
    if (task_ != nullptr) {
      task_->setPriority(priority);
    }
  }
  Result<TileDataPointer> run(const std::stop_token& stop) override {
    const auto published = [](auto pixels) -> TileDataPointer {
      return std::make_shared<const Tile>(std::move(pixels));
    };
    return task_ != nullptr ? task_->make(stop).map(published) : make(task_, stop).map(published);
  }
  std::optional<Error> flaw() const override { return task_ != nullptr ? task_->flaw() : provider_->flaw(); }

 private:
  void begin(std::unique_ptr<ColourTask>& task) { task = provider_->colourTask(*tiling_, index_); }
  void begin(std::unique_ptr<HeightTask>& task) { task = provider_->heightTask(*tiling_, index_, layout_); }
  Result<ColourPixels> make(const std::unique_ptr<ColourTask>&, const std::stop_token& stop) {
    return provider_->colours(*tiling_, index_, stop);
  }
  Result<HeightPixels> make(const std::unique_ptr<HeightTask>&, const std::stop_token& stop) {
    return provider_->heights(*tiling_, index_, layout_, stop);
  }

  std::shared_ptr<TileProvider> provider_;
  std::shared_ptr<const Tiling> tiling_;
  TileIndex index_;
  TileLayout layout_;  ///< of heights; colours are always in colourLayout
  bool hasBegun_ = false;
  std::unique_ptr<Task> task_;
};

using ColourJob = RawTileJob<ColourTile, ColourTask>;
using HeightJob = RawTileJob<HeightTile, HeightTask>;

}  // namespace meridian::globebrowsing
