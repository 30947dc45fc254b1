#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "globebrowsing/renderable_globe.h"
#include "host/api/module.h"
#include "host/api/script_library.h"

namespace meridian::globebrowsing {

/// Layers that users added while it runs, by panel or script; lowest first, group by group.
[[nodiscard]] std::vector<Layer*> usersLayers(RenderableGlobe& globe);

/// Writes an asset file that adds them, as they are now, to the globe of that node; gives its whole path. Errors: no
/// globe; none were added; where scripts may not write; a file that cannot be written.
Result<std::filesystem::path> writeLayersFile(Host& host, const std::string& node, const std::string& path);

/// writeLayers(globe, file) -> path.
[[nodiscard]] std::vector<ScriptFunction> layersFileFunctions(Host& host);

}  // namespace meridian::globebrowsing
