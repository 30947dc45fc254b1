#pragma once

#include <optional>
#include <string>

#include "globebrowsing/source/gdal_wms.h"

namespace meridian::globebrowsing {

/// A VRT that passes the bands of one map service on as they are and makes what is no data transparent, as all of
/// OpenSpace's do: an alpha band from `ScaleOffset 255, ScaleRatio 0, NODATA 0`, or from the LUT 0:0,1:255,255:255.
struct VrtWrapper {
  std::string source;       ///< the inner description: a file name, or the text of a document
  bool isRelative = false;  ///< to the VRT's folder
  int bands = 0;            ///< without the alpha that the VRT makes
  std::optional<double> noData{};
  bool makesAlpha = false;
  // Where the VRT puts the first pixel of the inner raster, and its pixels' size, in its own units.
  double left = 0.0;
  double top = 0.0;
  double pixelWidth = 0.0;
  double pixelHeight = 0.0;
};

/// Nothing where the VRT does anything else: then it is GDAL's. Errors: no XML.
[[nodiscard]] Result<std::optional<VrtWrapper>> readVrtWrapper(const std::string& text, const std::string& where);

/// The inner service as the VRT shows it. Nothing where the VRT shows it elsewhere than it is. A pixel is transparent
/// where all of its bands are no data (the VRTs look at the first band only, and punch holes where there is no red).
[[nodiscard]] std::optional<TileService> wrapped(const VrtWrapper& wrapper, TileService inner);

}  // namespace meridian::globebrowsing
