#pragma once

#include <vector>

#include "host/api/module.h"
#include "host/api/script_library.h"

namespace meridian::globebrowsing {

/// addGeoJson(globe, table), deleteGeoJson(globe, identifier or table), addGeoJsonFromFile(file, name?): which files a
/// globe has is kept, but they are not drawn, as a warning says once.
[[nodiscard]] std::vector<ScriptFunction> geoJsonFunctions(Host& host);

}  // namespace meridian::globebrowsing
