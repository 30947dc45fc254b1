#include "host/app/locations.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "host/api/log.h"

namespace meridian::app {
namespace {

namespace fs = std::filesystem;

bool isUsable(const DataFolders& folders) {
  std::error_code ignored;
  return fs::is_directory(folders.data, ignored) && fs::is_directory(folders.shaders, ignored);
}

/// The value of an environment variable that holds an absolute path: the XDG specification ignores relative ones.
std::optional<fs::path> absoluteFromEnvironment(const char* name) {
  const char* const value = std::getenv(name);
  if (value == nullptr || value[0] != '/') {
    return std::nullopt;
  }
  return fs::path(value);
}

}  // namespace

Result<TemporaryFolder> TemporaryFolder::create() {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  std::string path = ((error ? fs::path("/tmp") : parent) / "meridian-XXXXXX").string();
  if (mkdtemp(path.data()) == nullptr) {
    return failure(fmt::format("no temporary folder can be made: {}", std::strerror(errno)), path,
                   "set TMPDIR to a folder that can be written");
  }
  return TemporaryFolder(path);
}

TemporaryFolder::TemporaryFolder(TemporaryFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}

TemporaryFolder::~TemporaryFolder() {
  if (!path_.empty()) {
    std::error_code error;
    fs::remove_all(path_, error);
    if (error) {
      log::warning("{}: the temporary folder stays: {}", path_.string(), error.message());
    }
  }
}

Result<DataFolders> findDataFolders(const fs::path& executable) {
  const fs::path share = executable.parent_path().parent_path() / "share" / "meridian";
  const DataFolders installed{share / "data", share / "shaders"};
  if (isUsable(installed)) {
    return installed;
  }
  const fs::path source = MERIDIAN_APP_SOURCE_FOLDER;
  const DataFolders built{source / "data", source / "shaders"};
  if (isUsable(built)) {
    return built;
  }
  return failure("neither holds the folders data and shaders",
                 fmt::format("{} and {}", share.string(), source.string()),
                 "install the program with its data, or keep the source tree where it was built");
}

namespace {

std::optional<fs::path> nameOfCacheFolder() {
  auto parent = absoluteFromEnvironment("XDG_CACHE_HOME");
  if (!parent) {
    if (const auto home = absoluteFromEnvironment("HOME")) {
      parent = *home / ".cache";
    }
  }
  return parent ? std::optional(*parent / "meridian") : std::nullopt;
}

/// In place of a cache that cannot be written; what was prepared in that one can still be read.
fs::path makeCacheIn(const fs::path& temporary) {
  fs::path cache = temporary / "cache";
  std::error_code error;
  fs::create_directories(cache, error);
  const auto unwritable = nameOfCacheFolder();
  if (unwritable && access((*unwritable / "data").c_str(), R_OK | X_OK) == 0) {
    fs::create_directory_symlink(*unwritable / "data", cache / "data", error);
  }
  return cache;
}

}  // namespace

std::optional<fs::path> findCacheFolder() {
  auto folder = nameOfCacheFolder();
  if (!folder) {
    return std::nullopt;
  }
  std::error_code error;
  fs::create_directories(*folder, error);
  if (error || access(folder->c_str(), W_OK | X_OK) != 0) {
    return std::nullopt;
  }
  return folder;
}

Result<Paths> findPaths(const fs::path& temporary) {
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  const auto folders = findDataFolders(executable);
  if (!folders) {
    return tl::make_unexpected(folders.error());
  }
  Paths paths;
  paths.data = folders->data;
  paths.shaders = folders->shaders;
  paths.assets = folders->data / "assets";
  paths.temporary = temporary;
  if (const auto cache = findCacheFolder()) {
    paths.cache = *cache;
  } else {
    paths.cache = makeCacheIn(temporary);
    log::warning("no cache folder can be written: what is cached is lost at the end; set XDG_CACHE_HOME to one");
  }
  paths.sync = paths.cache / "sync";
  for (const fs::path& folder : {paths.cache, paths.sync}) {
    fs::create_directories(folder, error);
    if (error) {
      return failure(fmt::format("the folder cannot be made: {}", error.message()), folder.string(),
                     "set XDG_CACHE_HOME to a folder that can be written");
    }
  }
  return paths;
}

}  // namespace meridian::app
