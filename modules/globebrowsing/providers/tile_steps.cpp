#include "globebrowsing/providers/tile_steps.h"

namespace meridian::globebrowsing {

Result<ColourPixels> SteppedTileProvider::makeColours(const Tiling& /*tiling*/, const TileIndex& /*index*/,
                                                      std::stop_token /*stop*/) const {
  return failure("a layer that changes has tiles only for its steps");
}

Result<HeightPixels> SteppedTileProvider::makeHeights(const Tiling& /*tiling*/, const TileIndex& /*index*/,
                                                      const TileLayout& /*layout*/, std::stop_token /*stop*/) const {
  return failure("a layer that changes has tiles only for its steps");
}

}  // namespace meridian::globebrowsing
