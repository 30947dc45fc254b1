#pragma once

#include <memory>

#include "globebrowsing/source/pixel_source.h"
#include "globebrowsing/source/service_pyramid.h"
#include "globebrowsing/source/source_tile_store.h"

namespace meridian::globebrowsing {

/// The tiles of a map service, brought onto a globe's tiling.
///
/// Where the service has no tile (it says so itself, or answers that there is nothing, or fails for good), the next
/// coarser level stands in for it, and so on: services whose finest levels cover cities only, or oceans coarsely. What
/// no level has is absent. A tile that failed for good leaves the rest of the globe's tile as it is and is told as its
/// flaw; if nothing else is there either, the globe's tile fails.
class TiledServiceSource final : public PixelSource {
 public:
  /// Heights beyond the limits are no data, and a flaw of the tile. Errors: what ServicePyramid::of says, no address.
  [[nodiscard]] static Result<std::shared_ptr<TiledServiceSource>> make(TileService service,
                                                                        std::shared_ptr<SourceTileStore> store,
                                                                        const HeightLimits& limits = {});

  [[nodiscard]] const HeightLimits& heightLimits() const { return limits_; }
  [[nodiscard]] const TileService& service() const { return *service_; }
  [[nodiscard]] const ServicePyramid& pyramid() const { return pyramid_; }
  [[nodiscard]] const std::shared_ptr<const TileService>& sharedService() const { return service_; }
  [[nodiscard]] SourceTileStore& store() const { return *store_; }

  [[nodiscard]] bool overlaps(const Tiling& tiling, const TileIndex& index) const override;
  [[nodiscard]] bool hasDataFiner(const Tiling& tiling, const TileIndex& index,
                                  const TileLayout& layout) const override;
  /// An error: by a task only.
  [[nodiscard]] Result<ColourPixels> colours(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                             std::stop_token stop) const override;
  [[nodiscard]] Result<HeightPixels> heights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                             std::stop_token stop) const override;
  [[nodiscard]] std::optional<Error> lastFailure() const override { return store_->lastFailure(*service_); }
  [[nodiscard]] std::string_view attribution() const override { return service_->attribution; }
  [[nodiscard]] std::unique_ptr<ColourTask> colourTask(const Tiling& tiling, const TileIndex& index,
                                                       const TileLayout& layout) const override;
  [[nodiscard]] std::unique_ptr<HeightTask> heightTask(const Tiling& tiling, const TileIndex& index,
                                                       const TileLayout& layout) const override;

 private:
  TiledServiceSource(TileService service, ServicePyramid pyramid, std::shared_ptr<SourceTileStore> store,
                     const HeightLimits& limits)
      : service_(std::make_shared<const TileService>(std::move(service))),
        pyramid_(std::move(pyramid)),
        store_(std::move(store)),
        limits_(limits) {}

  std::shared_ptr<const TileService> service_;
  ServicePyramid pyramid_;
  std::shared_ptr<SourceTileStore> store_;
  HeightLimits limits_;
};

}  // namespace meridian::globebrowsing
