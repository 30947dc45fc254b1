#include <fstream>

#include "globebrowsing/source/netcdf_length.h"
#include "tile_service_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

/// A folder of its own for files that must be on disk.
class BadInput : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("bad-input-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = folder_ / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }
  std::filesystem::path folder_;
};

void expectRefused(const RasterDescription& description, const std::string& what) {
  testing::internal::CaptureStderr();
  const auto source = RasterSource::open(description);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "GDAL's messages belong into the error";
  ASSERT_FALSE(source) << description.path;
  EXPECT_NE(source.error().what.find(what), std::string::npos) << source.error().message();
  EXPECT_EQ(source.error().where, description.where.empty() ? description.path : description.where);
}

TEST_F(BadInput, IsRefusedByName) {
  expectRefused({"", "earth.asset:7"}, "no raster is named");
  expectRefused({(folder_ / "none.tif").string(), "earth.asset:7"}, "there is no file");
  expectRefused({folder_.string()}, "is a folder");
  expectRefused({write("text.tif", "this is no raster")}, "no raster that GDAL can read");
  expectRefused({write("empty.tif", "")}, "no raster that GDAL can read");
  expectRefused({"<VRTDataset rasterXSize=\"10\"", "inline"}, "no raster that GDAL can read");
  expectRefused({"WMS:", "inline"}, "no raster that GDAL can read");
}

TEST_F(BadInput, AContainerOfSeveralRastersIsRefused) {
  const std::string path = "/usr/share/ferret-vis/data/coads_climatology.cdf";
  MERIDIAN_NEEDS(path);
  expectRefused({path}, "no bands");
}

TEST_F(BadInput, ComplexSamplesAreRefused) {
  const MadeRaster raster({8, 8, northUp(0, 10, 1), GDT_CFloat32}, [](int, int, int) { return 1.0; });
  expectRefused({raster.path()}, "complex samples");
}

TEST_F(BadInput, PlacesOutsideTheGlobeAreRefused) {
  const MadeRaster metres({8, 8, {500000, 30, 0, 5000000, 0, -30}, GDT_Byte, 1, ""}, [](int, int, int) { return 1.0; });
  expectRefused({metres.path()}, "outside the globe");
  const MadeRaster flat({8, 8, {10, 0, 0, 20, 0, 0}, GDT_Byte}, [](int, int, int) { return 1.0; });
  expectRefused({flat.path()}, "geotransform cannot be inverted");
  RasterDescription backwards{flat.path()};
  backwards.extentDegrees = {10, 0, -10, 10};
  expectRefused(backwards, "the extent is empty");
}

TEST_F(BadInput, ACrsThatProjRejectsIsRefused) {
  const std::string path = sharedData("imagery/mars/mola_clrshade_mercator_BAD_k0.tif");
  MERIDIAN_NEEDS(path);
  expectRefused({path}, "PROJ");
}

TEST_F(BadInput, ATruncatedRasterFailsTileByTile) {
  const MadeRaster whole({600, 600, northUp(0, 60, 0.1), GDT_Float64},
                         [](int, int column, int row) { return column * row; });
  vsi_l_offset length = 0;
  const GByte* bytes = VSIGetMemFileBuffer(whole.path().c_str(), &length, FALSE);
  const std::string half(reinterpret_cast<const char*>(bytes), length / 2);
  testing::internal::CaptureStderr();
  const auto source = RasterSource::open({write("half.tif", half), "earth.asset:9"});
  const GeodeticTiling tiling = earth();
  if (source) {
    for (int again = 0; again < 2; ++again) {
      const auto pixels = resampleHeights(**source, tiling, tileAt(tiling, 10, 30, 3), heightLayout, {});
      ASSERT_FALSE(pixels);
      EXPECT_EQ(pixels.error().where, "earth.asset:9");
      EXPECT_NE(pixels.error().what.find("cannot be read"), std::string::npos) << pixels.error().message();
    }
  } else {
    EXPECT_EQ(source.error().where, "earth.asset:9");
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(BadInput, HeightsOutOfAllProportionAreNoData) {
  for (const double wild : {-9.9999998e33, 1e9, 1e8, -7e6}) {
    const MadeRaster raster({512, 256, northUp(-180, 90, 360.0 / 512), GDT_Float32},
                            [&](int, int column, int row) { return column == 300 && row == 100 ? wild : 100.0; });
    RasterDescription description{raster.path(), "earth.asset:9"};
    const GeodeticTiling tiling = earth();
    description.heightLimits = tiling.ellipsoid().heightLimits();
    const auto source = RasterSource::open(description);
    ASSERT_TRUE(source);
    EXPECT_FALSE((*source)->flaw());
    const double longitude = -180.0 + 300.5 * 360.0 / 512;
    const double latitude = 90.0 - 100.5 * 360.0 / 512;
    // Coarse tiles average the pixels about it, which it must not spoil; fine ones have it alone.
    for (const int level : {0, 1, 2, 8}) {
      const auto pixels =
          resampleHeights(**source, tiling, tileAt(tiling, latitude, longitude, level), heightLayout, {});
      ASSERT_TRUE(pixels);
      ASSERT_TRUE(pixels->any || level == 8);
      EXPECT_NEAR(pixels->any ? pixels->minimum : 100.0, 100.0, 1e-3) << wild << " at level " << level;
      EXPECT_NEAR(pixels->any ? pixels->maximum : 100.0, 100.0, 1e-3) << wild << " at level " << level;
    }
    ASSERT_TRUE((*source)->flaw());
    EXPECT_EQ((*source)->flaw()->where, "earth.asset:9");
    EXPECT_NE((*source)->flaw()->what.find("taken for no data"), std::string::npos) << (*source)->flaw()->message();
  }
}

TEST_F(BadInput, HeightsOfAServiceOutOfAllProportionAreNoData) {
  Served served(geographic, [](std::size_t, std::int64_t column, std::int64_t row) {
    return Texel{column % 16 == 3 && row % 16 == 5 ? -1e30F : 700.0F, {1, 2, 3, 255}};
  });
  const GeodeticTiling tiling = earth();
  const auto pixels = served.heights(tiling, TileIndex{0, 1, 0, 0});
  ASSERT_TRUE(pixels && pixels->any);
  EXPECT_NEAR(pixels->minimum, 700.0, 1e-3);
  EXPECT_NEAR(pixels->maximum, 700.0, 1e-3);
  ASSERT_TRUE(served.flaw);
  EXPECT_NE(served.flaw->what.find("taken for no data"), std::string::npos) << served.flaw->message();
}

/// The file's bytes, after it was written by a driver from a made raster.
std::string encoded(const std::string& driver, const MadeRaster& raster, const std::string& path) {
  GDALDatasetUniquePtr from(GDALDataset::Open(raster.path().c_str()));
  GDALDriver* to = GetGDALDriverManager()->GetDriverByName(driver.c_str());
  if (from == nullptr || to == nullptr) {
    return {};
  }
  GDALDatasetUniquePtr made(to->CreateCopy(path.c_str(), from.get(), FALSE, nullptr, nullptr, nullptr));
  made.reset();
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(BadInput, AJpegThatEndsEarlyIsNotGrey) {
  const MadeRaster whole({512, 256, northUp(-180, 90, 360.0 / 512), GDT_Byte, 3},
                         [](int band, int column, int row) { return (column * 7 + row * 13 + band * 50) % 256; });
  const std::string bytes = encoded("JPEG", whole, (folder_ / "whole.jpg").string());
  ASSERT_GT(bytes.size(), 4000U);
  const GeodeticTiling tiling = earth();
  const auto good = RasterSource::open({write("good.jpg", bytes), "earth.asset:9"});
  ASSERT_TRUE(good);
  EXPECT_TRUE(resampleColours(**good, tiling, tileAt(tiling, -60, 10, 3), colourLayout, {}));
  EXPECT_FALSE((*good)->flaw());
  const auto cut = RasterSource::open({write("cut.jpg", bytes.substr(0, bytes.size() / 3)), "earth.asset:9"});
  ASSERT_TRUE(cut) << cut.error().message();
  for (const double longitude : {10.0, -100.0, 10.0, 170.0}) {
    for (const int level : {3, 2, 1}) {
      const auto pixels = resampleColours(**cut, tiling, tileAt(tiling, -60, longitude, level), colourLayout, {});
      ASSERT_FALSE(pixels) << longitude << ", level " << level;
      EXPECT_EQ(pixels.error().where, "earth.asset:9");
      EXPECT_NE(pixels.error().what.find("cannot be read"), std::string::npos) << pixels.error().message();
    }
  }
}

TEST_F(BadInput, ANetcdfThatEndsEarlySaysSo) {
  const MadeRaster whole({128, 64, northUp(-180, 90, 360.0 / 128), GDT_Float32},
                         [](int, int column, int row) { return 100.0 + column + row; });
  const std::string bytes = encoded("netCDF", whole, (folder_ / "whole.nc").string());
  if (bytes.substr(0, 3) != "CDF") {
    GTEST_SKIP() << "GDAL writes no classic netCDF here";
  }
  const GeodeticTiling tiling = earth();
  const auto good = RasterSource::open({write("good.nc", bytes), "earth.asset:9"});
  ASSERT_TRUE(good) << good.error().message();
  EXPECT_FALSE((*good)->flaw());
  const auto cut = RasterSource::open({write("cut.nc", bytes.substr(0, bytes.size() / 2)), "earth.asset:9"});
  if (!cut) {
    EXPECT_EQ(cut.error().where, "earth.asset:9");
    return;
  }
  ASSERT_TRUE((*cut)->flaw());
  EXPECT_NE((*cut)->flaw()->what.find("the file ends after"), std::string::npos) << (*cut)->flaw()->message();
}

TEST_F(BadInput, TheLengthOfANetcdfIsThatOfItsVariables) {
  const auto bigEndian = [](std::uint64_t value, int bytes) {
    std::string text;
    for (int i = bytes - 1; i >= 0; --i) {
      text.push_back(static_cast<char>(value >> (8U * static_cast<unsigned>(i)) & 0xffU));
    }
    return text;
  };
  // Two dimensions, records and 3; no attributes; a float variable of 3 and a byte one of records by 3, and its fellow.
  for (const int version : {1, 2, 5}) {
    const int size = version == 5 ? 8 : 4;
    const auto number = [&](std::uint64_t value) { return bigEndian(value, size); };
    const auto tag = [&](std::uint64_t value) { return bigEndian(value, 4); };
    const auto name = [&](const char* letter) { return number(1) + letter + std::string(3, '\0'); };
    const std::string none = tag(0) + number(0);
    const auto variable = [&](const std::string& dimensions, std::uint64_t type, std::uint64_t begin) {
      return name("v") + dimensions + none + tag(type) + number(0) + bigEndian(begin, version == 1 ? 4 : 8);
    };
    const std::string alone = number(1) + number(1);
    const std::string both = number(2) + number(0) + number(1);
    const std::string start = std::string("CDF") + static_cast<char>(version) + number(5) + tag(10) + number(2) +
                              name("r") + number(0) + name("x") + number(3) + none + tag(11);
    const std::string one = start + number(2) + variable(alone, 5, 1000) + variable(both, 1, 1012);
    const std::string two =
        start + number(3) + variable(alone, 5, 1000) + variable(both, 1, 1012) + variable(both, 1, 1016);
    EXPECT_EQ(classicNetcdfLength(write("one.nc", one)), 1012U + 5 * 3) << version;
    EXPECT_EQ(classicNetcdfLength(write("two.nc", two)), 1016U + 4 * 8 + 3) << version;
    for (std::size_t cut = 0; cut < two.size(); cut += 3) {
      EXPECT_FALSE(classicNetcdfLength(write("cut.nc", two.substr(0, cut)))) << version << ", " << cut;
    }
  }
  EXPECT_FALSE(classicNetcdfLength(write("other.nc", "CDF\x03 and more of it, which is no header")));
  EXPECT_FALSE(classicNetcdfLength(write("wild.nc", "CDF\x01" + std::string(64, '\xff'))));
}

TEST_F(BadInput, AnAbsurdSizeCostsNothing) {
  // Two thousand million pixels a side, nearly all without data: opening and a fine tile are quick.
  const std::string vrt =
      "<VRTDataset rasterXSize=\"2000000000\" rasterYSize=\"1000000000\"><SRS>EPSG:4326</SRS>"
      "<GeoTransform>-180,1.8e-7,0,90,0,-1.8e-7</GeoTransform><VRTRasterBand dataType=\"Byte\" "
      "band=\"1\"/></VRTDataset>";
  const auto source = RasterSource::open({vrt, "inline"});
  ASSERT_TRUE(source) << source.error().message();
  const GeodeticTiling tiling = earth();
  EXPECT_TRUE(colours(**source, tiling, tileAt(tiling, 10, 30, 20)).anyOpaque);
  EXPECT_TRUE(colours(**source, tiling, tileAt(tiling, 10, 30, 12)).anyOpaque);
  EXPECT_TRUE(colours(**source, tiling, TileIndex{}).allOpaque);
}

}  // namespace
}  // namespace meridian::globebrowsing
