#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <pugixml.hpp>

#include "globebrowsing/source/tile_url.h"
#include "globebrowsing/source/xml_document.h"

namespace meridian::globebrowsing {

/// The element DataWindow and those that belong to it; GDAL's meanings and defaults.
struct GdalWindow {
  double left = -180.0;
  double top = 90.0;
  double right = 180.0;
  double bottom = -90.0;
  std::int64_t width = 0;  ///< pixels of the finest level
  std::int64_t height = 0;
  std::int64_t tileX = 0;  ///< number of the finest level's first tile
  std::int64_t tileY = 0;
  std::optional<int> level{};  ///< of the finest tiles
  int overviews = 0;
  int blockWidth = 1024;
  int blockHeight = 1024;
  bool isTopOrigin = false;  ///< YOrigin is "top"
};

/// What a mini-driver, as GDAL calls them, makes of its element Service.
struct GdalMiniDriver {
  TileUrl url{};
  bool countsRowsFromSouth = false;
  std::string crs{};      ///< its own, where the document has no Projection; empty: degrees
  GdalWindow defaults{};  ///< for what the document leaves out
  int defaultTileCount = 1;
  int defaultOverviews = -1;
  bool needsWindow = true;
  bool asksForWindows = false;  ///< by coordinates rather than by numbers: the matrix may be cut anyhow
};

/// By the service's name. Nothing where GDAL has a mini-driver of that name, or may have one, and we do not.
[[nodiscard]] Result<std::optional<GdalMiniDriver>> readMiniDriver(const XmlDocument& document,
                                                                   const pugi::xml_node& service, bool isTopOrigin);

}  // namespace meridian::globebrowsing
