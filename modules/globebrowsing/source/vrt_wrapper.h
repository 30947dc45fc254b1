#pragma once

#include <optional>
#include <string>

#include "globebrowsing/source/gdal_wms.h"

namespace meridian::globebrowsing {

/// A VRT that passes the bands of one map service on as they are and makes what is no data transparent, as all of
/// OpenSpace's do: an alpha band from `ScaleOffset 255, ScaleRatio 0, NODATA 0`, or from the LUT 0:0,1:255,255:255. Or
/// one that says of the bands what their values mean, as gdal_translate and gdalbuildvrt write it.
struct VrtWrapper {
  std::string source;       ///< the inner description: a file name, or the text of a document
  bool isRelative = false;  ///< to the VRT's folder
  int bands = 0;            ///< without the alpha that the VRT makes
  std::optional<double> noData{};
  bool makesAlpha = false;
  std::optional<double> scale{};  ///< of band 1, whose values are heights
  std::optional<double> offset{};
  // Where the VRT puts the first pixel of the inner raster, and its pixels' size, in its own units.
  double left = 0.0;
  double top = 0.0;
  double pixelWidth = 0.0;
  double pixelHeight = 0.0;
  // Where what it shows of the inner raster ends.
  double right = 0.0;
  double bottom = 0.0;
  bool isPart = false;  ///< by the VRT's own account of the inner raster's size
};

/// What a VRT turned out to be. Without `wrapper` it is GDAL's, and `reason` says why.
struct VrtDescription {
  std::optional<VrtWrapper> wrapper{};
  std::string reason{};
};

/// OverviewList is not looked at: a service has levels of its own. Errors: no XML.
[[nodiscard]] Result<VrtDescription> readVrtWrapper(const std::string& text, const std::string& where);

/// The inner service as the VRT shows it, of which that may be the northwestern part only. Nothing where the VRT shows
/// it elsewhere than it is, or so little of it that a level would have nothing. A pixel is transparent
/// where all of its bands are no data (the VRTs look at the first band only, and punch holes where there is no red).
/// Scale and offset are the VRT's alone, as GDAL has it: what the inner one says of its values counts only where the
/// tools have copied it.
[[nodiscard]] std::optional<TileService> wrapped(const VrtWrapper& wrapper, TileService inner);

}  // namespace meridian::globebrowsing
