#pragma once

#include <string>

#include "globebrowsing/providers/default_tile_provider.h"

namespace meridian::globebrowsing {

/// The whole of one image in every tile: SingleImageProvider. For grids and test patterns.
class SingleImageProvider final : public TileProvider {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);

  SingleImageProvider(DataPath path, std::string where) : path_(std::move(path)), where_(std::move(where)) {}

  [[nodiscard]] Result<void> check() const override;

 private:
  /// Reads the colours of the one tile that all are, once; heights, which few want, when they are wanted.
  [[nodiscard]] Result<void> openData() override;
  [[nodiscard]] Result<ColourPixels> makeColours(const Tiling& tiling, const TileIndex& index,
                                                 std::stop_token stop) const override;
  [[nodiscard]] Result<HeightPixels> makeHeights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                                 std::stop_token stop) const override;
  [[nodiscard]] bool dataOverlap(const Tiling& tiling, const TileIndex& index) const override;
  [[nodiscard]] bool dataFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const override;

  DataPath path_;
  std::string where_;
  std::shared_ptr<RasterSource> source_;
  ColourPixels colours_;
};

}  // namespace meridian::globebrowsing
