#pragma once

#include <span>
#include <string>

#include "globebrowsing/source/capabilities.h"
#include "host/api/error.h"
#include "host/api/value.h"

namespace meridian::globebrowsing {

/// A layer of a service as assets have it.
struct LayerAsset {
  Value
      table{};  ///< for openspace.globebrowsing.addLayer: Identifier, Name, Description, Attribution, FilePath, Enabled
  std::string text{};  ///< the asset file: adds the layer on initialisation, deletes it again
};

/// Where the asset puts it.
struct AssetPlace {
  std::string globe;                  ///< identifier of the globe's node
  std::string group = "ColorLayers";  ///< of its layers
};

/// A layer's table and the group that it goes into.
struct PlacedLayer {
  Value table{};
  std::string group{};
};
/// An asset file that adds these layers to a globe on initialisation, in that order, and deletes them again.
[[nodiscard]] std::string layersAsset(const std::string& globe, std::span<const PlacedLayer> layers);

/// What to write of a layer of these capabilities. FilePath is what OpenSpace opens as well: for maps a `<GDAL_WMS>`
/// document of the service WMS; for regular pyramids with plain numbers (most of WMTS, TMS and ArcGIS) one of the
/// service TMS; for other WMTS a string "WMTS:URL,layer=...". A WMS or WMTS layer with times, none of them chosen, is
/// named by its capabilities (the string, or the document's GetCapabilitiesUrl), so that here it follows time;
/// OpenSpace shows the service's default of it. Errors: those of serviceOf; tiles that none of these can describe.
[[nodiscard]] Result<LayerAsset> assetOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                         const LayerChoices& choices, const AssetPlace& place);

/// A `<GDAL_WMS>` document of the service's tiles. Errors: levels that do not halve, addresses by other than numbers.
[[nodiscard]] Result<std::string> gdalWmsOf(const TileService& service);

}  // namespace meridian::globebrowsing
