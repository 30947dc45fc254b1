#pragma once

#include "globebrowsing/providers/tile_provider.h"

namespace meridian::globebrowsing {

/// A provider whose colours a shader makes by itself. It cannot be part of others.
class TilelessProvider : public TileProvider {
 public:
  [[nodiscard]] bool hasTiles() const final { return false; }

 private:
  [[nodiscard]] Result<void> openData() override { return {}; }
  [[nodiscard]] Result<ColourPixels> makeColours(const Tiling&, const TileIndex&, std::stop_token) const final {
    return failure("a layer of this type has no tiles");
  }
  [[nodiscard]] Result<HeightPixels> makeHeights(const Tiling&, const TileIndex&, const TileLayout&,
                                                 std::stop_token) const final {
    return failure("a layer of this type has no heights", {}, "use it in a group of colours");
  }
  [[nodiscard]] bool dataOverlap(const Tiling&, const TileIndex&) const final { return false; }
  [[nodiscard]] bool dataFiner(const Tiling&, const TileIndex&, const TileLayout&) const final { return false; }
};

}  // namespace meridian::globebrowsing
