#pragma once

#include <optional>
#include <string>
#include <vector>

#include "globebrowsing/source/capabilities_reference.h"
#include "globebrowsing/source/tile_service.h"
#include "globebrowsing/source/tile_settings.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

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
/// - GDAL's "WMS:http://...?LAYERS=...&SRS=...&BBOX=..." (a GetMap request);
/// - a layer of capabilities (capabilities_reference.h): "WMTS:URL,layer=...", the address of such a document, a
///   GDAL_WMTS document, a GDAL_WMS document that has a GetCapabilitiesUrl or is of a TiledWMS, and a file with
///   capabilities.
/// `filePath` is absolute where it is a file. Reads that file and, of a VRT, its sibling, so call it on a worker; asks
/// no server. `settings` are what the layer says of a URL template's tiles; their encoding is not seen to here.
/// Errors: a description of ours with something wrong in it. What is not ours is no error.
[[nodiscard]] Result<ServiceDescription> describeService(const std::string& filePath, const std::string& where,
                                                         const TileSettings& settings = {});

/// Whether that is a layer of capabilities and no time of it is chosen, as far as the text itself tells: files are not
/// read.
[[nodiscard]] bool mayHaveTimes(const std::string& filePath);

}  // namespace meridian::globebrowsing
