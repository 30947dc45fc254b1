#include "host/graphics/image.h"

#include <fstream>

#include <gtest/gtest.h>

namespace meridian::graphics {
namespace {

std::filesystem::path file(const char* name) {
  return std::filesystem::path(MERIDIAN_TEST_FOLDER) / name;
}

/// Every pixel differs, so that swapped rows, columns or channels show.
std::vector<std::uint8_t> pattern(glm::ivec2 size) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(4 * size.x * size.y));
  std::size_t next = 0;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      for (const int value : {x, y, x ^ (3 * y), x + y}) {
        pixels[next++] = static_cast<std::uint8_t>(value);
      }
    }
  }
  return pixels;
}

TEST(Image, ComesBackWithItsAlphaAndItsWords) {
  const glm::ivec2 size(37, 11);
  const auto path = file("alpha.png");
  const auto pixels = pattern(size);
  const ImageMetadata words{
      {"Software", "Meridian"}, {"Time", "2026-11-22T21:17:05"}, {"Copyright", "\u00a9 D\u00fcrer"}};
  const auto written = writePng(path, pixels, size, {.alpha = true, .metadata = words});
  ASSERT_TRUE(written.has_value()) << written.error().message();
  const auto read = readPng(path);
  ASSERT_TRUE(read.has_value()) << read.error().message();
  EXPECT_EQ(read->size, size);
  EXPECT_EQ(read->pixels, pixels);
  EXPECT_EQ(read->metadata, words);
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".part"));
}

TEST(Image, IsOpaqueUnlessAskedOtherwise) {
  const glm::ivec2 size(5, 300);
  auto pixels = pattern(size);
  ASSERT_TRUE(writePng(file("opaque.png"), pixels, size).has_value());
  for (std::size_t alpha = 3; alpha < pixels.size(); alpha += 4) {
    pixels[alpha] = 255;
  }
  const auto read = readPng(file("opaque.png"));
  ASSERT_TRUE(read.has_value()) << read.error().message();
  EXPECT_EQ(read->pixels, pixels);
}

TEST(Image, RefusesSizesThatDoNotFit) {
  const auto pixels = pattern({4, 4});
  for (const glm::ivec2 size : {glm::ivec2(4, 5), glm::ivec2(0, 4), glm::ivec2(-4, -4), glm::ivec2(100000, 1)}) {
    EXPECT_FALSE(writePng(file("never.png"), pixels, size).has_value()) << size.x << " x " << size.y;
  }
  EXPECT_FALSE(std::filesystem::exists(file("never.png")));
}

TEST(Image, SaysWhichFileCannotBeWritten) {
  const auto written = writePng("/nowhere/at/all.png", pattern({2, 2}), {2, 2});
  ASSERT_FALSE(written.has_value());
  EXPECT_EQ(written.error().where, "/nowhere/at/all.png");
  EXPECT_NE(written.error().what.find("No such file"), std::string::npos) << written.error().what;
}

TEST(Image, RefusesDamagedFiles) {
  const glm::ivec2 size(64, 64);
  const auto path = file("damaged.png");
  ASSERT_TRUE(writePng(path, pattern(size), size).has_value());
  const auto bytes = std::filesystem::file_size(path);
  for (const auto length : {std::uintmax_t{0}, std::uintmax_t{7}, std::uintmax_t{30}, bytes / 2, bytes - 8}) {
    std::filesystem::resize_file(path, length);
    EXPECT_FALSE(readPng(path).has_value()) << "cut to " << length << " bytes";
    ASSERT_TRUE(writePng(path, pattern(size), size).has_value());
  }
  std::ofstream(path) << "this is no picture, though it is called one";
  const auto read = readPng(path);
  ASSERT_FALSE(read.has_value());
  EXPECT_EQ(read.error().where, path.string());
  EXPECT_FALSE(readPng(file("absent.png")).has_value());
  EXPECT_FALSE(readPng(std::filesystem::path(MERIDIAN_TEST_FOLDER)).has_value()) << "a folder";
}

}  // namespace
}  // namespace meridian::graphics
