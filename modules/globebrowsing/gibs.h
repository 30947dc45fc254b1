#pragma once

#include <string>
#include <vector>

#include "host/api/error.h"
#include "host/api/module.h"
#include "host/api/script_library.h"

namespace meridian::globebrowsing {

/// A layer of NASA's Global Imagery Browse Services.
struct GibsLayer {
  std::string name;
  std::string date;  ///< "2026-11-25", or "${OpenSpaceTimeId}" for one to be put in by a temporal layer
  std::string
      resolution;      ///< of its tile matrix set: "2km", "1km", "500m", "250m", "125m", "62.5m", "31.25m", "15.625m"
  std::string format;  ///< "jpg" or "png"
};

/// The <GDAL_WMS> document that describes the layer's tiles. Its window is larger than the globe: two tiles of 288
/// degrees. Errors: another resolution or format.
[[nodiscard]] Result<std::string> gibsDocument(const GibsLayer& layer);

/// createGibsGdalXml(layer, date, resolution, format), createTemporalGibsGdalXml(layer, resolution, format) and, as up
/// to version 0.17, (layer, start, end, step, resolution, format, time format?), which gives the older document with
/// times; addGibsLayer(layer, resolution, format, start, end) to the Earth. What is wrong is logged, and gives "".
[[nodiscard]] std::vector<ScriptFunction> gibsFunctions(Host& host);

}  // namespace meridian::globebrowsing
