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

/// What to write of a layer of these capabilities. Where such a document has all its levels and limits, FilePath is
/// what OpenSpace opens as well: for maps of a WMS a `<GDAL_WMS>` document of the service WMS, for regular pyramids
/// with plain numbers (most of WMTS, TMS and ArcGIS) one of the service TMS. All others are named by their capabilities
/// (capabilities_reference.h); of these OpenSpace opens "WMTS:...". A WMS or WMTS layer with times, none of them
/// chosen, is named by its capabilities, too (of maps the document has their GetCapabilitiesUrl), so that here it
/// follows time; OpenSpace shows the service's default of it. Errors: those of serviceOf; choices that no text can
/// name.
[[nodiscard]] Result<LayerAsset> assetOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                         const LayerChoices& choices, const AssetPlace& place);

}  // namespace meridian::globebrowsing
