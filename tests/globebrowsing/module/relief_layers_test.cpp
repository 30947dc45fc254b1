#include <gmock/gmock.h>

#include "globe_fixture.h"

namespace meridian::globebrowsing {
namespace {

using ReliefLayersTest = GlobeTest;

testing::Matcher<const std::array<int, 3>&> colour(int red, int green, int blue) {
  using testing::AllOf;
  using testing::Ge;
  using testing::Le;
  return testing::ElementsAre(AllOf(Ge(red - 2), Le(red + 2)), AllOf(Ge(green - 2), Le(green + 2)),
                              AllOf(Ge(blue - 2), Le(blue + 2)));
}

Value reliefLayer(const std::string& type, Fields more = {}) {
  more.insert({{"Identifier", type}, {"Type", type}, {"Enabled", true}});
  return tableOf(std::move(more));
}

/// Below the layer.
void set(Layer& layer, const char* property, const Value& value) {
  const Result<void> done = layer.propertyAt(property)->set(value);
  EXPECT_TRUE(done) << (done ? "" : done.error().message());
}

TEST_F(ReliefLayersTest, ARampFollowsItsPropertiesAndTheHeightLayers) {
  const auto level = [this](const char* name, double metres) {
    return raster(
        name, [metres](int, double, double) { return metres; }, 1, GDT_Float32, 64);
  };
  RenderableGlobe& globe =
      addGlobe({{"ColorLayers", listOf({reliefLayer("ColorRelief", {{"ColorRamp", "0 0 0 0; 1000 200 100 0"}})})},
                {"HeightLayers", listOf({fileLayer("A", level("a.tif", 500.0)),
                                         fileLayer("B", level("b.tif", 1000.0), {{"Enabled", false}})})}});
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(100, 50, 0));
  frame();
  graphics_->programs().waitAll();  // those that fading will need, too
  const auto built = statistics_.programs.built.load();
  Layer& ramp = *globe.layers().group(LayerGroupId::ColorLayers).find("ColorRelief");
  LayerGroup& heights = globe.layers().group(LayerGroupId::HeightLayers);

  heights.find("A")->multiplier.put(0.5);
  ASSERT_TRUE(settle([&] { EXPECT_THAT(centre(), testing::AnyOf(colour(100, 50, 0), colour(50, 25, 0))); }));
  EXPECT_THAT(centre(), colour(50, 25, 0)) << "a height layer's settings";
  heights.find("B")->enabled.put(true);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(200, 100, 0)) << "the layer on top";
  heights.find("B")->opacity.put(0.5);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(125, 62, 0)) << "half of 1000 and half of 250";
  heights.find("A")->enabled.put(false);
  heights.find("B")->enabled.put(false);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(0, 0, 0)) << "the ellipsoid";

  set(ramp, "TileProvider.ColorRamp", "0% 10 20 30; 100% 110 120 130");
  set(ramp, "TileProvider.Range", Value(glm::dvec2(-100.0, 100.0)));
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(60, 70, 80)) << "in the middle of its range";
  set(ramp, "TileProvider.ColorRamp", "0 mauve");
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(60, 70, 80));
  EXPECT_NE(ramp.lastError.get().find("mauve"), std::string::npos);
  EXPECT_EQ(statistics_.programs.built.load(), built) << "none of this needs another program";
}

TEST_F(ReliefLayersTest, HillshadeAndSlopeFollowTheirProperties) {
  // Rising to the east by a tenth, as steep as 5.71 degrees, where the camera looks.
  const std::string slope = raster(
      "slope.tif",
      [](int, double longitude, double) {
        return 0.1 * radius * std::clamp(longitude, -30.0, 60.0) * 0.017453292519943295;
      },
      1, GDT_Float32, 512);
  RenderableGlobe& globe =
      addGlobe({{"ColorLayers", listOf({reliefLayer("Hillshade", {{"Azimuth", 270.0}, {"Altitude", 45.0}}),
                                        reliefLayer("Slope", {{"Enabled", false}})})},
                {"HeightLayers", listOf({fileLayer("Slope", slope)})}});
  look(0.0, 0.2, 1.5e7);
  ASSERT_TRUE(settle());
  const double steep = std::atan(0.1);
  const auto grey = [](double value) {
    const int level = static_cast<int>(std::lround(1.0 + 254.0 * value));
    return colour(level, level, level);
  };
  EXPECT_THAT(centre(), grey(std::sin(0.25 * M_PI + steep))) << "lit from the west, where it looks";
  Layer& hillshade = *globe.layers().group(LayerGroupId::ColorLayers).find("Hillshade");
  set(hillshade, "TileProvider.Azimuth", 90.0);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), grey(std::sin(0.25 * M_PI - steep)));
  set(hillshade, "TileProvider.ZFactor", 20.0);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), grey(0.0)) << "in its own shadow";
  hillshade.blendMode.put(static_cast<int>(BlendMode::Normal));
  hillshade.enabled.put(false);
  Layer& ramp = *globe.layers().group(LayerGroupId::ColorLayers).find("Slope");
  ramp.enabled.put(true);
  set(ramp, "TileProvider.ColorRamp", "0% 0 0 0; 100% 250 0 250");
  set(ramp, "TileProvider.Range", Value(glm::dvec2(0.0, 10.0)));
  ASSERT_TRUE(settle());
  const int shown = static_cast<int>(std::lround(250.0 * steep / (10.0 * M_PI / 180.0)));
  EXPECT_THAT(centre(), colour(shown, 0, shown));
}

TEST_F(ReliefLayersTest, IsolinesLieOverColoursAndFollowTheirInterval) {
  const std::string slope = raster(
      "slope.tif", [](int, double longitude, double) { return 1000.0 * std::clamp(longitude, -30.0, 60.0); }, 1,
      GDT_Float32, 512);
  const Value lines = reliefLayer("Isolines", {{"Interval", 20'000.0}, {"LineWidth", 8.0}});
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({solidLayer("Red", {1, 0, 0})})},
                                     {"Overlays", listOf({lines})},
                                     {"HeightLayers", listOf({fileLayer("Slope", slope)})}});
  const double degree = M_PI / 180.0;
  look(0.0, 20.0 * degree, 1.5e7);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(0, 0, 0)) << "at 20 km";
  look(0.0, 30.0 * degree, 1.5e7);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(255, 0, 0)) << "between 20 and 40 km";
  Layer& layer = *globe.layers().group(LayerGroupId::Overlays).find("Isolines");
  set(layer, "TileProvider.Interval", 30'000.0);
  set(layer, "TileProvider.LineColor", Value(glm::dvec3(0.0, 1.0, 0.0)));
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(0, 255, 0)) << "at 30 km";
  set(layer, "TileProvider.LineOpacity", 0.5);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(128, 128, 0));
}

TEST_F(ReliefLayersTest, RefusesThemAmongHeights) {
  RenderableGlobe& globe = addGlobe({});
  const auto added = globe.layers().addLayer("HeightLayers", {reliefLayer("Hillshade"), "test", "Layer", ""});
  ASSERT_FALSE(added);
  EXPECT_NE(added.error().what.find("has no heights"), std::string::npos);
}

}  // namespace
}  // namespace meridian::globebrowsing
