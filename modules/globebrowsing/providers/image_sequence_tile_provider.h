#pragma once

#include <string>
#include <vector>

#include "globebrowsing/providers/inner_providers.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::globebrowsing {

/// One of a folder's images at a time, in the order of their names: ImageSequenceTileProvider. An image without a
/// georeference covers the whole globe. The property `Index` says which; beyond the last it is the last.
class ImageSequenceTileProvider final : public SteppedTileProvider {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);

  ImageSequenceTileProvider(ProviderRequest request, std::string folder, int index);

  [[nodiscard]] Result<void> check() const override;
  [[nodiscard]] PropertyOwner* properties() override { return &owner_; }
  /// Also brings NumberImages and CurrentImage up to date.
  [[nodiscard]] TileStep at(const Time& now) const override;
  [[nodiscard]] Result<std::shared_ptr<TileProvider>> make(const Time& now) const override;

  IntProperty index;
  mutable IntProperty numberImages{{"NumberImages", "Number of images", "How many the folder has", true}, 0};
  mutable StringProperty currentImage{{"CurrentImage", "Current image", "The file that is shown", true}};

 private:
  [[nodiscard]] Result<void> openData() override;
  [[nodiscard]] std::size_t current() const;

  ProviderRequest request_;
  std::string folder_;
  std::vector<std::string> files_;  ///< of openData
  PropertyOwner owner_{"TileProvider", "Tile provider", "Which image is shown"};
};

}  // namespace meridian::globebrowsing
