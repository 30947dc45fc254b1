#pragma once

#include <optional>
#include <string>
#include <vector>

#include "globebrowsing/source/capabilities.h"
#include "globebrowsing/source/tile_service.h"
#include "globebrowsing/source/tile_settings.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

/// A layer of a service whose capabilities have to be had first.
struct CapabilitiesReference {
  std::string url;      ///< of the document: to be fetched, or a file
  std::string layer{};  ///< empty: the only one that can be shown, or the first
  LayerChoices choices{};
};

/// What the FilePath of a layer turned out to be. At most one of `service` and `reference` is there; without either it
/// is for GDAL to open, and `reason` says why.
struct ServiceDescription {
  std::optional<TileService> service{};
  std::optional<CapabilitiesReference> reference{};
  std::string reason{};
  std::vector<std::string> notes{};  ///< what was read and is not done, for the log
};

/// Understands what may stand in FilePath:
/// - the text of a GDAL_WMS document, or of a VRT that wraps one (gdal_wms.h, vrt_wrapper.h), and files of either;
/// - an address with places for a tile: "https://.../{z}/{x}/{y}.png" (url_template.h);
/// - GDAL's "WMS:http://...?LAYERS=...&SRS=...&BBOX=..." (a GetMap request), "WMTS:URL,layer=...,style=...,
///   tilematrixset=...", and GDAL_WMTS documents of the same contents;
/// - the same for a WMS: "WMS:URL,layer=...,style=...,crs=...", and a GDAL_WMS document that has a GetCapabilitiesUrl;
/// - the address of an ArcGIS service: ".../MapServer?f=json", ".../ImageServer?f=json".
/// `filePath` is absolute where it is a file. Reads that file and, of a VRT, its sibling, so call it on a worker; asks
/// no server. `settings` are what the layer says of a URL template's tiles; their encoding is not seen to here.
/// Errors: a description of ours with something wrong in it. What is not ours is no error.
[[nodiscard]] Result<ServiceDescription> describeService(const std::string& filePath, const std::string& where,
                                                         const TileSettings& settings = {});

/// Whether that is a layer of capabilities and no time of it is chosen, as far as the text itself tells: files are not
/// read.
[[nodiscard]] bool mayHaveTimes(const std::string& filePath);

/// The layer that a reference means. Errors: there is none.
[[nodiscard]] Result<const CapabilitiesLayer*> layerOf(const CapabilitiesReference& reference,
                                                       const Capabilities& capabilities);
/// The tiles that a reference means, once its document is here. `url` is where it was had.
[[nodiscard]] Result<TileService> serviceOf(const CapabilitiesReference& reference, const Capabilities& capabilities);

}  // namespace meridian::globebrowsing
