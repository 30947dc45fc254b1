// Layers between two steps in time: what is on the screen, and how much is composed for it.
#include <fstream>

#include <gmock/gmock.h>

#include "globe_fixture.h"
#include "globebrowsing/surface/chunked_surface.h"

namespace meridian::globebrowsing {
namespace {

class InterpolationTest : public GlobeTest {
 protected:
  static constexpr int maps = 9;
  static constexpr double secondsADay = 86400.0;

  /// One map for each of the first days of 2004, each of a colour of its own.
  Value daily(const std::string& identifier, Fields more = {}, int columns = 256) {
    std::filesystem::create_directory(folder_ / identifier);
    for (int i = 0; i < maps; ++i) {
      uniformRaster(identifier + "/d" + nameOf(i) + ".tif", colourOf(i), columns);
    }
    return series(identifier, std::move(more));
  }
  static Value series(const std::string& identifier, Fields more) {
    more.insert({{"Identifier", identifier},
                 {"Enabled", true},
                 {"Type", "TemporalTileProvider"},
                 {"Mode", "Folder"},
                 {"Interpolation", true},
                 {"Folder", tableOf({{"Folder", identifier}, {"Format", "d%Y-%m-%d"}})}});
    return tableOf(std::move(more));
  }
  static std::string nameOf(int i) { return "2004-01-0" + std::to_string(i + 1); }
  /// Red grows from day to day, green falls.
  static Pixel colourOf(int i) { return {10 + 25 * i, 240 - 20 * i, 90}; }
  static Time at(double days) { return *Time::fromUtc("2004-01-01") + days * secondsADay; }
  /// Of a globe that shows a mixture of the two days about that time.
  static Pixel mixtureAt(double days) {
    const int i = static_cast<int>(days);
    return mixture(colourOf(i), colourOf(i + 1), days - i);
  }
  static Pixel mixture(const Pixel& a, const Pixel& b, double weight) {
    Pixel mixed{};
    for (std::size_t band = 0; band < 3; ++band) {
      mixed[band] = static_cast<int>(std::lround(std::lerp(a[band], b[band], weight)));
    }
    return mixed;
  }
  static int difference(const Pixel& a, const Pixel& b) {
    return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
  }
  /// How much the globe's colours differ from one place to another.
  int spread() const {
    std::vector<std::uint8_t> rgba(std::size_t{4} * width * height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    Pixel least{255, 255, 255};
    Pixel most{0, 0, 0};
    constexpr double surelyGlobe = 60.0;  // pixels from the middle
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        if (std::hypot(x - width / 2, y - height / 2) > surelyGlobe) {
          continue;
        }
        const std::uint8_t* p = &rgba[4 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x))];
        for (std::size_t band = 0; band < 3; ++band) {
          least[band] = std::min<int>(least[band], p[band]);
          most[band] = std::max<int>(most[band], p[band]);
        }
      }
    }
    return difference(least, most);
  }
  RenderableGlobe& addReadyGlobe(Fields groups) {
    RenderableGlobe& globe = addGlobe(std::move(groups));
    EXPECT_TRUE(settle());
    graphics_->programs().waitAll();
    EXPECT_TRUE(settle());
    return globe;
  }
  static CompositeStore& store(RenderableGlobe& globe) {
    return dynamic_cast<ChunkedSurface&>(*globe.surface()).tiles().composites();
  }
  static Layer& layer(RenderableGlobe& globe, const std::string& name) {
    return *globe.layers().group(LayerGroupId::ColorLayers).find(name);
  }
  static void setInterpolation(RenderableGlobe& globe, bool on) {
    ASSERT_TRUE(globe.layers().propertyAt("ColorLayers.D.TileProvider.Interpolation")->set(on));
  }
  void expectAt(double days, const Pixel& expected, int tolerance = 1) {
    time_ = at(days);
    ASSERT_TRUE(settle()) << "at day " << days;
    EXPECT_LE(difference(centre(), expected), tolerance)
        << "at day " << days << ": " << centre()[0] << ' ' << centre()[1] << ", not " << expected[0] << ' '
        << expected[1];
    EXPECT_LE(spread(), 1);
  }
};

TEST_F(InterpolationTest, ShowsTheMixtureOfTwoSteps) {
  time_ = at(0.5);
  RenderableGlobe& globe = addReadyGlobe({{"ColorLayers", listOf({daily("D")})}});
  for (const double days : {0.5, 0.25, 0.75, 1.0, 1.25, 3.4, 3.9, 3.1, 2.9, 0.1, 7.99}) {
    expectAt(days, mixtureAt(days));
  }
  expectAt(-3.0, colourOf(0));
  expectAt(20.0, colourOf(maps - 1));
  EXPECT_EQ(layer(globe, "D").lastError.get(), "");
}

TEST_F(InterpolationTest, TheFirstPictureOffScreenIsMixed) {
  time_ = at(0.5);
  addReadyGlobe({{"ColorLayers", listOf({daily("D", {}, 1024)})}});
  // Again, with the programs there before the data.
  removeGlobes();
  addGlobe({{"ColorLayers", listOf({series("D", {})})}});
  ASSERT_TRUE(framesUntil([&] { return unsettled().empty(); }, false)) << unsettled();
  frame();
  EXPECT_EQ(unsettled(), "");
  EXPECT_LE(difference(centre(), mixtureAt(0.5)), 1);
}

TEST_F(InterpolationTest, GoesOnSmoothlyForwardsAndBackwards) {
  time_ = at(0.0);
  addReadyGlobe({{"ColorLayers", listOf({daily("D")})}});
  Pixel last = centre();
  for (int n = 1; n <= 2 * 80; ++n) {
    const int direction = n <= 80 ? 1 : -1;
    const double days = (n <= 80 ? n : 160 - n) * 0.05;
    expectAt(days, mixtureAt(days));
    const Pixel now = centre();
    EXPECT_GE(direction * (now[0] - last[0]), 0) << "at day " << days;
    EXPECT_LE(direction * (now[1] - last[1]), 0) << "at day " << days;
    EXPECT_LE(difference(now, last), 3) << "a jump at day " << days;
    last = now;
  }
}

TEST_F(InterpolationTest, PlaysWithoutABlankOrAStepBack) {
  for (const double perFrame : {0.02, 0.3, -0.02, -0.3}) {
    time_ = at(perFrame > 0.0 ? 0.0 : 8.0);
    addReadyGlobe({{"ColorLayers", listOf({daily("D")})}});
    Pixel last = centre();
    for (int n = 0; n < 8.0 / std::abs(perFrame); ++n) {
      time_ = time_ + perFrame * secondsADay;
      frame();
      const Pixel now = centre();
      ASSERT_LE(spread(), 1) << "in frame " << n;
      ASSERT_GE((perFrame > 0.0 ? 1 : -1) * (now[0] - last[0]), 0) << "in frame " << n << " at " << perFrame;
      ASSERT_EQ(now[2], colourOf(0)[2]);
      last = now;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(settle());
    removeGlobes();
  }
}

TEST_F(InterpolationTest, ComposesForEachStepAndNotForEachFrame) {
  time_ = at(0.1);
  RenderableGlobe& globe = addReadyGlobe({{"ColorLayers", listOf({daily("D")})}});
  const std::uint64_t begun = store(globe).composedCount();
  for (int n = 0; n < 80; ++n) {
    time_ = at(0.1 + n * 0.01);
    frame();
    EXPECT_EQ(unsettled(), "");
  }
  EXPECT_EQ(store(globe).composedCount(), begun) << "within a step";
  const std::uint64_t tiles = begun / 2;  // of either step
  for (int n = 0; n < 60; ++n) {
    expectAt(1.0 + n * 0.1, mixtureAt(1.0 + n * 0.1));
  }
  // To day 6.9: the steps of days 2 to 7.
  EXPECT_LE(store(globe).composedCount() - begun, 7 * (tiles + 4));
  // A layer that was slow to open lets the roots be composed once without it.
  EXPECT_GE(store(globe).composedCount() - begun, 6 * (tiles - 2));
}

TEST_F(InterpolationTest, IsSwitchedOffAndOn) {
  time_ = at(0.5);
  RenderableGlobe& globe = addReadyGlobe({{"ColorLayers", listOf({daily("D")})}});
  setInterpolation(globe, false);
  expectAt(0.6, colourOf(0));
  expectAt(1.3, colourOf(1));
  EXPECT_FALSE(store(globe).fading().has_value()) << "one composite is enough";
  setInterpolation(globe, true);
  expectAt(1.3, mixtureAt(1.3));
  expectAt(0.7, mixtureAt(0.7));
  setInterpolation(globe, false);
  expectAt(0.7, colourOf(0));
  time_ = at(0.7);
  for (int n = 0; n < 100; ++n) {
    time_ = time_ + 0.05 * secondsADay;
    setInterpolation(globe, n / 7 % 2 == 0);
    frame();
    ASSERT_LE(spread(), 1) << "in frame " << n;
    ASSERT_EQ(centre()[2], colourOf(0)[2]) << "in frame " << n;
  }
  setInterpolation(globe, true);
  expectAt(5.2, mixtureAt(5.2));
}

TEST_F(InterpolationTest, TheNextStepIsNeverThere) {
  time_ = at(0.5);
  RenderableGlobe& globe =
      addGlobe({{"ColorLayers", listOf({fileLayer("Below", uniformRaster("b.tif", {1, 2, 3})), daily("D")})}});
  std::ofstream(folder_ / "D/d2004-01-03.tif") << "damaged";
  expectAt(0.5, mixtureAt(0.5));
  for (const double days : {1.0, 1.5, 1.9}) {
    expectAt(days, colourOf(1));
  }
  EXPECT_EQ(layer(globe, "D").lastError.get(), "");
  expectAt(2.5, {1, 2, 3});
  EXPECT_THAT(layer(globe, "D").lastError.get(), testing::HasSubstr("d2004-01-03.tif"));
  expectAt(3.25, mixtureAt(3.25));
  expectAt(1.25, colourOf(1));
}

TEST_F(InterpolationTest, ALayerFadesMeanwhile) {
  time_ = at(0.5);
  const Pixel ground{40, 120, 200};
  RenderableGlobe& globe =
      addReadyGlobe({{"ColorLayers", listOf({fileLayer("Ground", uniformRaster("g.tif", ground)), daily("D")})},
                     {"Overlays", listOf({solidLayer("O", {0.0, 0.0, 0.0}, {{"Opacity", 0.0}})})}});
  Layer& fading = layer(globe, "D");
  for (int n = 0; n <= 50; ++n) {
    const double opacity = 1.0 - n / 50.0;
    fading.fade.put(opacity);
    const double days = 0.5 + n * 0.02;
    expectAt(days, mixture(ground, mixtureAt(days), opacity), 2);
  }
  fading.fade.put(1.0);
  Layer& overlay = *globe.layers().group(LayerGroupId::Overlays).find("O");
  for (int n = 0; n <= 10; ++n) {
    overlay.opacity.put(n / 20.0);
    expectAt(2.25, mixture(mixtureAt(2.25), {0, 0, 0}, n / 20.0), 2);
  }
}

TEST_F(InterpolationTest, BeginsWhenAFadeIsOver) {
  time_ = at(0.5);
  const Pixel ground{40, 120, 200};
  RenderableGlobe& globe = addReadyGlobe({{"ColorLayers", listOf({fileLayer("Ground", uniformRaster("g.tif", ground)),
                                                                  daily("D", {{"Interpolation", false}})})}});
  for (const double opacity : {0.8, 0.7, 0.6, 0.5}) {
    layer(globe, "D").opacity.put(opacity);
    expectAt(0.5, mixture(ground, colourOf(0), opacity), 2);
  }
  ASSERT_TRUE(store(globe).fading().has_value());
  setInterpolation(globe, true);
  ASSERT_TRUE(framesUntil([&] { return difference(centre(), mixture(ground, mixtureAt(0.5), 0.5)) <= 2; }));
}

TEST_F(InterpolationTest, ShowsOneStepWhereMixingIsNotExact) {
  time_ = at(0.5);
  RenderableGlobe& globe = addReadyGlobe(
      {{"ColorLayers",
        listOf({daily("D"), fileLayer("Add", uniformRaster("a.tif", {5, 5, 5}), {{"BlendMode", "Add"}})})}});
  const Pixel first = colourOf(0);
  expectAt(0.5, {first[0] + 5, first[1] + 5, first[2] + 5});
  ASSERT_TRUE(globe.layers().deleteLayer("ColorLayers", "Add"));
  expectAt(0.5, mixtureAt(0.5));
}

TEST_F(InterpolationTest, OtherLayersComeGoAndPlayMeanwhile) {
  time_ = at(0.25);
  // Half of it is seen, with steps of its own: twelve hours after those of the interpolated layer.
  std::filesystem::create_directory(folder_ / "P");
  for (int i = 0; i < maps; ++i) {
    uniformRaster("P/d" + nameOf(i) + "T12.tif", {20 * i, 200, 20 * i});
  }
  const Value plain = tableOf({{"Identifier", "P"},
                               {"Enabled", true},
                               {"Opacity", 0.5},
                               {"Type", "TemporalTileProvider"},
                               {"Mode", "Folder"},
                               {"Folder", tableOf({{"Folder", "P"}, {"Format", "d%Y-%m-%dT%H"}})}});
  RenderableGlobe& globe = addReadyGlobe({{"ColorLayers", listOf({daily("D")})}});
  expectAt(0.25, mixtureAt(0.25));
  const auto expected = [](double days) {
    const int step = std::max(static_cast<int>(std::floor(days - 0.5)), 0);
    return mixture(mixtureAt(days), {20 * step, 200, 20 * step}, 0.5);
  };
  ASSERT_TRUE(globe.layers().addLayer("ColorLayers", {plain, "test", "Layer", folder_.string()}));
  for (int n = 0; n < 30; ++n) {
    const double days = 0.25 + 0.1 * n;
    const Pixel before = centre();
    time_ = at(days);
    ASSERT_TRUE(settle([&] {
      if (n > 0) {
        EXPECT_LE(difference(centre(), before), 14) << "at day " << days;
      }
    }));
    expectAt(days, expected(days), 2);
  }
  ASSERT_TRUE(globe.layers().deleteLayer("ColorLayers", "P"));
  expectAt(3.2, mixtureAt(3.2));
}

TEST_F(InterpolationTest, LayersOfTheSameStepsAreInterpolatedTogether) {
  time_ = at(0.25);
  const Value below = daily("D");
  std::filesystem::create_directory(folder_ / "E");
  const auto colour = [](int i) { return Pixel{100, 10 + 20 * i, 200}; };
  for (int i = 0; i < maps; ++i) {
    uniformRaster("E/d" + nameOf(i) + ".tif", colour(i));
  }
  addReadyGlobe({{"ColorLayers", listOf({below, series("E", {{"Opacity", 0.5}})})}});
  for (const double days : {0.25, 1.5, 1.25, 0.75}) {
    const int i = static_cast<int>(days);
    expectAt(days, mixture(mixtureAt(days), mixture(colour(i), colour(i + 1), days - i), 0.5), 2);
  }
}

TEST_F(InterpolationTest, TheCameraMovesMeanwhile) {
  time_ = at(0.0);
  addReadyGlobe({{"ColorLayers", listOf({daily("D", {}, 1024)})}});
  Pixel last = centre();
  for (int n = 0; n < 100; ++n) {
    const double t = n / 100.0;
    time_ = at(6.0 * t);
    look(0.1 + 0.5 * t, 0.2 + 1.5 * t, 1.5e7 - 6e6 * t);
    frame();
    ASSERT_LE(spread(), 1) << "two times at once in frame " << n;
    ASSERT_GE(centre()[0], last[0]) << "back in frame " << n;
    last = centre();
  }
  expectAt(6.25, mixtureAt(6.25));
}

TEST_F(InterpolationTest, GoesOnWithoutRoomForTwoTimes) {
  setModuleProperty("TexturePoolSize", 64);
  time_ = at(0.5);
  look(0.1, 0.2, 1.2e7);
  std::filesystem::create_directory(folder_ / "D");
  for (int i = 0; i < 3; ++i) {
    uniformRaster("D/d" + nameOf(i) + ".tif", colourOf(i), 4096);
  }
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({series("D", {})})}}, {{"TargetLodScaleFactor", 20.0}});
  ASSERT_TRUE(settle());
  EXPECT_FALSE(store(globe).fading().has_value()) << "there is room";
  for (int n = 0; n <= 12; ++n) {
    time_ = at(0.5 + 0.1 * n);
    ASSERT_TRUE(settle([&] { EXPECT_NE(centre(), (Pixel{0, 0, 0})); }));
    EXPECT_GE(centre()[0], colourOf(0)[0]);
    EXPECT_LE(centre()[0], colourOf(2)[0]);
  }
}

TEST_F(InterpolationTest, ColoursByAColormap) {
  time_ = at(0.5);
  // From black to yellow: red and green as the value, blue none.
  raster(
      "map.tif",
      [](int band, double longitude, double) { return band == 2 ? 0.0 : (longitude + 180.0) / 360.0 * 256.0; }, 3,
      GDT_Byte, 256);
  RenderableGlobe& globe = addReadyGlobe({{"ColorLayers", listOf({daily("D", {{"Colormap", "map.tif"}})})}});
  for (const double days : {0.25, 2.5}) {
    const int value = mixtureAt(days)[0];
    expectAt(days, {value, value, 0}, 2);
  }
  setInterpolation(globe, false);
  expectAt(2.5, {colourOf(2)[0], colourOf(2)[0], 0});
}

}  // namespace
}  // namespace meridian::globebrowsing
