#include "globe_fixture.h"

namespace meridian::globebrowsing {
namespace {

/// A dark globe, water west of the prime meridian and land east of it, seen from the Sun.
class WaterTest : public GlobeTest {
 protected:
  using Picture = std::vector<std::uint8_t>;
  static constexpr int ground = 40;

  void SetUp() override {
    GlobeTest::SetUp();
    look(0.0, 0.0, 2.5e7);
  }
  Value mask(const std::string& identifier, Fields more = {}) {
    const std::string file = raster(
        identifier + ".tif", [](int band, double longitude, double) { return band < 3 || longitude < 0.0 ? 255 : 0; },
        4);
    return fileLayer(identifier, file, std::move(more));
  }
  RenderableGlobe& addSea(std::vector<Value> masks) {
    RenderableGlobe& globe =
        addGlobe({{"ColorLayers", listOf({fileLayer("Ground", uniformRaster("g.tif", {ground, ground, ground}))})},
                  {"WaterMasks", listOf(std::move(masks))}},
                 {{"PerformShading", true}, {"AmbientIntensity", 1.0}});
    EXPECT_TRUE(settle());
    return globe;
  }
  Picture picture() const {
    Picture rgba(std::size_t{4} * width * height);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_->framebuffer());
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    return rgba;
  }
  int red(int x, int y = height / 2) const {
    return picture()[4 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x))];
  }
  /// Pixels brighter than the ground on each side of the prime meridian, but for what filtering smears over it.
  std::pair<int, int> glints() const {
    const Picture now = picture();
    std::pair<int, int> count;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const bool shines = now[4 * (static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x))] > ground + 2;
        (x < width / 2 ? count.first : count.second) += shines && std::abs(x - width / 2) > 2 ? 1 : 0;
      }
    }
    return count;
  }
  /// Where the Sun is reflected straight back: 0.02 of its light, over 4 times the mean square slope of 0.0286;
  /// pictures hold about the square root of the light.
  static double brightest(double scale = 1.0) {
    return 255.0 * std::sqrt(std::pow(ground / 255.0, 2.0) + scale * 0.02 / (4.0 * 0.0286));
  }
  static constexpr int west = width / 2 - 4;
};

TEST_F(WaterTest, ShinesWhereThereIsWaterAndNowhereElse) {
  addSea({mask("Water")});
  const auto [water, land] = glints();
  EXPECT_GT(water, 50);
  EXPECT_LT(water, 4000) << "a lobe, not half a globe";
  EXPECT_EQ(land, 0);
  EXPECT_NEAR(red(west), brightest(), 4.0);
}

TEST_F(WaterTest, NothingShinesAtNight) {
  addSea({mask("Water")});
  view_.lightDirection = -view_.lightDirection;
  ASSERT_TRUE(settle());
  EXPECT_EQ(glints(), std::pair(0, 0));
}

TEST_F(WaterTest, FollowsTheSun) {
  addSea({mask("Water")});
  // The Sun 60 degrees to the west: the glint is where half of that is the slope.
  view_.lightDirection = glm::dvec3(std::cos(1.047), -std::sin(1.047), 0.0);
  ASSERT_TRUE(settle());
  const double seen = radius * std::sin(0.5) * view_.pixelsPerRadian / (2.5e7 - radius);
  EXPECT_GT(red(width / 2 - static_cast<int>(seen)), ground + 20);
  EXPECT_LE(red(west), ground + 2);
}

TEST_F(WaterTest, OpacityBlendingAndTheGlobesOwnScaleCount) {
  RenderableGlobe& globe = addSea({mask("Water"), mask("More", {{"Enabled", false}})});
  const int full = red(west) - ground;
  Layer* water = globe.layers().group(LayerGroupId::WaterMasks).find("Water");
  water->opacity.put(0.5);
  ASSERT_TRUE(settle());
  EXPECT_NEAR(red(west) - ground, 0.5 * full, 2.0);
  Layer* more = globe.layers().group(LayerGroupId::WaterMasks).find("More");
  more->opacity.put(0.5);
  more->enabled.put(true);
  ASSERT_TRUE(settle());
  EXPECT_NEAR(red(west) - ground, 0.75 * full, 2.0) << "laid over each other";
  globe.waterReflectance.put(2.0);
  ASSERT_TRUE(settle());
  EXPECT_NEAR(red(west), ground + 0.75 * (brightest(2.0) - ground), 5.0);
  globe.waterReflectance.put(0.0);
  ASSERT_TRUE(settle());
  EXPECT_EQ(glints(), std::pair(0, 0));
}

TEST_F(WaterTest, MasksComeFadeAndGo) {
  RenderableGlobe& globe = addSea({mask("Water", {{"Enabled", false}})});
  EXPECT_EQ(glints(), std::pair(0, 0));
  graphics_->programs().waitAll();
  Layer* water = globe.layers().group(LayerGroupId::WaterMasks).find("Water");
  water->fade.put(0.0);
  water->enabled.put(true);
  ASSERT_TRUE(settle([&] { EXPECT_EQ(glints(), std::pair(0, 0)) << "while its tiles and programs come"; }));
  graphics_->programs().waitAll();
  int last = ground;
  for (int n = 1; n <= 20; ++n) {
    water->fade.put(n / 20.0);
    ASSERT_TRUE(settle());
    const int now = red(west);
    EXPECT_NEAR(now, ground + n / 20.0 * (brightest() - ground), 4.0);
    EXPECT_GE(now, last);
    EXPECT_EQ(glints().second, 0);
    last = now;
  }
  water->enabled.put(false);
  ASSERT_TRUE(settle());
  EXPECT_EQ(glints(), std::pair(0, 0));
}

}  // namespace
}  // namespace meridian::globebrowsing
