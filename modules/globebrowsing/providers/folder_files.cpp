#include "globebrowsing/providers/folder_files.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "globebrowsing/providers/path_tokens.h"

namespace meridian::globebrowsing {

namespace {
constexpr std::size_t mostEntries = 1'000'000;
}

std::string folderPath(const std::string& path, const std::string& assetFolder) {
  const std::filesystem::path given(path);
  return (given.is_absolute() ? given : std::filesystem::path(assetFolder) / given).lexically_normal().string();
}

Result<void> checkFolder(const std::string& folder, const std::string& where) {
  std::error_code code;
  const std::filesystem::file_status status = std::filesystem::status(folder, code);
  if (!std::filesystem::exists(status)) {
    return tl::make_unexpected(
        missing("the folder", folder, where, "check the path; a relative one starts at the asset's folder"));
  }
  if (!std::filesystem::is_directory(status)) {
    return failure(folder + " is not a folder", where, "name the folder that holds the files");
  }
  return {};
}

Result<std::vector<std::string>> filesIn(const std::string& folder, const std::string& where) {
  if (Result<void> checked = checkFolder(folder, where); !checked) {
    return tl::make_unexpected(std::move(checked.error()));
  }
  std::error_code code;
  std::filesystem::directory_iterator at(folder, code);
  std::vector<std::string> names;
  std::size_t seen = 0;
  for (; !code && at != std::filesystem::directory_iterator(); at.increment(code)) {
    if (++seen > mostEntries) {
      return failure("the folder " + folder + " has more than a million entries", where, "split it");
    }
    std::error_code ofEntry;  // what cannot be examined is no file of ours
    std::string name = at->path().filename().string();
    if (name.front() != '.' && at->is_regular_file(ofEntry)) {
      names.push_back(std::move(name));
    }
  }
  if (code) {
    return failure("the folder " + folder + " cannot be read: " + code.message(), where, "check its permissions");
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace meridian::globebrowsing
