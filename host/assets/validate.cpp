#include "host/assets/validate.h"

#include <algorithm>

#include "host/assets/asset_graph.h"
#include "host/assets/profile.h"

namespace meridian::assets {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> findAssets(const fs::path& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error)) {
    return std::vector{path};
  }
  if (!fs::is_directory(path, error)) {
    return failure("no such file or folder", path.string(), "check the path");
  }
  std::vector<fs::path> found;
  fs::recursive_directory_iterator entries(path, fs::directory_options::skip_permission_denied, error);
  for (; !error && entries != fs::recursive_directory_iterator(); entries.increment(error)) {
    std::error_code ignored;
    if (isAssetFile(entries->path()) && entries->is_regular_file(ignored)) {
      found.push_back(entries->path());
    }
  }
  if (error) {
    return failure(error.message(), path.string());
  }
  if (found.empty()) {
    return failure("the folder holds no .asset or .jasset file", path.string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

fs::path assetsFolder(const fs::path& path, const fs::path& fallback) {
  std::error_code ignored;
  fs::path whole = fs::absolute(path, ignored).lexically_normal();
  if (fs::is_directory(whole, ignored)) {
    return whole;
  }
  for (fs::path folder = whole.parent_path(); folder != folder.parent_path(); folder = folder.parent_path()) {
    if (folder.filename() == "assets") {
      return folder;
    }
    // Profiles lie in a folder beside that of the assets.
    if (isProfile(whole) && fs::is_directory(folder / "assets", ignored)) {
      return folder / "assets";
    }
  }
  return fallback;
}

std::vector<AssetReport> validate(AssetLoader& loader, const std::vector<fs::path>& files) {
  for (const fs::path& file : files) {
    // Its error stands in the report.
    (void)loader.add(file.string());
  }
  return loader.reports();
}

}  // namespace meridian::assets
