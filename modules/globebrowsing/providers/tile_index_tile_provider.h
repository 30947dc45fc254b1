#pragma once

#include "globebrowsing/providers/drawn_tile_provider.h"
#include "globebrowsing/providers/provider_registry.h"
#include "globebrowsing/providers/tile_canvas.h"
#include "globebrowsing/providers/tile_steps.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::globebrowsing {

/// In each tile its index, as messages name it: TileIndexTileProvider. With a background of a colour of its own, if
/// that is wanted; else without one.
class TileIndexTileProvider final : public SteppedTileProvider {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);

  explicit TileIndexTileProvider(bool unique);

  [[nodiscard]] PropertyOwner* properties() override { return &owner_; }
  [[nodiscard]] TileStep at(const Time& now) const override;
  [[nodiscard]] Result<std::shared_ptr<TileProvider>> make(const Time& now) const override;

  BoolProperty uniqueBackgroundColour;

 private:
  [[nodiscard]] Result<void> openData() override { return {}; }

  PropertyOwner owner_{"TileProvider", "Tile provider", "How the index is written"};
};

/// The background of a tile: neighbours differ clearly.
[[nodiscard]] Rgba uniqueColour(const TileIndex& index);

}  // namespace meridian::globebrowsing
