#include "host/recording/move_file.h"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace meridian::recording {

namespace {

namespace fs = std::filesystem;

class MoveFile : public testing::Test {
 protected:
  ~MoveFile() override {
    fs::remove_all(folder_);
    fs::remove_all(elsewhere_);
  }

  static std::string read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static void write(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  static dev_t fileSystemOf(const fs::path& path) {
    struct stat status {};
    return stat(path.c_str(), &status) == 0 ? status.st_dev : 0;
  }
  /// Whether there is a folder on another file system.
  bool hasElsewhere() {
    std::error_code error;
    fs::create_directories(folder_);
    fs::create_directories(elsewhere_, error);
    return !error && fileSystemOf(elsewhere_) != fileSystemOf(folder_);
  }

  const std::string name_ = "meridian-move-" + std::to_string(getpid());
  const fs::path folder_ = fs::path(testing::TempDir()) / name_;
  const fs::path elsewhere_ = fs::path("/dev/shm") / name_;
  const std::string recording_ = std::string(100'000, 'r');
};

/// No file that is written gets longer than this, as on a disk that is full.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = std::signal(SIGXFSZ, SIG_IGN);
};

TEST_F(MoveFile, ReplacesAFile) {
  write(folder_ / "from", recording_);
  write(folder_ / "to", "old");
  ASSERT_TRUE(moveFile(folder_ / "from", folder_ / "to"));
  EXPECT_EQ(read(folder_ / "to"), recording_);
  EXPECT_FALSE(fs::exists(folder_ / "from"));
}

TEST_F(MoveFile, KeepsWhatCannotBePutThere) {
  write(folder_ / "from", recording_);
  write(folder_ / "to/inside", "a folder is in the way");
  const Result<void> moved = moveFile(folder_ / "from", folder_ / "to");
  ASSERT_FALSE(moved);
  EXPECT_THAT(moved.error().message(), testing::HasSubstr((folder_ / "from").string()));
  EXPECT_EQ(read(folder_ / "from"), recording_);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 2) << "nothing else is left there";
}

TEST_F(MoveFile, GoesToAnotherFileSystem) {
  if (!hasElsewhere()) {
    GTEST_SKIP() << "NOT CHECKED: there is no other file system";
  }
  write(folder_ / "from", recording_);
  write(elsewhere_ / "to", "old");
  ASSERT_TRUE(moveFile(folder_ / "from", elsewhere_ / "to"));
  EXPECT_EQ(read(elsewhere_ / "to"), recording_);
  EXPECT_FALSE(fs::exists(folder_ / "from"));
  EXPECT_EQ(std::distance(fs::directory_iterator(elsewhere_), {}), 1);
}

TEST_F(MoveFile, AFullFileSystemLosesNeitherTheOneNorTheOther) {
  if (!hasElsewhere()) {
    GTEST_SKIP() << "NOT CHECKED: there is no other file system";
  }
  write(folder_ / "from", recording_);
  write(elsewhere_ / "to", "old");
  const auto moved = [&] {
    const FullDisk full(10'000);
    return moveFile(folder_ / "from", elsewhere_ / "to");
  }();
  EXPECT_FALSE(moved);
  EXPECT_EQ(read(folder_ / "from"), recording_);
  EXPECT_EQ(read(elsewhere_ / "to"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(elsewhere_), {}), 1) << "no part is left";
}

}  // namespace

}  // namespace meridian::recording
