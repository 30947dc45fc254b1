#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "host/api/script_library.h"
#include "host/assets/path_tokens.h"

namespace meridian::assets {

/// `openspace.*`: absPath, setPathToken, fileExists, directoryExists, directoryForPath, walkDirectory,
/// walkDirectoryFiles, walkDirectoryFolders, readFile, readFileLines, readCSVFile, writeFile, createDirectory,
/// createSingleColorImage, unzipFile, makeIdentifier, version, layerServer, dpiScaling.
///
/// `folder` says what a relative path is relative to: the folder of the asset that runs. A walk ends with an error
/// after 100 000 entries or 32 levels, a file to be read may hold 64 MiB. What lies below ${SYNC} and is not there was
/// not synchronised: `onMissing` hears of it, and the script gets an empty file or folder. `tokens` must outlive the
/// library.
[[nodiscard]] ScriptLibrary fileLibrary(PathTokens& tokens, std::function<std::string()> folder,
                                        std::function<void(const std::filesystem::path&)> onMissing = {});

/// `openspace.space.*`: readKeplerFile, csvToSpiceTranslation, which give empty lists; what they should read is
/// checked.
[[nodiscard]] ScriptLibrary orbitLibrary(PathTokens& tokens, std::function<std::string()> folder,
                                         std::function<void(const std::filesystem::path&)> onMissing = {});

}  // namespace meridian::assets
