#include <fstream>

#include <gmock/gmock.h>

#include "../globebrowsing/module/globe_fixture.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;

/// A layer whose data are bad says so; the others draw and the view is complete all the same.
class BadLayerFilesTest : public GlobeTest {
 protected:
  void write(const std::string& name, const std::string& contents) {
    std::ofstream(folder_ / name, std::ios::binary) << contents;
  }
  [[nodiscard]] std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Draws a good layer with the bad file above it, in every group.
  void expectTold(const std::string& file, const std::string& says) {
    RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("Good", good_), fileLayer("Bad", file)})},
                                       {"HeightLayers", listOf({fileLayer("Bad", file)})},
                                       {"Overlays", listOf({fileLayer("Bad", file)})},
                                       {"NightLayers", listOf({fileLayer("Bad", file)})}});
    ASSERT_TRUE(settle()) << file;
    EXPECT_EQ(centre(), (Pixel{10, 200, 30})) << file;
    for (const LayerGroupId group :
         {LayerGroupId::ColorLayers, LayerGroupId::HeightLayers, LayerGroupId::Overlays, LayerGroupId::NightLayers}) {
      const Layer* layer = globe.layers().group(group).find("Bad");
      EXPECT_THAT(layer->lastError.get(), HasSubstr(says)) << name(group);
    }
    EXPECT_EQ(globe.layers().group(LayerGroupId::ColorLayers).find("Good")->lastError.get(), "");
    EXPECT_EQ(globe.heightAt(0.1, 0.2), 0.0);
    removeGlobes();
  }

  void SetUp() override {
    GlobeTest::SetUp();
    if (graphics_) {
      good_ = uniformRaster("good.tif", {10, 200, 30});
    }
  }
  std::string good_;
};

TEST_F(BadLayerFilesTest, MissingFile) {
  expectTold((folder_ / "none.tif").string(), "none.tif");
}

TEST_F(BadLayerFilesTest, DirectoryInsteadOfAFile) {
  std::filesystem::create_directory(folder_ / "folder.tif");
  expectTold((folder_ / "folder.tif").string(), "folder.tif");
}

TEST_F(BadLayerFilesTest, EmptyFile) {
  write("empty.tif", "");
  expectTold((folder_ / "empty.tif").string(), "empty.tif");
}

TEST_F(BadLayerFilesTest, Garbage) {
  write("garbage.tif", std::string(5000, '\x5a'));
  expectTold((folder_ / "garbage.tif").string(), "garbage.tif");
}

TEST_F(BadLayerFilesTest, TruncatedHeader) {
  write("cut.tif", contents(good_).substr(0, 100));
  expectTold((folder_ / "cut.tif").string(), "cut.tif");
}

TEST_F(BadLayerFilesTest, MetresWithoutACoordinateSystem) {
  GDALAllRegister();
  const std::string path = (folder_ / "metres.tif").string();
  {
    GDALDatasetUniquePtr dataset(
        GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), 64, 64, 1, GDT_Byte, nullptr));
    std::array<double, 6> transform{500000.0, 30.0, 0.0, 5000000.0, 0.0, -30.0};
    dataset->SetGeoTransform(transform.data());
  }
  expectTold(path, "outside the globe");
}

/// It opens, and fails while tiles are read.
TEST_F(BadLayerFilesTest, PixelsThatEndHalfWay) {
  GDALAllRegister();
  const std::string path = (folder_ / "half.tif").string();
  {
    char** options = CSLAddString(nullptr, "TILED=YES");
    options = CSLAddString(options, "COMPRESS=DEFLATE");
    GDALDatasetUniquePtr dataset(
        GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), 2048, 1024, 3, GDT_Byte, options));
    CSLDestroy(options);
    std::array<double, 6> transform{-180.0, 360.0 / 2048, 0.0, 90.0, 0.0, -180.0 / 1024};
    dataset->SetGeoTransform(transform.data());
    OGRSpatialReference crs;
    crs.SetWellKnownGeogCS("WGS84");
    dataset->SetSpatialRef(&crs);
    std::vector<std::uint8_t> noise(2048 * 1024);
    std::uint32_t state = 1;
    for (std::uint8_t& value : noise) {
      state = state * 1664525U + 1013904223U;
      value = static_cast<std::uint8_t>(state >> 24U);
    }
    for (int band = 1; band <= 3; ++band) {
      ASSERT_EQ(CE_None, dataset->GetRasterBand(band)->RasterIO(GF_Write, 0, 0, 2048, 1024, noise.data(), 2048, 1024,
                                                                GDT_Byte, 0, 0, nullptr));
    }
  }
  // The directory of tiles stays readable, the tiles in the middle do not.
  std::string bytes = contents(path);
  for (std::size_t i = bytes.size() / 4; i < bytes.size() - bytes.size() / 4; ++i) {
    bytes[i] = '\x00';
  }
  write("half.tif", bytes);
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("Good", good_), fileLayer("Bad", path)})}});
  ASSERT_TRUE(settle());
  const Layer* layer = globe.layers().group(LayerGroupId::ColorLayers).find("Bad");
  EXPECT_THAT(layer->lastError.get(), HasSubstr("Layers.ColorLayers.Bad.FilePath"));
  EXPECT_THAT(layer->lastError.get(), HasSubstr("cannot be read"));
  EXPECT_GT(statistics_.tiles.failed.load(), 0U);
  EXPECT_NE(centre(), (Pixel{0, 0, 0}));
}

/// Values without data that nobody declared, and a wrong unit.
TEST_F(BadLayerFilesTest, AHeightThatNoBodyHas) {
  const std::string low = raster(
      "low.tif", [](int, double, double) { return 700.0; }, 1, GDT_Float32, 64);
  for (const double wild : {-9.9999998e33, 1e9, 1e8, -7e6}) {
    const std::string file = raster(
        "wild.tif",
        [&](int, double longitude, double latitude) {
          return std::abs(longitude - 11.5) < 3.0 && std::abs(latitude - 5.7) < 3.0 ? wild : 2500.0;
        },
        1, GDT_Float32, 64);
    RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("Good", good_)})},
                                       {"HeightLayers", listOf({fileLayer("Low", low), fileLayer("Wild", file)})}});
    ASSERT_TRUE(settle()) << wild;
    EXPECT_EQ(centre(), (Pixel{10, 200, 30})) << wild;
    const LayerGroup& heights = globe.layers().group(LayerGroupId::HeightLayers);
    EXPECT_THAT(heights.find("Wild")->lastError.get(), HasSubstr("taken for no data"));
    EXPECT_EQ(heights.find("Low")->lastError.get(), "");
    EXPECT_NEAR(globe.heightAt(0.1, 0.2), 700.0, 1.0) << wild;
    EXPECT_NEAR(globe.heightAt(0.1, 0.5), 2500.0, 1.0) << wild;
    removeGlobes();
  }
}

TEST_F(BadLayerFilesTest, AJpegThatEndsHalfWay) {
  GDALAllRegister();
  const std::string path = (folder_ / "whole.jpg").string();
  {
    const std::string noise = raster("noise.tif", [](int band, double longitude, double latitude) {
      return std::abs(std::fmod(longitude * 37.0 + latitude * 91.0 + band * 50.0, 256.0));
    });
    GDALDatasetUniquePtr from(GDALDataset::Open(noise.c_str()));
    GDALDatasetUniquePtr made(GetGDALDriverManager()->GetDriverByName("JPEG")->CreateCopy(path.c_str(), from.get(), 0,
                                                                                          nullptr, nullptr, nullptr));
    ASSERT_TRUE(made);
  }
  const std::string bytes = contents(path);
  write("cut.jpg", bytes.substr(0, bytes.size() / 3));
  RenderableGlobe& globe =
      addGlobe({{"ColorLayers", listOf({fileLayer("Good", good_), fileLayer("Bad", (folder_ / "cut.jpg").string())})}});
  ASSERT_TRUE(settle());
  EXPECT_THAT(globe.layers().group(LayerGroupId::ColorLayers).find("Bad")->lastError.get(),
              HasSubstr("cannot be read"));
  EXPECT_EQ(centre(), (Pixel{10, 200, 30}));
}

TEST_F(BadLayerFilesTest, AFileThatComesLaterIsFoundByReset) {
  const std::string path = (folder_ / "later.tif").string();
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("Later", path)})}});
  ASSERT_TRUE(settle());
  Layer* layer = globe.layers().group(LayerGroupId::ColorLayers).find("Later");
  EXPECT_NE(layer->lastError.get(), "");
  std::filesystem::copy_file(good_, path);
  layer->reset.fire();
  ASSERT_TRUE(settle());
  EXPECT_EQ(layer->lastError.get(), "");
  EXPECT_EQ(centre(), (Pixel{10, 200, 30}));
}

}  // namespace
}  // namespace meridian::globebrowsing
