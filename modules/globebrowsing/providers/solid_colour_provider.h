#pragma once

#include "globebrowsing/providers/provider_registry.h"

namespace meridian::globebrowsing {

/// One colour everywhere: SolidColor. It has no tiles; the shader takes the layer's property `Color`.
class SolidColourProvider final : public TileProvider {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);

  [[nodiscard]] bool hasTiles() const override { return false; }

 private:
  [[nodiscard]] Result<void> openData() override { return {}; }
  [[nodiscard]] Result<ColourPixels> makeColours(const Tiling& tiling, const TileIndex& index,
                                                 std::stop_token stop) const override;
  [[nodiscard]] Result<HeightPixels> makeHeights(const Tiling& tiling, const TileIndex& index,
                                                 std::stop_token stop) const override;
  [[nodiscard]] bool dataOverlap(const Tiling&, const TileIndex&) const override { return false; }
  [[nodiscard]] bool dataFiner(const Tiling&, const TileIndex&, const TileLayout&) const override { return false; }
};

}  // namespace meridian::globebrowsing
