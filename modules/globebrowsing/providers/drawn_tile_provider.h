#pragma once

#include "globebrowsing/providers/tile_provider.h"

namespace meridian::globebrowsing {

/// A provider whose tiles are drawn, at every level and everywhere: nothing to open, no heights.
class DrawnTileProvider : public TileProvider {
 private:
  [[nodiscard]] Result<void> openData() final { return {}; }
  [[nodiscard]] Result<HeightPixels> makeHeights(const Tiling&, const TileIndex&, const TileLayout&,
                                                 std::stop_token) const final {
    return failure("a layer of drawn tiles has no heights", {}, "use it in a group of colours");
  }
  [[nodiscard]] bool dataOverlap(const Tiling&, const TileIndex&) const final { return true; }
  [[nodiscard]] bool dataFiner(const Tiling&, const TileIndex& index, const TileLayout&) const final {
    return index.level < maximumLevel;
  }
};

}  // namespace meridian::globebrowsing
