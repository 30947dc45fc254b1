#pragma once

#include "globebrowsing/map_servers.h"
#include "host/api/module.h"
#include "host/api/script_library.h"

namespace meridian::globebrowsing {

/// `openspace.globebrowsing.*`: layers of globes, map servers, GIBS, folders of patches, GeoJSON, by the names and
/// meanings that OpenSpace's scripts use. `host` and `servers` outlive the library.
[[nodiscard]] ScriptLibrary makeScriptLibrary(Host& host, MapServers& servers);

}  // namespace meridian::globebrowsing
