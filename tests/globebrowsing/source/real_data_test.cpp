#include "raster_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

GeodeticTiling sphere(double radius) {
  return GeodeticTiling(*Ellipsoid::fromRadii({radius, radius, radius}));
}

/// Extremes of the tile of that level at the place, in degrees.
HeightPixels around(const RasterSource& source, const Tiling& tiling, double latitude, double longitude, int level) {
  return heights(source, tiling, tileAt(tiling, latitude, longitude, level));
}

TEST(Etopo5, HasMountainsAndTrenchesWhereTheyAre) {
  MERIDIAN_NEEDS(etopo5);
  const auto source = open({etopo5});
  EXPECT_TRUE(source->info().coversAllLongitudes);
  const GeodeticTiling tiling = earth();
  EXPECT_GT(around(*source, tiling, 28.0, 86.9, 8).maximum, 5500.0F);    // Everest
  EXPECT_GT(around(*source, tiling, 45.9, 6.9, 8).maximum, 2500.0F);     // Mont Blanc, means of 9 km
  EXPECT_LT(around(*source, tiling, 11.4, 142.4, 8).minimum, -9000.0F);  // Challenger Deep
  EXPECT_NEAR(around(*source, tiling, 0.0, -30.0, 9).maximum, -3500.0F, 1500.0F);
}

TEST(Etopo5, IsNodeRegisteredAndSeamless) {
  MERIDIAN_NEEDS(etopo5);
  const auto source = open({etopo5});
  const GeodeticTiling tiling = earth();
  // Straight from the file: column c is longitude c / 12, row r is latitude 90 - r / 12.
  const GDALDatasetUniquePtr file = openWithGdal(etopo5);
  const TileLayout layout{2, 0, Registration::NodeRegistered};
  for (const auto& [latitude, longitude] :
       {std::pair{0.0, 0.0}, {45.0, -180.0}, {45.0, 90.0}, {-45.0, -90.0}, {22.5, -135.0}, {67.5, 0.0}, {90.0, 45.0}}) {
    // The north-western corner of a tile of two nodes a side, small enough for full resolution.
    const TileIndex index = tileAt(tiling, latitude - 1e-7, longitude + 1e-7, 14);
    const GeodeticPosition corner = tiling.geodetic(index, {0, 0});
    ASSERT_NEAR(corner.latitude / degree, latitude, 1e-9);
    const double column = std::fmod(corner.longitude / degree + 360, 360) * 12;
    const double row = (90 - latitude) * 12;
    ASSERT_NEAR(column, std::round(column), 1e-6);
    float value = 0;
    ASSERT_EQ(CE_None, file->GetRasterBand(1)->RasterIO(GF_Read, static_cast<int>(std::lround(column)),
                                                        static_cast<int>(std::lround(row)), 1, 1, &value, 1, 1,
                                                        GDT_Float32, 0, 0, nullptr));
    EXPECT_NEAR(heights(*source, tiling, index, layout).metres[0], value, 1e-3) << latitude << ' ' << longitude;
  }
  // South of 90 S there is nothing; the pole is the plateau's 2800 m.
  const HeightPixels pole = around(*source, tiling, -89.99, 10, 5);
  EXPECT_NEAR(pole.metres[at(heightLayout, 64, 128)], 2800.0F, 200.0F);
  for (const float metres : pole.metres) {
    ASSERT_FALSE(std::isnan(metres));
  }
}

TEST(Etopo1, CountsTheDoubledMeridianOnce) {
  const std::string path = sharedData("dem/earth/ETOPO1_resampled_1deg.tif");
  MERIDIAN_NEEDS(path);
  const auto source = open({path});
  EXPECT_TRUE(source->info().coversAllLongitudes);
  EXPECT_NEAR(source->info().north, 90 * degree, 1e-12);
  const GeodeticTiling tiling = earth();
  const HeightPixels west = around(*source, tiling, 20, -179.9, 3);
  const HeightPixels east = around(*source, tiling, 20, 179.9, 3);
  for (int row = 0; row < 129; ++row) {
    EXPECT_EQ(west.metres[at(heightLayout, 0, row)], east.metres[at(heightLayout, 128, row)]);
  }
}

TEST(Mola, HasOlympusMonsAndHellas) {
  const std::string path = sharedData("dem/mars/megt90n000cb.lbl");
  MERIDIAN_NEEDS(path);
  RasterDescription description{path};
  description.extentDegrees = {0, -90, 360, 90};
  const auto source = open(description);
  const GeodeticTiling tiling = sphere(3396190);
  const HeightPixels olympus = around(*source, tiling, 18.65, -133.8, 5);
  EXPECT_GT(olympus.maximum, 20500.0F);
  EXPECT_LT(around(*source, tiling, -42.5, 70.0, 4).minimum, -6500.0F);
}

TEST(Lola, StoresRadiiAndGivesHeights) {
  const std::string path = sharedData("dem/moon/ldem_4.cub");
  MERIDIAN_NEEDS(path);
  const auto source = open({path});
  EXPECT_DOUBLE_EQ(source->info().heightOffset, 0.0);
  EXPECT_DOUBLE_EQ(source->info().heightScale, 0.5);
  const GeodeticTiling tiling = sphere(1737400);
  EXPECT_LT(around(*source, tiling, -70.4, -172.5, 4).minimum, -8000.0F);  // Antoniadi, in South Pole-Aitken
  EXPECT_GT(around(*source, tiling, 5.4, -158.6, 4).maximum, 10000.0F);    // the highest ground
}

struct Warped {
  const char* name;
  const char* file;
  double latitude;
  double longitude;
  int level;
  double tolerance;
  int least;  // samples that must be compared
};

class Gdalwarp : public testing::TestWithParam<Warped> {};

TEST_P(Gdalwarp, GivesTheSameHeights) {
  const Warped& warped = GetParam();
  const std::string path = sharedData(warped.file);
  MERIDIAN_NEEDS(path);
  const auto source = open({path});
  const GeodeticTiling tiling = sphere(6371000);
  const TileIndex index = tileAt(tiling, warped.latitude, warped.longitude, warped.level);
  const HeightPixels pixels = heights(*source, tiling, index);
  const std::vector<double> expected = gdalwarp(path, tiling, index, heightLayout, "cubic");
  int compared = 0;
  double worst = 0;
  for (int row = 2; row < 127; ++row) {
    for (int column = 2; column < 127; ++column) {
      const double other = expected[static_cast<std::size_t>(row * 129 + column)];
      const float own = pixels.metres.empty() ? 0.0F : pixels.metres[at(heightLayout, column, row)];
      // Where data end, the two differ in what they do; here, two samples away from such places.
      bool isInner = true;
      for (int r = row - 2; r <= row + 2; ++r) {
        for (int c = column - 2; c <= column + 2; ++c) {
          isInner = isInner && !std::isnan(expected[static_cast<std::size_t>(r * 129 + c)]) &&
                    !std::isnan(pixels.metres[at(heightLayout, c, r)]);
        }
      }
      if (isInner) {
        worst = std::max(worst, std::abs(own - other));
        ++compared;
      }
    }
  }
  EXPECT_LE(worst, warped.tolerance);
  EXPECT_GE(compared, warped.least);
}

// Levels at which the tiles' nodes are closer than the pixels: both interpolate then.
INSTANTIATE_TEST_SUITE_P(
    RealRasters, Gdalwarp,
    testing::Values(Warped{"Srtm", "dem/earth/mt_rainier_90m.tif", 46.85, -121.75, 11, 0.01, 13000},
                    Warped{"SrtmHgt", "dem/earth/N00E010.hgt", 0.5, 10.5, 11, 0.01, 15000},
                    Warped{"Laea", "dem/earth/eu_dem_N2000000E4000000_laea.tif", 46.0, 11.0, 6, 0.01, 5000},
                    Warped{"PolarMoon", "dem/moon/DERIVED_ldem4_south_polar_stereo.tif", -80.0, 30.0, 7, 0.01, 10000}),
    [](const auto& tested) { return tested.param.name; });

TEST(ProjectedImages, AgreeWithGdalwarp) {
  struct Case {
    const char* file;
    double latitude;
    double longitude;
    int level;
    double allowed;  // mean difference: JPEG overviews play no part, rounding does
  };
  const GeodeticTiling tiling = sphere(3396190);
  for (const Case& image : {Case{"imagery/mars/mola_clrshade_north_polar.tif", 70, 20, 6, 0.6},
                            Case{"imagery/mars/cog_hirise_mars.tif", -14.58, -53.566, 13, 0.6}}) {
    const std::string path = sharedData(image.file);
    MERIDIAN_NEEDS(path);
    const auto source = open({path});
    const TileIndex index = tileAt(tiling, image.latitude, image.longitude, image.level);
    const TileLayout layout{256, 4, Registration::PixelCentred};
    const ColourPixels pixels = colours(*source, tiling, index, layout);
    ASSERT_TRUE(pixels.anyOpaque) << image.file;
    const std::vector<double> expected = gdalwarp(path, tiling, index, layout, "bilinear");
    double sum = 0;
    int compared = 0;
    for (int row = 0; row < 256; ++row) {
      for (int column = 0; column < 256; ++column) {
        const double other = expected[static_cast<std::size_t>(row * 256 + column)];
        const std::uint8_t* own = pixels.rgba.data() + 4 * at(layout, column, row);
        if (!std::isnan(other) && own[3] == 255 && other > 0) {
          sum += std::abs(own[0] - other);
          ++compared;
        }
      }
    }
    EXPECT_GT(compared, 5000) << image.file;
    EXPECT_LT(sum / compared, image.allowed) << image.file;
  }
}

TEST(PolarStereographic, HasThePoleInside) {
  const std::string path = sharedData("dem/moon/DERIVED_ldem4_south_polar_stereo.tif");
  MERIDIAN_NEEDS(path);
  const auto source = open({path});
  EXPECT_TRUE(source->info().coversAllLongitudes);
  EXPECT_DOUBLE_EQ(source->info().south, -90 * degree);
  const GeodeticTiling tiling = sphere(1737400);
  for (const double longitude : {-135.0, -45.0, 45.0, 135.0}) {
    const HeightPixels pixels = around(*source, tiling, -89.9, longitude, 5);
    for (const float metres : pixels.metres) {
      ASSERT_FALSE(std::isnan(metres)) << longitude;
    }
  }
  EXPECT_FALSE(source->overlaps(tiling, tileAt(tiling, 0, 0, 3)));
}

TEST(BlueMarble, HasOceansAndDesertsWhereTheyAre) {
  MERIDIAN_NEEDS(blueMarble);
  const auto source = open({blueMarble});
  const GeodeticTiling tiling = earth();
  const auto colourAt = [&](double latitude, double longitude) {
    const ColourPixels pixels = colours(*source, tiling, tileAt(tiling, latitude, longitude, 8));
    const std::uint8_t* middle = pixels.rgba.data() + 4 * at(colourLayout, 256, 256);
    return std::array<int, 4>{middle[0], middle[1], middle[2], middle[3]};
  };
  const auto sahara = colourAt(23, 10);
  EXPECT_GT(sahara[0], sahara[2] + 40);
  const auto pacific = colourAt(0, -150);
  EXPECT_GT(pacific[2], pacific[0]);
  const ColourPixels west = colours(*source, tiling, TileIndex{0, 0, 0, 0});
  const ColourPixels east = colours(*source, tiling, TileIndex{1, 0, 0, 0});
  EXPECT_TRUE(west.allOpaque);
  EXPECT_TRUE(east.allOpaque);
  // The border repeats the neighbour's pixels.
  for (int row = 8; row < 520; ++row) {
    for (int channel = 0; channel < 3; ++channel) {
      ASSERT_EQ(west.rgba[static_cast<std::size_t>(4 * (row * 528 + 520) + channel)],
                east.rgba[static_cast<std::size_t>(4 * (row * 528 + 8) + channel)]);
      ASSERT_EQ(west.rgba[static_cast<std::size_t>(4 * (row * 528 + 7) + channel)],
                east.rgba[static_cast<std::size_t>(4 * (row * 528 + 519) + channel)]);
    }
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
