#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "globebrowsing/source/capabilities.h"
#include "globebrowsing/source/tile_service.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

/// A layer of a service whose capabilities have to be had first.
struct CapabilitiesReference {
  std::string url;      ///< of the document: to be fetched, or a file
  std::string layer{};  ///< empty: the only one that can be shown, or the first
  LayerChoices choices{};
  std::optional<CapabilitiesKind> kind{};  ///< of the document, as far as the text tells
};

/// The reference that a text is, without any file being read; nothing where it is none:
/// - "WMTS:URL", "TMS:URL", "ArcGIS:URL", "WMS:URL" of a URL that asks for GetCapabilities or GetTileService, each
///   followed by what is chosen, in any order and in quotes where it has commas: ",layer=a,style=b,tilematrixset=c,
///   crs=d,format=e,time=f". Without a layer it is the document's only one. "WMS:URL,layer=a" may be of any URL.
/// - The document's address alone: ".../tilemapresource.xml", ".../WMTSCapabilities.xml", one that asks for the
///   GetCapabilities of a WMTS, an ArcGIS service's ".../MapServer", ".../ImageServer".
/// ArcGIS is asked for its JSON, whatever the URL says.
[[nodiscard]] std::optional<CapabilitiesReference> readReference(std::string_view text);

/// The text that names a layer of capabilities with these choices, the address of the document within. Errors: choices
/// that have no place in it (dimensions other than time, further parameters, maps with a background); a name that is
/// also that of another layer, or that quotes cannot hold.
[[nodiscard]] Result<std::string> writeReference(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                                                 const LayerChoices& choices);

/// Takes a choice by its name, as references and GDAL's documents write it, in any case: layer, style, tilematrixset,
/// time, format, crs. Of others nothing.
void choose(CapabilitiesReference& reference, std::string_view name, std::string value);

/// Whether an element of this name is the root of capabilities that parseCapabilities reads.
[[nodiscard]] bool isCapabilitiesRoot(std::string_view name);

/// The layer that a reference means. Errors: there is none.
[[nodiscard]] Result<const CapabilitiesLayer*> layerOf(const CapabilitiesReference& reference,
                                                       const Capabilities& capabilities);
/// The tiles that a reference means, once its document is here. `url` is where it was had.
[[nodiscard]] Result<TileService> serviceOf(const CapabilitiesReference& reference, const Capabilities& capabilities);

}  // namespace meridian::globebrowsing
