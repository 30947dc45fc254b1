#include "globebrowsing/providers/colormapped_tile_provider.h"

namespace meridian::globebrowsing {

namespace {

Result<ColourPixels> coloured(Result<ColourPixels> pixels, const Colormap& colormap) {
  if (pixels) {
    colormap.apply(*pixels);
  }
  return pixels;
}

}  // namespace

class ColormappedTileProvider::Task final : public ColourTask {
 public:
  Task(std::unique_ptr<ColourTask> values, std::shared_ptr<const Colormap> colormap)
      : values_(std::move(values)), colormap_(std::move(colormap)) {}

  bool prepare(double priority, const std::function<void()>& wake) override { return values_->prepare(priority, wake); }
  void setPriority(double priority) override { values_->setPriority(priority); }
  Result<ColourPixels> make(const std::stop_token& stop) override { return coloured(values_->make(stop), *colormap_); }
  std::optional<Error> flaw() const override { return values_->flaw(); }

 private:
  std::unique_ptr<ColourTask> values_;
  std::shared_ptr<const Colormap> colormap_;
};

Result<ColourPixels> ColormappedTileProvider::makeColours(const Tiling& tiling, const TileIndex& index,
                                                          std::stop_token stop) const {
  return coloured(values_->colours(tiling, index, std::move(stop)), *colormap_);
}

std::unique_ptr<ColourTask> ColormappedTileProvider::makeColourTask(const Tiling& tiling,
                                                                    const TileIndex& index) const {
  std::unique_ptr<ColourTask> values = values_->colourTask(tiling, index);
  return values == nullptr ? nullptr : std::make_unique<Task>(std::move(values), colormap_);
}

}  // namespace meridian::globebrowsing
