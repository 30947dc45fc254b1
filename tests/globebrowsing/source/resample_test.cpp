#include <thread>

#include <glm/geometric.hpp>

#include "raster_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

constexpr float tolerance = 2e-3F;  // of heights up to some thousand metres in float

double plane(double longitudeDegrees, double latitudeDegrees) {
  return 100.0 + 3.0 * longitudeDegrees - 7.0 * latitudeDegrees;
}

/// Smooth at the poles, too.
double wave(double longitudeDegrees, double latitudeDegrees) {
  return 1000.0 * std::sin(2.0 * longitudeDegrees * degree + 0.3) * std::pow(std::cos(latitudeDegrees * degree), 2.0);
}

TEST(ResampleHeights, IsExactForAPlane) {
  const MadeRaster raster({400, 300, northUp(10, 50, 0.05)}, [](int, int column, int row) {
    return plane(10 + 0.05 * (column + 0.5), 50 - 0.05 * (row + 0.5));
  });
  const auto source = open({raster.path()});
  const GeodeticTiling tiling = earth();
  for (const int level : {5, 7, 9, 12, 20}) {
    const TileIndex index = tileAt(tiling, 42.0, 20.0, level);
    const HeightPixels pixels = heights(*source, tiling, index);
    ASSERT_TRUE(pixels.any);
    for (int row = -1; row <= 129; ++row) {
      for (int column = -1; column <= 129; ++column) {
        const GeodeticPosition place = tiling.geodetic(index, heightLayout.uv(column + 1, row + 1));
        const double latitude = place.latitude / degree;
        const double longitude = place.longitude / degree;
        if (longitude < 11 || longitude > 29 || latitude < 36 || latitude > 49) {
          continue;
        }
        ASSERT_NEAR(pixels.metres[at(heightLayout, column, row)], plane(longitude, latitude), tolerance)
            << level << ' ' << column << ' ' << row;
      }
    }
  }
}

TEST(ResampleHeights, GoesThroughARotatedGeotransform) {
  const std::array<double, 6> transform{10, 0.03, 0.02, 50, 0.02, -0.03};
  const MadeRaster raster({400, 400, transform}, [&](int, int column, int row) {
    const double x = column + 0.5;
    const double y = row + 0.5;
    return plane(transform[0] + transform[1] * x + transform[2] * y,
                 transform[3] + transform[4] * x + transform[5] * y);
  });
  const auto source = open({raster.path()});
  EXPECT_FALSE(source->info().isGeographic);
  const GeodeticTiling tiling = earth();
  const TileIndex index = tileAt(tiling, 48.0, 20.0, 8);
  const HeightPixels pixels = heights(*source, tiling, index);
  for (int node = 0; node < 129; ++node) {
    const GeodeticPosition place = tiling.geodetic(index, heightLayout.uv(node + 1, 65));
    EXPECT_NEAR(pixels.metres[at(heightLayout, node, 64)], plane(place.longitude / degree, place.latitude / degree),
                tolerance);
  }
}

struct Global {
  const char* name;
  double west;
  bool nodes;  // rows on the poles
};

class GlobalRaster : public testing::TestWithParam<Global> {};

TEST_P(GlobalRaster, IsSeamlessAtTheAntimeridianAndThePoles) {
  const Global& global = GetParam();
  const double pixel = 0.25;
  const double half = global.nodes ? pixel / 2 : 0.0;
  const MadeRaster raster({1440, global.nodes ? 721 : 720, northUp(global.west - half, 90 + half, pixel)},
                          [&](int, int column, int row) {
                            return wave(global.west - half + pixel * (column + 0.5), 90 + half - pixel * (row + 0.5));
                          });
  const auto source = open({raster.path()});
  EXPECT_TRUE(source->info().coversAllLongitudes);
  const GeodeticTiling tiling = earth();
  for (const double longitude : {-179.9, 179.9, -0.1, 0.1}) {
    for (const double latitude : {-89.9, -30.0, 5.0, 89.9}) {
      for (const int level : {0, 2, 4, 7}) {
        const TileIndex index = tileAt(tiling, latitude, longitude, level);
        const HeightPixels pixels = heights(*source, tiling, index);
        for (int row = -1; row <= 129; ++row) {
          for (int column = -1; column <= 129; ++column) {
            const GeodeticPosition place = tiling.geodetic(index, heightLayout.uv(column + 1, row + 1));
            // A coarse level's mean lies below it.
            ASSERT_NEAR(pixels.metres[at(heightLayout, column, row)],
                        wave(place.longitude / degree, place.latitude / degree), level == 0 ? 1.5 : 0.3)
                << toString(index) << ' ' << column << ' ' << row;
          }
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Conventions, GlobalRaster,
                         testing::Values(Global{"from0", 0.0, false}, Global{"from180W", -180.0, false},
                                         Global{"nodesFrom0", 0.0, true}, Global{"nodesFrom180W", -180.0, true},
                                         Global{"from30W", -30.0, false}),
                         [](const auto& tested) { return tested.param.name; });

/// White noise, so that any difference in place or weights shows.
double noise(int column, int row) {
  const auto mixed = static_cast<std::uint32_t>(column) * 2654435761U ^ static_cast<std::uint32_t>(row) * 2246822519U;
  return static_cast<double>((mixed ^ (mixed >> 15U)) % 9000U);
}

TEST(ResampleHeights, GivesNeighboursTheSameEdgesToTheBit) {
  const MadeRaster raster({1440, 720, northUp(0, 90, 0.25), GDT_Float32},
                          [](int, int column, int row) { return noise(column, row); });
  const auto source = open({raster.path()});
  const GeodeticTiling tiling = earth();
  for (const int level : {2, 3, 5, 8}) {
    for (const double latitude : {-85.0, -3.0, 40.0, 88.0}) {
      for (const double longitude : {-179.99, -0.01, 60.0}) {
        const TileIndex index = tileAt(tiling, latitude, longitude, level);
        const HeightPixels own = heights(*source, tiling, index);
        for (const Edge edge : allEdges) {
          const auto beyond = tiling.neighbour(index, edge);
          if (!beyond || beyond->index.level != index.level || beyond->scale != 1.0) {
            continue;
          }
          const HeightPixels other = heights(*source, tiling, beyond->index);
          for (int i = 0; i < 129; ++i) {
            const auto along = [i](Edge side) {
              switch (side) {
                case Edge::West:
                  return at(heightLayout, 0, i);
                case Edge::East:
                  return at(heightLayout, 128, i);
                case Edge::North:
                  return at(heightLayout, i, 0);
                default:
                  return at(heightLayout, i, 128);
              }
            };
            ASSERT_EQ(own.metres[along(edge)], other.metres[along(beyond->edge)])
                << toString(index) << " and " << toString(beyond->index) << " at " << i;
          }
        }
      }
    }
  }
}

TEST(ResampleHeights, AreNoRidgesThatRunToThePole) {
  // As measured: rows and columns of half a degree, each pixel wrong by up to 50 m.
  constexpr double pixel = 0.5;
  const auto smooth = [](int column, int row) {
    return wave(-180.0 + pixel * (column + 0.5), 90.0 - pixel * (row + 0.5));
  };
  const MadeRaster raster({720, 360, northUp(-180, 90, pixel)}, [&](int, int column, int row) {
    return smooth(column, row) + ((column * 7919 + row * 104729) % 101 - 50.0);
  });
  const auto source = open({raster.path()});
  const GeodeticTiling tiling = earth();
  for (const double pole : {1.0, -1.0}) {
    for (const int level : {3, 5, 7}) {
      double steepest = 0.0;
      const TileIndex index = tileAt(tiling, pole * 89.9, 20.0, level);
      const HeightPixels pixels = heights(*source, tiling, index);
      for (int row = 1; row < 128; ++row) {
        for (int column = 0; column < 128; ++column) {
          const glm::dvec3 here = tiling.position(index, heightLayout.uv(column + 1, row + 1));
          const glm::dvec3 east = tiling.position(index, heightLayout.uv(column + 2, row + 1));
          const double latitude = tiling.geodetic(index, heightLayout.uv(column + 1, row + 1)).latitude;
          const double across = glm::distance(here, east);
          if (std::abs(latitude) > 80.0 * degree && across > 1.0) {
            const double rise =
                pixels.metres[at(heightLayout, column + 1, row)] - pixels.metres[at(heightLayout, column, row)];
            steepest = std::max(steepest, std::abs(rise) / across);
          }
        }
      }
      // Along a meridian 100 m of error within 55 km make 0.002; along the parallels it was up to 1.
      EXPECT_LT(steepest, 0.02) << pole << ' ' << level;
    }
  }
}

TEST(ResampleHeights, KeepColumnsApartFarFromThePoles) {
  const MadeRaster raster({720, 360, northUp(-180, 90, 0.5)}, [](int, int column, int) { return column % 2 * 100.0; });
  const auto source = open({raster.path()});
  const GeodeticTiling tiling = earth();
  const TileIndex index = tileAt(tiling, 68.0, 20.0, 8);
  const HeightPixels pixels = heights(*source, tiling, index);
  EXPECT_LT(pixels.minimum, 1.0F);
  EXPECT_GT(pixels.maximum, 99.0F);
}

TEST(ResampleHeights, MakesAPoleOnePoint) {
  const MadeRaster raster({1440, 720, northUp(0, 90, 0.25), GDT_Float32},
                          [](int, int column, int row) { return noise(column, row); });
  const auto source = open({raster.path()});
  const GeodeticTiling tiling = earth();
  const float west = heights(*source, tiling, tileAt(tiling, 89.9, -100, 4)).metres[at(heightLayout, 0, 0)];
  const HeightPixels east = heights(*source, tiling, tileAt(tiling, 89.9, 100, 4));
  for (int column = 0; column < 129; ++column) {
    EXPECT_EQ(east.metres[at(heightLayout, column, 0)], west);
  }
}

TEST(ResampleHeights, LeavesHolesAndKeepsTheirSurroundings) {
  // A hole of 40 x 40 pixels in a plane; without the nodata rule, -32768 would leak into its surroundings.
  const auto isHole = [](int column, int row) { return column >= 180 && column < 220 && row >= 130 && row < 170; };
  const MadeRaster raster(
      {400, 300, northUp(10, 50, 0.05)},
      [&](int, int column, int row) {
        return isHole(column, row) ? -32768.0 : plane(10 + 0.05 * (column + 0.5), 50 - 0.05 * (row + 0.5));
      },
      [](GDALDataset& dataset) { dataset.GetRasterBand(1)->SetNoDataValue(-32768); });
  const auto source = open({raster.path()});
  const GeodeticTiling tiling = earth();
  for (const int level : {6, 9}) {
    const TileIndex index = tileAt(tiling, 42.5, 19.02, level);
    const HeightPixels pixels = heights(*source, tiling, index);
    int absent = 0;
    for (int row = 0; row < 129; ++row) {
      for (int column = 0; column < 129; ++column) {
        const GeodeticPosition place = tiling.geodetic(index, heightLayout.uv(column + 1, row + 1));
        const double x = (place.longitude / degree - 10) / 0.05;
        const double y = (50 - place.latitude / degree) / 0.05;
        const float metres = pixels.metres[at(heightLayout, column, row)];
        if (x > 181 && x < 219 && y > 131 && y < 169) {
          ASSERT_TRUE(std::isnan(metres)) << x << ' ' << y;
          ++absent;
        } else if (x < 179 || x > 221 || y < 129 || y > 171) {
          ASSERT_NEAR(metres, plane(place.longitude / degree, place.latitude / degree), 0.6) << x << ' ' << y;
        }
        if (!std::isnan(metres)) {
          ASSERT_GT(metres, -1000.0F);
        }
      }
    }
    EXPECT_GT(absent, 100);
  }
}

TEST(ResampleColours, NeverAliases) {
  // The finest pattern there is; every coarse pixel must be the mean of black and white.
  const MadeRaster raster({2048, 1024, northUp(-180, 90, 360.0 / 2048), GDT_Byte, 3},
                          [](int, int column, int row) { return (column + row) % 2 == 0 ? 0.0 : 254.0; });
  const auto source = open({raster.path()});
  const GeodeticTiling tiling = earth();
  const ColourPixels pixels = colours(*source, tiling, TileIndex{0, 0, 0, 0}, {100, 2, Registration::PixelCentred});
  ASSERT_TRUE(pixels.allOpaque);
  for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
    ASSERT_NEAR(pixels.rgba[i], 127, 2);
  }
}

TEST(ResampleColours, TakesTheOverviewThatFits) {
  const MadeRaster raster(
      {2048, 1024, northUp(-180, 90, 360.0 / 2048), GDT_Byte}, [](int, int, int) { return 10.0; },
      [](GDALDataset& dataset) {
        std::array<int, 2> factors{2, 4};
        ASSERT_EQ(CE_None, dataset.BuildOverviews("NEAREST", 2, factors.data(), 0, nullptr, nullptr, nullptr));
        for (int i = 0; i < 2; ++i) {
          dataset.GetRasterBand(1)->GetOverview(i)->Fill(100.0 * (i + 1));
        }
      });
  const auto source = open({raster.path()});
  const GeodeticTiling tiling = earth();
  struct Case {
    int level;
    int value;
  };
  for (const auto& [level, value] : {Case{0, 200}, Case{1, 100}, Case{2, 10}, Case{5, 10}}) {
    const ColourPixels pixels =
        colours(*source, tiling, tileAt(tiling, 1, 1, level), {256, 0, Registration::PixelCentred});
    ASSERT_TRUE(pixels.allOpaque);
    EXPECT_EQ(pixels.rgba[4 * (128 * 256 + 128)], value) << level;
  }
}

TEST(ResampleColours, IsTransparentBeyondTheRaster) {
  const MadeRaster raster({100, 100, northUp(0.3, 10.2, 0.1), GDT_Byte, 3},
                          [](int band, int, int) { return 50.0 * (band + 1); });
  const auto source = open({raster.path()});
  const GeodeticTiling tiling = earth();
  const TileIndex index = tileAt(tiling, 5, 5, 3);
  const ColourPixels pixels = colours(*source, tiling, index);
  EXPECT_TRUE(pixels.anyOpaque);
  EXPECT_FALSE(pixels.allOpaque);
  for (int row = 0; row < pixels.size; ++row) {
    for (int column = 0; column < pixels.size; ++column) {
      const GeodeticPosition place = tiling.geodetic(index, colourLayout.uv(column, row));
      const bool inside = place.longitude > 0.3 * degree && place.longitude < 10.3 * degree &&
                          place.latitude > 0.2 * degree && place.latitude < 10.2 * degree;
      const std::uint8_t* pixel = pixels.rgba.data() + 4 * (row * pixels.size + column);
      ASSERT_EQ(pixel[3], inside ? 255 : 0);
      if (inside) {
        ASSERT_EQ(pixel[0], 50);
        ASSERT_EQ(pixel[1], 100);
        ASSERT_EQ(pixel[2], 150);
      }
    }
  }
  EXPECT_FALSE(source->overlaps(tiling, tileAt(tiling, 5, 60, 4)));
  EXPECT_FALSE(source->overlaps(tiling, tileAt(tiling, -60, 5, 4)));
  EXPECT_FALSE(colours(*source, tiling, tileAt(tiling, 5, 60, 4)).anyOpaque);
  EXPECT_FALSE(heights(*source, tiling, tileAt(tiling, 5, 60, 4)).any);
  EXPECT_TRUE(source->hasDataFiner(tiling, tileAt(tiling, 5, 5, 1), colourLayout));
  EXPECT_FALSE(source->hasDataFiner(tiling, tileAt(tiling, 5, 5, 3), colourLayout));
}

struct Typed {
  const char* name;
  GDALDataType type;
  double low;   // of the left half
  double high;  // of the right half
  int lowByte;
  int highByte;
};

class SampleTypes : public testing::TestWithParam<Typed> {};

TEST_P(SampleTypes, BecomeHeightsAsTheyAreAndColoursByTheirRange) {
  const Typed& typed = GetParam();
  const MadeRaster raster({64, 64, northUp(0, 10, 10.0 / 64), typed.type},
                          [&](int, int column, int) { return column < 32 ? typed.low : typed.high; });
  const auto source = open({raster.path()});
  const GeodeticTiling tiling = earth();
  const TileIndex west = tileAt(tiling, 5, 2, 9);
  const TileIndex east = tileAt(tiling, 5, 8, 9);
  EXPECT_EQ(heights(*source, tiling, west).maximum, static_cast<float>(typed.low));
  EXPECT_EQ(heights(*source, tiling, east).minimum, static_cast<float>(typed.high));
  EXPECT_EQ(colours(*source, tiling, west).rgba[0], typed.lowByte);
  EXPECT_EQ(colours(*source, tiling, east).rgba[0], typed.highByte);
}

INSTANTIATE_TEST_SUITE_P(
    All, SampleTypes,
    testing::Values(Typed{"UInt8", GDT_Byte, 3, 200, 3, 200}, Typed{"UInt16", GDT_UInt16, 257, 51400, 1, 200},
                    Typed{"Int16", GDT_Int16, -500, 8000, 0, 255}, Typed{"UInt32", GDT_UInt32, 70000, 90000, 0, 255},
                    Typed{"Int32", GDT_Int32, -70000, 90000, 0, 255}, Typed{"UInt64", GDT_UInt64, 1, 1e6, 0, 255},
                    Typed{"Int64", GDT_Int64, -5, 1e6, 0, 255}, Typed{"Float32", GDT_Float32, -0.25, 0.75, 0, 255},
                    Typed{"Float64", GDT_Float64, -0.25, 0.75, 0, 255}),
    [](const auto& tested) { return tested.param.name; });

TEST(ResampleColours, ReadsGreyAlphaAndPalettes) {
  const GeodeticTiling tiling = earth();
  const TileIndex index = tileAt(tiling, 5, 5, 9);
  const Made grey{64, 64, northUp(0, 10, 10.0 / 64), GDT_Byte, 2, "EPSG:4326", {"ALPHA=YES"}};
  const MadeRaster greyAlpha(grey, [](int band, int, int) { return band == 0 ? 90.0 : 128.0; });
  const ColourPixels half = colours(*open({greyAlpha.path()}), tiling, index);
  EXPECT_EQ(std::vector(half.rgba.begin(), half.rgba.begin() + 4), (std::vector<std::uint8_t>{90, 90, 90, 128}));

  const MadeRaster paletted(
      {64, 64, northUp(0, 10, 10.0 / 64), GDT_Byte, 1}, [](int, int, int) { return 7.0; },
      [](GDALDataset& dataset) {
        GDALColorTable table;
        const GDALColorEntry entry{10, 20, 30, 255};
        table.SetColorEntry(7, &entry);
        dataset.GetRasterBand(1)->SetColorTable(&table);
      });
  const ColourPixels colour = colours(*open({paletted.path()}), tiling, index);
  EXPECT_EQ(std::vector(colour.rgba.begin(), colour.rgba.begin() + 4), (std::vector<std::uint8_t>{10, 20, 30, 255}));
}

TEST(Resample, StopsWhenAsked) {
  const MadeRaster raster({64, 64, northUp(0, 10, 10.0 / 64)}, [](int, int, int) { return 1.0; });
  const auto source = open({raster.path()});
  std::stop_source stop;
  stop.request_stop();
  const GeodeticTiling tiling = earth();
  const auto pixels = resampleHeights(*source, tiling, tileAt(tiling, 5, 5, 9), heightLayout, stop.get_token());
  ASSERT_FALSE(pixels);
  EXPECT_EQ(pixels.error().what, "cancelled");
}

TEST(Resample, GivesEveryThreadTheSame) {
  const MadeRaster raster({1440, 720, northUp(0, 90, 0.25), GDT_Float32},
                          [](int, int column, int row) { return noise(column, row); });
  const auto source = open({raster.path()});
  const auto fresh = open({raster.path()});
  const GeodeticTiling tiling = earth();
  std::vector<std::vector<float>> results(4);
  std::vector<std::thread> threads;
  for (auto& result : results) {
    threads.emplace_back([&] {
      for (int level = 0; level < 6; ++level) {
        const HeightPixels pixels = heights(*source, tiling, tileAt(tiling, 30, 179, level));
        result.insert(result.end(), pixels.metres.begin(), pixels.metres.end());
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  std::vector<float> expected;
  for (int level = 0; level < 6; ++level) {
    const HeightPixels pixels = heights(*fresh, tiling, tileAt(tiling, 30, 179, level));
    expected.insert(expected.end(), pixels.metres.begin(), pixels.metres.end());
  }
  for (const auto& result : results) {
    EXPECT_EQ(result, expected);
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
