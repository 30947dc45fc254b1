#pragma once

#include "globebrowsing/providers/provider_registry.h"
#include "globebrowsing/providers/tileless_provider.h"

namespace meridian::globebrowsing {

/// One colour everywhere: SolidColor. The shader takes the layer's property `Color`.
class SolidColourProvider final : public TilelessProvider {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);
};

}  // namespace meridian::globebrowsing
