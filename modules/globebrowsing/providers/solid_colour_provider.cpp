#include "globebrowsing/providers/solid_colour_provider.h"

namespace meridian::globebrowsing {

const Schema& SolidColourProvider::schema() {
  static const Schema fields({{"Color", Schema::Type::Vector3, "red, green and blue, each 0 to 1", false, 0.0, 1.0}});
  return fields;
}

Result<std::shared_ptr<TileProvider>> SolidColourProvider::make(const ProviderRequest& /*request*/) {
  return std::make_shared<SolidColourProvider>();
}

Result<ColourPixels> SolidColourProvider::makeColours(const Tiling& /*tiling*/, const TileIndex& /*index*/,
                                                      std::stop_token /*stop*/) const {
  return failure("a layer of type SolidColor has no tiles");
}

Result<HeightPixels> SolidColourProvider::makeHeights(const Tiling& /*tiling*/, const TileIndex& /*index*/,
                                                      std::stop_token /*stop*/) const {
  return failure("a layer of type SolidColor has no heights", {}, "use it in a group of colours");
}

}  // namespace meridian::globebrowsing
