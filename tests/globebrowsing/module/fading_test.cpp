#include <gmock/gmock.h>

#include "globe_fixture.h"
#include "globebrowsing/surface/chunked_surface.h"

namespace meridian::globebrowsing {
namespace {

/// Layers whose opacities move: what is on the screen, and how much is composed for it.
class FadingTest : public GlobeTest {
 protected:
  using Picture = std::vector<std::uint8_t>;

  /// A globe whose colours are never 0 or 1, drawn with a program for every fade.
  RenderableGlobe& addFadingGlobe(std::vector<Value> colours, Fields groups = {}, Fields more = {}) {
    colours.insert(colours.begin(), fileLayer("Ground", wavy("ground.tif", 128, 90, 4)));
    groups.insert({"ColorLayers", listOf(std::move(colours))});
    RenderableGlobe& globe = addGlobe(std::move(groups), std::move(more));
    EXPECT_TRUE(settle());
    graphics_->programs().waitAll();
    EXPECT_TRUE(settle());
    return globe;
  }
  /// Smooth colours around `middle`, different in each band.
  std::string wavy(const std::string& name, double middle, double swing, int waves, int bands = 3) {
    return raster(
        name,
        [=](int band, double longitude, double latitude) {
          return middle + swing * std::sin(0.0175 * waves * (longitude + 30.0 * band)) * std::cos(0.0175 * latitude);
        },
        bands, GDT_Byte, 512);
  }
  static Layer& layer(RenderableGlobe& globe, const std::string& name, LayerGroupId group = LayerGroupId::ColorLayers) {
    return *globe.layers().group(group).find(name);
  }
  static CompositeStore& store(RenderableGlobe& globe) {
    return dynamic_cast<ChunkedSurface&>(*globe.surface()).tiles().composites();
  }

  Picture picture() const {
    Picture rgba(std::size_t{4} * width * height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return rgba;
  }
  static int greatestDifference(const Picture& a, const Picture& b) {
    int most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      most = std::max(most, std::abs(int{a[i]} - int{b[i]}));
    }
    return most;
  }
  /// Begins a fade downwards of that layer (one change is none) and goes on until it is drawn by mixing alone.
  void beginFade(RenderableGlobe& globe, Layer& layer, double opacity) {
    for (const double away : {0.02, 0.01, 0.0}) {
      layer.fade.put(opacity + away);
      ASSERT_TRUE(settle());
    }
    ASSERT_TRUE(store(globe).fading().has_value());
  }
  /// The picture of a globe that was composed at these settings, never faded.
  Picture composedAnew(RenderableGlobe& globe) {
    globe.deinitializeGraphics();
    EXPECT_TRUE(globe.initializeGraphics(*graphics_));
    EXPECT_TRUE(settle());
    EXPECT_FALSE(store(globe).fading().has_value());
    return picture();
  }
};

TEST_F(FadingTest, MixesInsteadOfComposing) {
  RenderableGlobe& globe = addFadingGlobe({fileLayer("Upper", wavy("u.tif", 150, 80, 9))});
  Layer& upper = layer(globe, "Upper");
  const Picture opaque = picture();
  beginFade(globe, upper, 0.9);
  const std::uint64_t composed = store(globe).composedCount();
  Picture last = picture();
  EXPECT_GT(greatestDifference(last, opaque), 5);
  for (double opacity = 0.85; opacity > 0.0; opacity -= 0.05) {
    upper.fade.put(opacity);
    frame();
    EXPECT_TRUE(unsettled().empty()) << unsettled();
    const Picture now = picture();
    EXPECT_GT(greatestDifference(now, last), 1) << "each frame shows its own opacity";
    EXPECT_LT(greatestDifference(now, last), 25) << "without a jump";
    last = now;
  }
  EXPECT_EQ(store(globe).composedCount(), composed);
  upper.fade.put(0.0);
  frame();
  EXPECT_LT(greatestDifference(picture(), last), 25);
  for (std::uint64_t n = 0; n < 3 * FadeWatch::restFrames; ++n) {
    frame();
  }
  EXPECT_EQ(store(globe).composedCount(), composed) << "what was mixed in last remains";
  EXPECT_FALSE(store(globe).fading().has_value());
  EXPECT_LE(greatestDifference(picture(), composedAnew(globe)), 1);
}

TEST_F(FadingTest, ShowsWhatComposingWould) {
  struct Case {
    const char* mode;
    const char* above;
    const char* group;
  };
  for (const Case& c : {Case{"Normal", "Normal", "ColorLayers"}, Case{"Multiply", "MultiplyMix", "ColorLayers"},
                        Case{"MultiplyMix", "Multiply", "ColorLayers"}, Case{"Color", "Normal", "ColorLayers"},
                        Case{"Normal", "Multiply", "Overlays"}, Case{"Multiply", "Normal", "NightLayers"}}) {
    const std::string what = std::string(c.mode) + " below " + c.above + " in " + c.group;
    const std::vector<Value> upper{
        fileLayer("Below", wavy("b.tif", 120, 60, 3, 4)),
        fileLayer("Fading", wavy("f.tif", 150, 80, 9, 4), {{"BlendMode", c.mode}}),
        fileLayer("Above", wavy("a.tif", 100, 70, 5, 4), {{"BlendMode", c.above}, {"Opacity", 0.6}})};
    const bool isGround = std::string_view(c.group) == "ColorLayers";
    const bool isNight = std::string_view(c.group) == "NightLayers";
    RenderableGlobe& globe =
        addFadingGlobe(isGround ? upper : std::vector<Value>{}, isGround ? Fields{} : Fields{{c.group, listOf(upper)}},
                       {{"PerformShading", isNight}});
    if (isNight) {
      view_.lightDirection = -view_.lightDirection;
      ASSERT_TRUE(settle());
      graphics_->programs().waitAll();
    }
    Layer& fading = layer(globe, "Fading", layerGroupFromName(c.group)->group);
    beginFade(globe, fading, 0.8);
    for (const double opacity : {0.73, 0.4, 0.11}) {
      fading.fade.put(opacity);
      const std::uint64_t composed = store(globe).composedCount();
      frame();
      const Picture mixed = picture();
      EXPECT_EQ(store(globe).composedCount(), composed) << what;
      const Picture expected = composedAnew(globe);
      EXPECT_LE(greatestDifference(mixed, expected), 2) << what << " at " << opacity;
      fading.fade.put(opacity - 0.03);
      beginFade(globe, fading, opacity - 0.05);
    }
    removeGlobes();
    look(0.1, 0.2, 1.5e7);
  }
}

TEST_F(FadingTest, ComposesWhereMixingIsNotExact) {
  RenderableGlobe& globe = addFadingGlobe({fileLayer("Add", wavy("u.tif", 150, 80, 9), {{"BlendMode", "Add"}})});
  Layer& add = layer(globe, "Add");
  for (const double opacity : {0.8, 0.7, 0.6, 0.5}) {
    add.opacity.put(opacity);
    ASSERT_TRUE(settle());
    EXPECT_FALSE(store(globe).fading().has_value());
  }
  EXPECT_LE(greatestDifference(picture(), composedAnew(globe)), 1);
}

TEST_F(FadingTest, TurnsAroundMidway) {
  RenderableGlobe& globe = addFadingGlobe({fileLayer("Upper", wavy("u.tif", 150, 80, 9))});
  Layer& upper = layer(globe, "Upper");
  Picture last = picture();
  double opacity = 1.0;
  double step = -0.02;
  for (int n = 0; n < 400; ++n) {
    if (n == 60 || n == 130 || n == 170) {
      step = -step;
    }
    opacity = std::clamp(opacity + step, 0.0, 1.0);
    upper.opacity.put(opacity);
    ASSERT_TRUE(settle());
    const Picture now = picture();
    EXPECT_LT(greatestDifference(now, last), 12) << "in step " << n;
    last = now;
  }
  EXPECT_LE(greatestDifference(picture(), composedAnew(globe)), 1);
}

TEST_F(FadingTest, EndsAnywhereWithoutAJump) {
  RenderableGlobe& globe = addFadingGlobe({fileLayer("Upper", wavy("u.tif", 150, 80, 9))});
  beginFade(globe, layer(globe, "Upper"), 0.4);
  const Picture mixed = picture();
  for (std::uint64_t n = 0; n < 8 * FadeWatch::restFrames; ++n) {
    frame();
    EXPECT_LE(greatestDifference(picture(), mixed), 2) << "in frame " << n;
  }
  EXPECT_FALSE(store(globe).fading().has_value()) << "one composite is enough again";
}

TEST_F(FadingTest, FadesInALayerThatIsEnabledAndOutOneThatIsThenDisabled) {
  RenderableGlobe& globe = addFadingGlobe({fileLayer("Upper", wavy("u.tif", 150, 80, 9), {{"Enabled", false}})});
  Layer& upper = layer(globe, "Upper");
  const Picture without = picture();
  upper.fade.put(0.0);
  upper.enabled.put(true);
  ASSERT_TRUE(settle());
  const std::uint64_t composed = store(globe).composedCount();
  const std::uint64_t tiles = composed;
  EXPECT_LE(greatestDifference(picture(), without), 0);
  for (int n = 1; n <= 50; ++n) {
    upper.fade.put(n / 50.0);
    frame();
  }
  ASSERT_TRUE(settle());
  const std::uint64_t fadedIn = store(globe).composedCount();
  EXPECT_GT(greatestDifference(picture(), without), 50);
  for (int n = 49; n >= 0; --n) {
    upper.fade.put(n / 50.0);
    frame();
  }
  ASSERT_TRUE(settle());
  upper.enabled.put(false);
  ASSERT_TRUE(settle());
  EXPECT_LE(greatestDifference(picture(), without), 0);
  EXPECT_GT(fadedIn, composed);
  // Each of the few tiles once for the first step, which might have been the only one, and once for either end.
  EXPECT_LE(store(globe).composedCount(), composed + 3 * tiles);
}

TEST_F(FadingTest, SeveralLayersAtOnceAreComposed) {
  RenderableGlobe& globe =
      addFadingGlobe({fileLayer("A", wavy("u.tif", 150, 80, 9)), fileLayer("B", wavy("v.tif", 100, 80, 5))},
                     {{"Overlays", listOf({solidLayer("O", {0.2, 0.4, 0.6}, {{"Opacity", 0.5}})})}});
  Layer& a = layer(globe, "A");
  Layer& b = layer(globe, "B");
  Layer& o = layer(globe, "O", LayerGroupId::Overlays);
  Picture last = picture();
  for (int n = 1; n <= 20; ++n) {
    a.fade.put(1.0 - n / 40.0);
    if (n > 5) {
      b.fade.put(1.0 - (n - 5) / 40.0);
    }
    if (n > 10) {
      o.fade.put(1.0 - (n - 10) / 20.0);
    }
    ASSERT_TRUE(settle());
    const Picture now = picture();
    EXPECT_LT(greatestDifference(now, last), 25) << n;
    last = now;
  }
  EXPECT_LE(greatestDifference(picture(), composedAnew(globe)), 2);
}

TEST_F(FadingTest, GoesOnWithoutRoomForSecondComposites) {
  setModuleProperty("TexturePoolSize", 64);
  look(0.1, 0.2, 6.6e6);
  RenderableGlobe& globe =
      addFadingGlobe({fileLayer("Detail", raster(
                                              "d.tif",
                                              [](int band, double longitude, double latitude) {
                                                return 100.0 + 20 * band + 0.1 * longitude + 0.2 * latitude;
                                              },
                                              3, GDT_Byte, 8192))});
  Layer& detail = layer(globe, "Detail");
  for (int n = 1; n <= 20; ++n) {
    detail.opacity.put(1.0 - n / 40.0);
    frame();
    EXPECT_NE(centre(), (Pixel{0, 0, 0}));
  }
  ASSERT_TRUE(settle());
  EXPECT_LE(greatestDifference(picture(), composedAnew(globe)), 3);
}

TEST_F(FadingTest, ALayerIsRemovedWhileItFades) {
  RenderableGlobe& globe = addFadingGlobe({fileLayer("Upper", wavy("u.tif", 150, 80, 9))});
  beginFade(globe, layer(globe, "Upper"), 0.5);
  ASSERT_TRUE(globe.layers().deleteLayer("ColorLayers", "Upper"));
  ASSERT_TRUE(settle());
  EXPECT_LE(greatestDifference(picture(), composedAnew(globe)), 1);
  const ProviderRequest again{fileLayer("Upper", wavy("v.tif", 100, 50, 4)), "test", "Layer", folder_.string()};
  ASSERT_TRUE(globe.layers().addLayer("ColorLayers", again));
  ASSERT_TRUE(settle());
  beginFade(globe, layer(globe, "Upper"), 0.5);
  layer(globe, "Upper").gamma.put(1.5);
  layer(globe, "Ground").opacity.put(0.5);
  ASSERT_TRUE(settle());
  EXPECT_LE(greatestDifference(picture(), composedAnew(globe)), 1);
}

TEST_F(FadingTest, TheCameraMovesWhileALayerFades) {
  RenderableGlobe& globe = addFadingGlobe({fileLayer("Upper", wavy("u.tif", 150, 80, 9))});
  Layer& upper = layer(globe, "Upper");
  for (int n = 0; n < 40; ++n) {
    look(0.1 + 0.01 * n, 0.2 + 0.03 * n, 1.5e7 - 1.5e5 * n);
    upper.fade.put(1.0 - 0.02 * n);
    frame();
    EXPECT_NE(centre(), (Pixel{0, 0, 0}));
  }
  ASSERT_TRUE(settle());
  EXPECT_LE(greatestDifference(picture(), composedAnew(globe)), 2);
}

TEST_F(FadingTest, TimeGoesOnWhileALayerFades) {
  std::filesystem::create_directory(folder_ / "M");
  for (int month = 1; month <= 9; ++month) {
    uniformRaster("M/m2004-0" + std::to_string(month) + ".tif", {20 * month, 100, 200 - 20 * month});
  }
  const Value monthly = tableOf({{"Identifier", "M"},
                                 {"Enabled", true},
                                 {"Type", "TemporalTileProvider"},
                                 {"Mode", "Folder"},
                                 {"Folder", tableOf({{"Folder", "M"}, {"Format", "m%Y-%m"}})}});
  const auto dayOf = [](int month) { return *Time::fromUtc("2004-0" + std::to_string(month) + "-10"); };
  time_ = dayOf(1);
  RenderableGlobe& globe = addFadingGlobe({monthly});
  Layer& layer = this->layer(globe, "M");
  for (int n = 1; n <= 80; ++n) {
    time_ = dayOf(1 + n / 10);
    layer.fade.put(1.0 - n / 100.0);
    frame();
    EXPECT_NE(centre(), (Pixel{0, 0, 0}));
    EXPECT_NE(centre(), (Pixel{76, 76, 76}));
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ASSERT_TRUE(settle());
  EXPECT_LE(greatestDifference(picture(), composedAnew(globe)), 2);
}

}  // namespace
}  // namespace meridian::globebrowsing
