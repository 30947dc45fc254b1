#pragma once

#include <string>
#include <vector>

#include "host/api/error.h"

namespace meridian::globebrowsing {

/// An asset's path of a folder: relative ones start at the asset's.
[[nodiscard]] std::string folderPath(const std::string& path, const std::string& assetFolder);
/// That it is there and a folder, without reading it. `where` is its place in the asset.
[[nodiscard]] Result<void> checkFolder(const std::string& folder, const std::string& where);

/// The names of the regular files in a folder (not below it) that do not begin with a dot, sorted. Errors: what cannot
/// be read; more than a million entries.
[[nodiscard]] Result<std::vector<std::string>> filesIn(const std::string& folder, const std::string& where);

}  // namespace meridian::globebrowsing
