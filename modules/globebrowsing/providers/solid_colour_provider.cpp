#include "globebrowsing/providers/solid_colour_provider.h"

namespace meridian::globebrowsing {

const Schema& SolidColourProvider::schema() {
  static const Schema fields({{"Color", Schema::Type::Vector3, "red, green and blue, each 0 to 1", false, 0.0, 1.0}});
  return fields;
}

Result<std::shared_ptr<TileProvider>> SolidColourProvider::make(const ProviderRequest& /*request*/) {
  return std::make_shared<SolidColourProvider>();
}

}  // namespace meridian::globebrowsing
