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
  /// Reads the image onto one tile's samples in each layout, once.
  [[nodiscard]] Result<void> openData() override;
  [[nodiscard]] Result<ColourPixels> makeColours(const Tiling& tiling, const TileIndex& index,
                                                 std::stop_token stop) const override;
  [[nodiscard]] Result<HeightPixels> makeHeights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                                 std::stop_token stop) const override;
  [[nodiscard]] bool dataOverlap(const Tiling& tiling, const TileIndex& index) const override;
  [[nodiscard]] bool dataFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const override;

  DataPath path_;
  std::string where_;
  ColourPixels colours_;
  HeightPixels heights_;  ///< in heightLayout
  HeightPixels relief_;   ///< in reliefLayout
};

}  // namespace meridian::globebrowsing
