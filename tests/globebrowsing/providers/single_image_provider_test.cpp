#include "globebrowsing/providers/single_image_provider.h"

#include <fstream>

#include <gtest/gtest.h>

#include "provider_fixture.h"

namespace meridian::globebrowsing {
namespace {

/// Four quarters: red, green over blue, white; binary PPM.
std::string writeQuarters(const std::string& folder) {
  const std::string path = folder + "/quarters.ppm";
  std::ofstream file(path, std::ios::binary);
  const int side = 64;
  file << "P6\n" << side << ' ' << side << "\n255\n";
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const bool right = x >= side / 2;
      const bool below = y >= side / 2;
      const char pixel[3] = {static_cast<char>(right == below ? 255 * (right || !below) : 0),
                             static_cast<char>(right ? 255 : 0), static_cast<char>(below ? 255 : 0)};
      file.write(pixel, 3);
    }
  }
  return path;
}

TEST(SingleImageProvider, ShowsTheWholeImageInEveryTile) {
  const TemporaryFolder folder("single-image");
  writeQuarters(folder.path());
  const auto provider =
      makeProvider(requestFor({{"Type", "SingleImageProvider"}, {"FilePath", "quarters.ppm"}}, folder.path()));
  ASSERT_TRUE(provider);
  ASSERT_TRUE((*provider)->check());
  const Result<void> opened = (*provider)->open();
  ASSERT_TRUE(opened) << opened.error().message();
  const GeodeticTiling tiling = earthTiling();
  for (const TileIndex& index : {TileIndex{0, 0, 0, 0}, TileIndex{1, 3, 2, 4}, TileIndex{1, 9, 0, 255}}) {
    EXPECT_TRUE((*provider)->overlaps(tiling, index));
    const Result<ColourPixels> colours = (*provider)->colours(tiling, index, {});
    ASSERT_TRUE(colours) << colours.error().message();
    ASSERT_EQ(colours->size, colourLayout.size());
    EXPECT_TRUE(colours->allOpaque);
    const auto pixel = [&](double u, double v) {
      const auto column = static_cast<std::size_t>(colourLayout.border + u * colourLayout.interior);
      const auto row = static_cast<std::size_t>(colourLayout.border + v * colourLayout.interior);
      const std::uint8_t* p = &colours->rgba[4 * (row * static_cast<std::size_t>(colours->size) + column)];
      return std::array<int, 3>{p[0], p[1], p[2]};
    };
    EXPECT_EQ(pixel(0.25, 0.25), (std::array{255, 0, 0}));
    EXPECT_EQ(pixel(0.75, 0.25), (std::array{0, 255, 0}));
    EXPECT_EQ(pixel(0.25, 0.75), (std::array{0, 0, 255}));
    EXPECT_EQ(pixel(0.75, 0.75), (std::array{255, 255, 255}));
    EXPECT_EQ(pixel(-0.01, -0.01), (std::array{255, 0, 0})) << "the border goes on with the outermost pixels";
  }
}

TEST(SingleImageProvider, ReadsAPictureFromDebian) {
  const std::string file = "/usr/share/marble/data/bitmaps/city_1_red.png";
  if (!std::filesystem::exists(file)) {
    GTEST_SKIP() << "NOT TESTED: install marble-qt-data for " << file;
  }
  const auto provider = makeProvider(requestFor({{"Type", "SingleImageTileLayer"}, {"FilePath", file}}));
  ASSERT_TRUE(provider);
  ASSERT_TRUE((*provider)->open()) << (*provider)->error()->message();
  EXPECT_TRUE((*provider)->colours(earthTiling(), {}, {})->anyOpaque);
}

TEST(SingleImageProvider, SaysThatItsFileIsMissing) {
  const auto provider = makeProvider(requestFor({{"Type", "SingleImageProvider"}, {"FilePath", "gone.png"}}));
  ASSERT_TRUE(provider);
  EXPECT_FALSE((*provider)->check());
  EXPECT_FALSE((*provider)->open());
}

}  // namespace
}  // namespace meridian::globebrowsing
