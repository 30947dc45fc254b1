#pragma once

#include <memory>
#include <utility>

#include "globebrowsing/providers/colormap.h"
#include "globebrowsing/providers/tile_provider.h"

namespace meridian::globebrowsing {

/// Another provider's tiles with the colours that a colormap gives to their first band. Heights are the other's.
class ColormappedTileProvider final : public TileProvider {
 public:
  /// `values` has no steps.
  ColormappedTileProvider(std::shared_ptr<TileProvider> values, std::shared_ptr<const Colormap> colormap)
      : values_(std::move(values)), colormap_(std::move(colormap)) {}

  [[nodiscard]] Result<void> check() const override { return values_->check(); }
  [[nodiscard]] std::optional<Error> lastFailure() const override { return values_->lastFailure(); }
  [[nodiscard]] std::optional<Error> flaw() const override { return values_->flaw(); }

 private:
  class Task;

  [[nodiscard]] bool prepareData(const std::function<void()>& wake) override { return values_->prepare(wake); }
  [[nodiscard]] Result<void> openData() override { return values_->open(); }
  [[nodiscard]] Result<ColourPixels> makeColours(const Tiling& tiling, const TileIndex& index,
                                                 std::stop_token stop) const override;
  [[nodiscard]] Result<HeightPixels> makeHeights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                                 std::stop_token stop) const override {
    return values_->heights(tiling, index, layout, std::move(stop));
  }
  [[nodiscard]] std::unique_ptr<ColourTask> makeColourTask(const Tiling& tiling, const TileIndex& index) const override;
  [[nodiscard]] std::unique_ptr<HeightTask> makeHeightTask(const Tiling& tiling, const TileIndex& index,
                                                           const TileLayout& layout) const override {
    return values_->heightTask(tiling, index, layout);
  }
  [[nodiscard]] bool dataOverlap(const Tiling& tiling, const TileIndex& index) const override {
    return values_->overlaps(tiling, index);
  }
  [[nodiscard]] bool dataFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const override {
    return values_->hasFiner(tiling, index, layout);
  }

  std::shared_ptr<TileProvider> values_;
  std::shared_ptr<const Colormap> colormap_;
};

}  // namespace meridian::globebrowsing
