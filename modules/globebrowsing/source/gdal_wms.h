#pragma once

#include <optional>
#include <string>
#include <vector>

#include "globebrowsing/source/tile_service.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

/// What a GDAL_WMS or VRT document says, for us.
struct GdalDescription {
  /// The service; nothing where the document is GDAL's business, and then `reason` says why.
  std::optional<TileService> service{};
  std::string reason{};
  std::vector<std::string> notes{};  ///< what was read and is not done, for the log: sentences without a full stop
};

/// Reads a `<GDAL_WMS>` document (GDAL's driver page "WMS - Web Map Services") for us to ask ourselves: the services
/// WMS, TMS, WorldWind, TileService, VirtualEarth and AGS. (A TiledWMS has no levels of its own: describeService.)
///
/// Levels, tile numbers and places are GDAL's, with these differences, all for the better of a globe:
/// - a window that is plainly in degrees is in degrees, whatever `Projection` says (53 of OpenSpace's own descriptions
///   declare metres and mean degrees);
/// - tiles beyond one turn of longitude or a pole are not asked for, though the window reaches there (GIBS);
/// - WMS 1.3.0 without `BBoxOrder` goes by the CRS's own axis order;
/// - tiles that reach over the window's edge are asked for whole, not clamped;
/// - TLS is verified, `UnsafeSSL` or not; `Cache`, `MaxConnections`, `Timeout`, `OfflineMode` are not ours.
///
/// An element Extent of our own, which GDAL ignores, says what of the DataWindow holds data: UpperLeftX, UpperLeftY,
/// LowerRightX and LowerRightY in the window's units, each the window's own where it is missing. Nothing beyond is
/// asked for.
///
/// `where` names the document in errors. Errors: no XML, or elements missing or wrong that GDAL needs as well; an
/// Extent with numbers that are none, or with nothing of the window.
[[nodiscard]] Result<GdalDescription> readGdalWms(const std::string& text, const std::string& where);

}  // namespace meridian::globebrowsing
