#include "host/api/regular_file.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

namespace meridian {
namespace {

using testing::HasSubstr;

class RegularFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) / "meridian-regular-file";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void expectRefused(const std::filesystem::path& file, const std::string& why) const {
    for (const Error& error : {readRegularFile(file, 8, "the script", "name a Lua file").error(),
                               requireRegularFile(file, "the script", "name a Lua file").error()}) {
      EXPECT_EQ(error.what, "the script cannot be read: " + why);
      EXPECT_EQ(error.where, file.string());
      EXPECT_EQ(error.remedy, "name a Lua file");
    }
  }

  std::filesystem::path folder_;
};

TEST_F(RegularFileTest, IsReadWhole) {
  std::ofstream(folder_ / "some", std::ios::binary) << std::string("a\0b\n", 4);
  std::ofstream(folder_ / "empty");
  EXPECT_EQ(readRegularFile(folder_ / "some", 4, "it", ""), std::string("a\0b\n", 4));
  EXPECT_EQ(readRegularFile(folder_ / "empty", 4, "it", ""), "");
}

TEST_F(RegularFileTest, OneThatIsTooLargeIsNotRead) {
  std::ofstream(folder_ / "large") << std::string(9, 'x');
  const auto read = readRegularFile(folder_ / "large", 8, "it", "");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().what, HasSubstr("larger than"));
}

/// None of these may be opened: the test would never end.
TEST_F(RegularFileTest, WhatIsNoneIsRefused) {
  expectRefused(folder_ / "none", "there is no such file");
  expectRefused(folder_, "it is a folder");
  expectRefused("/dev/zero", "it is not a regular file");
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  expectRefused(folder_ / "pipe", "it is not a regular file");
}

}  // namespace
}  // namespace meridian
