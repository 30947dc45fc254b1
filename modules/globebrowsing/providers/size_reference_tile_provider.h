#pragma once

#include <optional>
#include <string>

#include "globebrowsing/geodesy/ellipsoid.h"
#include "globebrowsing/providers/drawn_tile_provider.h"
#include "globebrowsing/providers/provider_registry.h"

namespace meridian::globebrowsing {

/// In each tile how wide it is: SizeReferenceTileProvider.
class SizeReferenceTileProvider final : public DrawnTileProvider {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);

  /// Without an ellipsoid that of the globe counts.
  explicit SizeReferenceTileProvider(const std::optional<Ellipsoid>& ellipsoid) : ellipsoid_(ellipsoid) {}

  /// Metres along the tile's middle parallel.
  [[nodiscard]] double widthOf(const Tiling& tiling, const TileIndex& index) const;
  /// "313 km", "1.2 km", "850 m", "42 cm".
  [[nodiscard]] static std::string lengthText(double metres);

 private:
  [[nodiscard]] Result<ColourPixels> makeColours(const Tiling& tiling, const TileIndex& index,
                                                 std::stop_token stop) const override;

  std::optional<Ellipsoid> ellipsoid_;
};

}  // namespace meridian::globebrowsing
