#pragma once

#include <optional>
#include <string>
#include <vector>

#include "globebrowsing/source/map_crs.h"
#include "globebrowsing/source/tile_service.h"
#include "globebrowsing/source/tile_settings.h"

namespace meridian::globebrowsing {

/// Tiles by an address with places in braces, as web maps write it (XYZ, "slippy map"; OSM's and Leaflet's, JOSM's and
/// MapLibre's words):
///   {z} {zoom}  {x}  {y}    level, column, row from the north; {-y} {reverseY}: from the south
///   {q} {quadkey}           Bing's key in place of them
///   {s} {switch:a,b} {a-c}  one of several servers
///   {r} {ratio}             nothing (pictures for dense screens)
///   {bbox-epsg-3857} {bbox} {bbox-epsg-4326}   the tile's corners, west first
///   {width} {height}        of a tile, in pixels
/// Level 0 is EPSG:3857's square, or in degrees two squares of 180, or another projection's square; each level halves
/// it again.
struct UrlTemplate {
  std::string address;
  std::string name{};
  std::string where{};                      ///< where it was written, for errors; empty: the address
  std::optional<std::string> projection{};  ///< default: EPSG:4326 where {bbox-epsg-4326} says so, else EPSG:3857
  bool countsFromSouth = false;             ///< {y} is TMS's
  int tileSize = 256;
  int firstLevel = 0;
  int lastLevel = 19;
  std::vector<std::string> servers{"a", "b", "c"};
  std::optional<Extent> extentDegrees{};
  std::string attribution{};
  /// Of level 0, in units of the projection. EPSG:3857 and EPSG:4326 have theirs; default of EPSG:3031 and EPSG:3413:
  /// 4194304 m to all sides of the pole.
  std::optional<Extent> square{};
};

/// The template of an address, as a layer's settings have it. Where they give no size, tiles of an address that ends in
/// "@2x" (before its extension) have 512 pixels.
[[nodiscard]] UrlTemplate templateOf(const std::string& address, const std::string& where,
                                     const TileSettings& settings);

/// Whether the text is an address with the places of a tile.
[[nodiscard]] bool isUrlTemplate(const std::string& text);
/// Errors: no places, or not all; levels or sizes that make no tiles; an extent off the map; a {bbox-epsg-...} of
/// another projection; a projection that PROJ does not know, or whose square nobody gives.
[[nodiscard]] Result<TileService> serviceOf(const UrlTemplate& description);

}  // namespace meridian::globebrowsing
