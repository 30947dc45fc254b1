#pragma once

#include <filesystem>
#include <vector>

#include "host/api/error.h"
#include "host/assets/asset_loader.h"

namespace meridian::assets {

/// The `.asset` and `.jasset` files below a folder (or the one file), sorted. Errors: no such file or folder; nothing
/// in it.
[[nodiscard]] Result<std::vector<std::filesystem::path>> findAssets(const std::filesystem::path& path);

/// What ${ASSETS} is for these assets: `path` itself if it is a folder, else the nearest folder named "assets" above
/// it (above or beside it, for a profile), else `fallback`.
[[nodiscard]] std::filesystem::path assetsFolder(const std::filesystem::path& path,
                                                 const std::filesystem::path& fallback);

/// Loads and initialises every one of them in the loader's one Lua state; one report per asset that was reached.
[[nodiscard]] std::vector<AssetReport> validate(AssetLoader& loader, const std::vector<std::filesystem::path>& files);

}  // namespace meridian::assets
