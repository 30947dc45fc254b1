#pragma once

#include "host/api/module.h"
#include "host/api/script_library.h"

namespace meridian::globebrowsing {

/// `openspace.globebrowsing.*`: layers of globes, by the names and meanings that OpenSpace's scripts use. `host`
/// outlives the library.
[[nodiscard]] ScriptLibrary makeScriptLibrary(Host& host);

}  // namespace meridian::globebrowsing
