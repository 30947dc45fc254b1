// What is seen while the server of one layer of several does not answer.
#include "globe_fixture.h"
#include "support/server_process.h"
#include "support/timed_pyramid.h"
#include "support/world_raster.h"

namespace meridian::globebrowsing {
namespace {

class LateLayersTest : public GlobeTest {
 protected:
  void SetUp() override {
    GlobeTest::SetUp();
    if (!graphics_) {
      return;
    }
    setModuleProperty("NetworkCacheMode", "off");
    WorldRaster::write(folder_ / "world.tif");
    WorldRaster::cut(folder_ / "world.tif", folder_ / "tiles");
    document_ = WorldRaster::document("http://127.0.0.1:" + std::to_string(port_));
  }
  void startServer() {
    server_ = std::make_unique<ServerProcess>(ServerProcess::fileServer((folder_ / "tiles").string(), port_), port_);
  }
  /// The colours of the server's layer, and another as much over it.
  static Pixel worldUnder(const Pixel& over, double opacity, double longitude, double latitude) {
    Pixel mixed{};
    for (std::size_t band = 0; band < 3; ++band) {
      const double world = WorldRaster::value(static_cast<int>(band), longitude, latitude);
      mixed[band] = static_cast<int>(std::lround(world + (over[band] - world) * opacity));
    }
    return mixed;
  }
  [[nodiscard]] bool shows(const Pixel& expected) const {
    const Pixel seen = centre();
    return std::equal(seen.begin(), seen.end(), expected.begin(), [](int a, int b) { return std::abs(a - b) <= 4; });
  }

  /// A layer of one colour on disk below the server's; the lower one.
  Layer& addLocalUnderWorld() {
    RenderableGlobe& globe =
        addGlobe({{"ColorLayers",
                   listOf({fileLayer("Local", uniformRaster("local.tif", local)), fileLayer("World", document_)})}});
    return *globe.layers().group(LayerGroupId::ColorLayers).find("Local");
  }

  static constexpr Pixel local{200, 30, 90};
  const int port_ = freePort();
  std::string document_;
  std::unique_ptr<ServerProcess> server_;
};

TEST_F(LateLayersTest, OtherColoursShowUntilTheServerIsThere) {
  Layer& localLayer = addLocalUnderWorld();
  ASSERT_TRUE(framesUntil([&] { return shows(local); }));
  EXPECT_NE(unsettled(), "");
  look(0.4, 1.2, 8e6);  // tiles that nobody has asked for yet
  ASSERT_TRUE(framesUntil([&] { return shows(local); }));
  localLayer.multiplier.put(0.5);
  ASSERT_TRUE(framesUntil([&] { return shows({100, 15, 45}); })) << "a layer can be adjusted meanwhile";
  EXPECT_NE(unsettled(), "");

  startServer();
  ASSERT_TRUE(settle());
  EXPECT_TRUE(shows(worldUnder(local, 0.0, 1.2, 0.4))) << testing::PrintToString(centre());
}

TEST_F(LateLayersTest, WhatTheServerSentBeforeStandsInForWhatIsMissing) {
  RenderableGlobe& globe = addGlobe(
      {{"ColorLayers", listOf({fileLayer("World", document_),
                               fileLayer("Local", uniformRaster("local.tif", local, 4096), {{"Enabled", false}})})}});
  startServer();
  look(0.4, 1.2, 6e7);
  ASSERT_TRUE(settle());
  server_.reset();
  Layer& over = *globe.layers().group(LayerGroupId::ColorLayers).find("Local");
  over.enabled.put(true);
  over.opacity.put(0.5);
  look(0.4, 1.2, 7e6);
  const Pixel expected = worldUnder(local, 0.5, 1.2, 0.4);
  ASSERT_TRUE(framesUntil([&] { return shows(expected); })) << testing::PrintToString(centre());
  EXPECT_NE(unsettled(), "");
  startServer();
  ASSERT_TRUE(settle([&] { ASSERT_TRUE(shows(expected)) << testing::PrintToString(centre()); }));
}

TEST_F(LateLayersTest, AToggleShowsThoughNothingOfTheOthersIsThere) {
  Layer& localLayer = addLocalUnderWorld();
  ASSERT_TRUE(framesUntil([&] { return shows(local); }));
  localLayer.enabled.put(false);
  EXPECT_TRUE(framesUntil([&] { return !shows(local); }));
}

TEST_F(LateLayersTest, ALayerOfTimesHoldsUpNoOtherEither) {
  const TimedPyramid pyramid{.days = 2, .levels = 2};
  std::filesystem::create_directories(folder_ / "tiles");
  pyramid.write(folder_ / "tiles", "http://127.0.0.1:" + std::to_string(port_));
  std::filesystem::rename(folder_ / "tiles/days", folder_ / "tiles/later");
  std::filesystem::remove_all(folder_ / "tiles/1");
  time_ = TimedPyramid::timeOf(1);
  // Its capabilities are on disk, its tiles nowhere.
  const std::string days = "WMTS:" + (folder_ / "tiles/wmts.xml").string() + ",layer=Days";
  RenderableGlobe& globe = addGlobe(
      {{"ColorLayers", listOf({fileLayer("Local", uniformRaster("local.tif", local)), fileLayer("Days", days)})}});
  ASSERT_TRUE(framesUntil([&] { return shows(local); }));
  globe.layers().group(LayerGroupId::ColorLayers).find("Local")->multiplier.put(0.5);
  EXPECT_TRUE(framesUntil([&] { return shows({100, 15, 45}); }));
  std::filesystem::rename(folder_ / "tiles/later", folder_ / "tiles/days");
  startServer();
  ASSERT_TRUE(settle());
  const auto day = TimedPyramid::colourOf(1);
  const Pixel seen = centre();
  for (std::size_t band = 0; band < 3; ++band) {
    EXPECT_NEAR(seen[band], day[band], TimedPyramid::grain + 4);
  }
}

TEST_F(LateLayersTest, TheGlobeMovesToAnotherPoolAllTheSame) {
  addGlobe({{"ColorLayers",
             listOf({fileLayer("World", document_), fileLayer("Local", uniformRaster("local.tif", local))})}});
  ASSERT_TRUE(framesUntil([&] { return shows(local); }));
  setModuleProperty("TexturePoolSize", 128);
  frame();
  const std::string moves = unsettled();
  EXPECT_NE(moves.find("another size"), std::string::npos) << moves;
  EXPECT_TRUE(framesUntil([&] {
    EXPECT_TRUE(shows(local));
    return unsettled() != moves;
  }));
}

TEST_F(LateLayersTest, TheGlobeIsSmoothUntilItsHeightsAreThere) {
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("Local", uniformRaster("local.tif", local))})},
                                     {"HeightLayers", listOf({fileLayer("World", document_)})}});
  look(0.4, 1.2, 8e6);
  ASSERT_TRUE(framesUntil([&] { return shows(local); })) << "no globe without heights";
  EXPECT_EQ(globe.ground()->heightAt(0.4, 1.2), 0.0);
  EXPECT_NE(unsettled(), "");
  startServer();
  ASSERT_TRUE(settle());
  EXPECT_NEAR(globe.ground()->heightAt(0.4, 1.2), WorldRaster::value(0, 1.2, 0.4), 3.0);
}

TEST_F(LateLayersTest, HeightsStayWhileTheirDataAreOpenedAnew) {
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("Local", uniformRaster("local.tif", local))})},
                                     {"HeightLayers", listOf({fileLayer("World", document_)})}});
  startServer();
  look(0.4, 1.2, 8e6);
  ASSERT_TRUE(settle());
  Layer& world = *globe.layers().group(LayerGroupId::HeightLayers).find("World");
  const double shown = WorldRaster::value(0, 1.2, 0.4);
  // What the first server sent is in memory: so another one, which does not answer yet.
  server_.reset();
  const int later = freePort();
  ASSERT_TRUE(world.propertyAt("TileProvider.FilePath")
                  ->set(WorldRaster::document("http://127.0.0.1:" + std::to_string(later))));
  world.reset.fire();
  const auto end = std::chrono::steady_clock::now() + 3 * TileStreamer::patience;
  ASSERT_TRUE(framesUntil([&] {
    EXPECT_NEAR(globe.ground()->heightAt(0.4, 1.2), shown, 3.0);
    return testing::Test::HasFailure() || std::chrono::steady_clock::now() > end;
  }));
  EXPECT_NE(unsettled(), "");
  world.multiplier.put(0.5);
  EXPECT_TRUE(framesUntil([&] { return std::abs(globe.ground()->heightAt(0.4, 1.2) - 0.5 * shown) < 2.0; }))
      << "it can be adjusted meanwhile";
  EXPECT_NE(unsettled(), "");

  world.multiplier.put(1.0);
  world.offset.put(1000.0);
  server_ = std::make_unique<ServerProcess>(ServerProcess::fileServer((folder_ / "tiles").string(), later), later);
  ASSERT_TRUE(settle());
  EXPECT_NEAR(globe.ground()->heightAt(0.4, 1.2), shown + 1000.0, 3.0);
}

TEST_F(LateLayersTest, ColoursOfHeightsFollowWhenTheHeightsCome) {
  const Value ramp = tableOf({{"Identifier", "Ramp"},
                              {"Type", "ColorRelief"},
                              {"Enabled", true},
                              {"ColorRamp", "0 0 200 0; 255 255 200 255"}});
  addGlobe({{"ColorLayers", listOf({ramp})}, {"HeightLayers", listOf({fileLayer("World", document_)})}});
  look(0.4, 1.2, 8e6);
  ASSERT_TRUE(framesUntil([&] { return shows({0, 200, 0}); })) << "the ellipsoid's colour";
  startServer();
  ASSERT_TRUE(settle());
  const int grey = WorldRaster::value(0, 1.2, 0.4);
  EXPECT_TRUE(shows({grey, 200, grey})) << testing::PrintToString(centre());
}

}  // namespace
}  // namespace meridian::globebrowsing
