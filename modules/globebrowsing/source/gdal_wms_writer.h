#pragma once

#include <string>

#include "globebrowsing/source/capabilities.h"
#include "globebrowsing/source/tile_service.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

// `<GDAL_WMS>` documents of services. Their DataWindow is whole tiles of the coarsest level, so that GDAL counts and
// lays out tiles as the service does; an element Extent, which GDAL ignores and readGdalWms heeds, is the service's
// own. Each is read again before it is handed out, and must give the tiles that the service has, no more and no fewer.

/// Of numbered tiles, as the service TMS. Errors: levels other than 0 to n or that do not halve, addresses by other
/// than numbers, limits that are not those of the extent.
[[nodiscard]] Result<std::string> gdalWmsOf(const TileService& service);

/// Of a layer of maps, as the service WMS: `service` is what serviceOf made of it. One that follows time names its
/// capabilities (GetCapabilitiesUrl), which then count when it is read. Errors: a pyramid that is too large for GDAL,
/// or that a window cannot give.
[[nodiscard]] Result<std::string> gdalWmsOfMaps(const Capabilities& capabilities, const TileService& service,
                                                bool followsTime);

}  // namespace meridian::globebrowsing
