#pragma once

#include <glm/vec3.hpp>

#include "globebrowsing/providers/drawn_tile_provider.h"
#include "globebrowsing/providers/provider_registry.h"

namespace meridian::globebrowsing {

/// Parallels and meridians: GraticuleTileProvider, a type of ours. Lines are as many as the level has room for, at
/// round degrees, minutes and seconds; each as wide on the ground wherever it runs. Towards the poles, where meridians
/// crowd, only every second, third, ... goes on from a parallel.
///
/// Which line is where depends on place and level only, so that tiles fit together, on any tiling.
class GraticuleTileProvider final : public DrawnTileProvider {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);

  struct Style {
    glm::dvec3 colour{1.0};
    double opacity = 1.0;
    double widthPixels = 1.5;  ///< of the tile, of 512
  };
  explicit GraticuleTileProvider(const Style& style) : style_(style) {}

  /// Between two parallels at that level, in arc seconds: a round number that divides 90 degrees.
  [[nodiscard]] static int spacingOf(int level);
  /// Between two meridians, in arc seconds, in the band of parallels that ends at that latitude (radians) on the side
  /// of the pole.
  [[nodiscard]] static int meridianSpacing(int spacing, double latitude);

 private:
  [[nodiscard]] Result<ColourPixels> makeColours(const Tiling& tiling, const TileIndex& index,
                                                 std::stop_token stop) const override;

  Style style_;
};

}  // namespace meridian::globebrowsing
