#pragma once

#include <functional>
#include <string>

#include "host/api/script_library.h"
#include "host/assets/path_tokens.h"

namespace meridian::assets {

/// `openspace.*`: absPath, setPathToken, fileExists, directoryExists, directoryForPath, walkDirectory,
/// walkDirectoryFiles, walkDirectoryFolders, readFile, writeFile, makeIdentifier, version, layerServer.
///
/// `folder` says what a relative path is relative to: the folder of the asset that runs. A walk ends with an error
/// after 100 000 entries or 32 levels, a file to be read may hold 64 MiB. `tokens` must outlive the library.
[[nodiscard]] ScriptLibrary fileLibrary(PathTokens& tokens, std::function<std::string()> folder);

}  // namespace meridian::assets
