#include "host/app/locations.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace meridian::app {
namespace {

namespace fs = std::filesystem;

/// Sets an environment variable for as long as it lives.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* old = std::getenv(name)) {
      old_ = old;
    }
    setenv(name, value.c_str(), 1);
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;
  ~Environment() {
    if (old_) {
      setenv(name_, old_->c_str(), 1);
    } else {
      unsetenv(name_);
    }
  }

 private:
  const char* name_;
  std::optional<std::string> old_;
};

TEST(TemporaryFolder, GoesWithWhatIsInIt) {
  fs::path path;
  {
    const auto folder = TemporaryFolder::create();
    ASSERT_TRUE(folder);
    path = folder->path();
    fs::create_directories(path / "a" / "b");
  }
  EXPECT_FALSE(fs::exists(path));
}

TEST(Locations, PreferTheInstallTreeOfTheExecutable) {
  const auto folder = TemporaryFolder::create();
  ASSERT_TRUE(folder);
  fs::create_directories(folder->path() / "share/meridian/data");
  fs::create_directories(folder->path() / "share/meridian/shaders");
  const auto found = findDataFolders(folder->path() / "bin/meridian");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->data, folder->path() / "share/meridian/data");
  EXPECT_EQ(found->shaders, folder->path() / "share/meridian/shaders");
}

TEST(Locations, FallBackToTheSourceTree) {
  const auto found = findDataFolders("/nonexistent/bin/meridian");
  ASSERT_TRUE(found) << found.error().message();
  EXPECT_EQ(found->shaders, fs::path(MERIDIAN_SOURCE_FOLDER) / "shaders");
}

TEST(Locations, CacheIsBelowXdgCacheHome) {
  const auto folder = TemporaryFolder::create();
  ASSERT_TRUE(folder);
  const Environment environment("XDG_CACHE_HOME", (folder->path() / "new").string());
  EXPECT_EQ(findCacheFolder(), folder->path() / "new/meridian");
  EXPECT_TRUE(fs::is_directory(folder->path() / "new/meridian"));
}

TEST(Locations, ARelativeXdgCacheHomeIsIgnored) {
  const auto folder = TemporaryFolder::create();
  ASSERT_TRUE(folder);
  const Environment home("HOME", folder->path().string());
  const Environment environment("XDG_CACHE_HOME", "relative");
  EXPECT_EQ(findCacheFolder(), folder->path() / ".cache/meridian");
}

TEST(Locations, WithoutACacheFolderTheTemporaryOneServes) {
  const auto folder = TemporaryFolder::create();
  ASSERT_TRUE(folder);
  const Environment environment("XDG_CACHE_HOME", "/dev/null");
  EXPECT_EQ(findCacheFolder(), std::nullopt);
  const auto paths = findPaths(folder->path());
  ASSERT_TRUE(paths) << paths.error().message();
  EXPECT_EQ(paths->cache, folder->path() / "cache");
  EXPECT_TRUE(fs::is_directory(paths->sync));
}

TEST(Locations, PreparedDataOfACacheThatCanOnlyBeReadAreSeen) {
  if (geteuid() == 0) {
    GTEST_SKIP() << "root may write everywhere";
  }
  const auto folder = TemporaryFolder::create();
  ASSERT_TRUE(folder);
  const fs::path cache = folder->path() / "meridian";
  fs::create_directories(cache / "data");
  std::ofstream(cache / "data/earth.tif") << "earth";
  fs::permissions(cache, fs::perms::owner_read | fs::perms::owner_exec);
  const Environment environment("XDG_CACHE_HOME", folder->path().string());
  const auto temporary = TemporaryFolder::create();
  ASSERT_TRUE(temporary);
  const auto paths = findPaths(temporary->path());
  fs::permissions(cache, fs::perms::owner_all);
  ASSERT_TRUE(paths) << paths.error().message();
  EXPECT_EQ(paths->cache, temporary->path() / "cache");
  EXPECT_EQ(fs::file_size(paths->cache / "data/earth.tif"), 5U);
}

}  // namespace
}  // namespace meridian::app
