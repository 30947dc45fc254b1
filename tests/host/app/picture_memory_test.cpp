#include "host/app/picture_memory.h"

#include <cstdio>

#include <gtest/gtest.h>

namespace meridian::app {
namespace {

TEST(PictureMemory, LetsThroughWhatFits) {
  EXPECT_TRUE(checkPictureFits({1280, 720}, 0)) << "ordinary ones are always tried";
  EXPECT_TRUE(checkPictureFits({8192, 8192}, std::nullopt));
  EXPECT_TRUE(checkPictureFits({8192, 8192}, std::uint64_t{16} << 30));
}

TEST(PictureMemory, NamesASizeThatFits) {
  const std::uint64_t available = std::uint64_t{2} << 30;
  const auto refused = checkPictureFits({16384, 4096}, available);
  ASSERT_FALSE(refused);
  glm::ivec2 smaller{0};
  ASSERT_EQ(std::sscanf(refused.error().remedy.c_str(), "use at most %dx%d", &smaller.x, &smaller.y), 2);
  EXPECT_TRUE(checkPictureFits(smaller, available)) << refused.error().message();
  EXPECT_NEAR(static_cast<double>(smaller.x) / smaller.y, 4.0, 0.01);
}

TEST(PictureMemory, KnowsThisMachine) {
  const auto available = availableMemory();
  ASSERT_TRUE(available);
  EXPECT_GT(*available, std::uint64_t{1} << 20);
}

}  // namespace
}  // namespace meridian::app
