#pragma once

#include <vector>

#include "globebrowsing/map_servers.h"
#include "host/api/module.h"
#include "host/api/script_library.h"

namespace meridian::globebrowsing {

/// loadWMSCapabilities(name, globe, url), removeWMSServer(name), capabilitiesWMS(name) -> list of { Name, URL }, which
/// is empty with a message in the log while there are none, urlInfo(globe) -> list of { name, url },
/// loadWMSServersFromFile(file): a Lua file that returns lists of { Name, URL } by globe.
[[nodiscard]] std::vector<ScriptFunction> mapServerFunctions(Host& host, MapServers& servers);

}  // namespace meridian::globebrowsing
