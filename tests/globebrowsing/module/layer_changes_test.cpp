#include <gmock/gmock.h>

#include "globe_fixture.h"

namespace meridian::globebrowsing {
namespace {

using LayerChangesTest = GlobeTest;

constexpr std::array<int, 3> background{0, 0, 0};

testing::Matcher<const std::array<int, 3>&> colour(int red, int green, int blue) {
  using testing::AllOf;
  using testing::Ge;
  using testing::Le;
  return testing::ElementsAre(AllOf(Ge(red - 2), Le(red + 2)), AllOf(Ge(green - 2), Le(green + 2)),
                              AllOf(Ge(blue - 2), Le(blue + 2)));
}

TEST_F(LayerChangesTest, TogglingRequestsAProgramAndDrawsTheOldCompositesUntilTheNewAreThere) {
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("Green", uniformRaster("g.tif", {0, 200, 0})),
                                                             solidLayer("Red", {1, 0, 0}, {{"Enabled", false}})})}});
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(0, 200, 0));
  graphics_->programs().waitAll();  // those that fades will draw with
  const auto built = statistics_.programs.built.load();

  Layer* red = globe.layers().group(LayerGroupId::ColorLayers).find("Red");
  red->enabled.put(true);
  bool changed = false;
  ASSERT_TRUE(settle([&] {
    const Pixel now = centre();
    EXPECT_THAT(now, testing::AnyOf(colour(0, 200, 0), colour(255, 0, 0))) << "neither before nor after";
    EXPECT_FALSE(changed && now[0] == 0) << "back to the colours of before";
    changed = changed || now[0] > 0;
  }));
  EXPECT_THAT(centre(), colour(255, 0, 0));
  graphics_->programs().waitAll();
  EXPECT_EQ(statistics_.programs.built.load(), built + 2) << "for tiles in general, and for those that fit as they are";

  for (int n = 0; n < 3; ++n) {
    red->enabled.put(n % 2 == 1);
    ASSERT_TRUE(settle());
    EXPECT_THAT(centre(), n % 2 == 1 ? colour(255, 0, 0) : colour(0, 200, 0));
  }
  graphics_->programs().waitAll();
  EXPECT_EQ(statistics_.programs.built.load(), built + 2) << "the programs of both structures are kept";
}

TEST_F(LayerChangesTest, SettingsRecomposeAndNeverRecompile) {
  RenderableGlobe& globe = addGlobe(
      {{"ColorLayers",
        listOf({solidLayer("Black", {0, 0, 0}), fileLayer("Grey", uniformRaster("g.tif", {100, 100, 100}))})}});
  ASSERT_TRUE(settle());
  graphics_->programs().waitAll();  // those that fades will draw with
  const auto built = statistics_.programs.built.load();
  Layer* layer = globe.layers().group(LayerGroupId::ColorLayers).find("Grey");
  layer->opacity.put(0.5);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(50, 50, 50));
  layer->opacity.put(1.0);
  layer->multiplier.put(2.0);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(200, 200, 200));
  layer->setDefault.fire();
  layer->fade.put(0.0);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(0, 0, 0));
  EXPECT_EQ(statistics_.programs.built.load(), built);
}

TEST_F(LayerChangesTest, AddsMovesAndDeletesLayersWhileFramesRun) {
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({solidLayer("Red", {1, 0, 0})})}});
  ASSERT_TRUE(settle());
  const ProviderRequest blue{solidLayer("Blue", {0, 0, 1}), "test", "Layer", folder_.string()};
  ASSERT_TRUE(globe.layers().addLayer("ColorLayers", blue));
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(0, 0, 255));
  ASSERT_TRUE(globe.layers().moveLayer("ColorLayers", "Blue", 0));
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(255, 0, 0));
  ASSERT_TRUE(globe.layers().deleteLayer("ColorLayers", "Red"));
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(0, 0, 255));
  globe.layers().group(LayerGroupId::ColorLayers).find("Blue")->remove.fire();
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(76, 76, 76)) << "without any layer";
}

TEST_F(LayerChangesTest, DeletesLayersWhoseTilesAreUnderWay) {
  const std::string file = uniformRaster("large.tif", {9, 9, 9}, 2048);
  RenderableGlobe& globe = addGlobe({});
  for (int n = 0; n < 12; ++n) {
    const std::string name = "L" + std::to_string(n);
    ASSERT_TRUE(globe.layers().addLayer("ColorLayers", {fileLayer(name, file), "test", "Layer", ""}));
    for (int i = 0; i < n; ++i) {
      frame();
    }
    ASSERT_TRUE(globe.layers().deleteLayer("ColorLayers", name));
  }
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(76, 76, 76));
}

TEST_F(LayerChangesTest, DestroysAGlobeWhoseJobsRun) {
  const std::string file = uniformRaster("large.tif", {9, 9, 9}, 2048);
  for (int n = 0; n < 6; ++n) {
    addGlobe({{"ColorLayers", listOf({fileLayer("A", file)})}, {"HeightLayers", listOf({fileLayer("H", file)})}});
    for (int i = 0; i < 2 * n; ++i) {
      frame();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    removeGlobes();
  }
}

TEST_F(LayerChangesTest, ComposesFortyLayersAtAnyPoolSize) {
  std::vector<Value> layers;
  for (int n = 0; n < 40; ++n) {
    const std::string name = "L" + std::to_string(n);
    layers.push_back(fileLayer(name, uniformRaster(name + ".tif", {n, 2 * n, 5 * n}, 64)));
  }
  for (const int pool : {512, 64}) {
    setModuleProperty("TexturePoolSize", pool);
    addGlobe({{"ColorLayers", listOf(layers)}});
    ASSERT_TRUE(settle()) << pool;
    EXPECT_THAT(centre(), colour(39, 78, 195)) << pool;
    removeGlobes();
  }
}

TEST_F(LayerChangesTest, GoesOnWhenLayersOutgrowTheRawTiles) {
  setModuleProperty("TexturePoolSize", 64);
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({solidLayer("Red", {1, 0, 0})})}});
  ASSERT_TRUE(settle());
  for (int n = 0; n < 20; ++n) {
    const std::string name = "L" + std::to_string(n);
    const Value layer = fileLayer(name, uniformRaster(name + ".tif", {0, 0, 10 * n}, 64));
    ASSERT_TRUE(globe.layers().addLayer("ColorLayers", {layer, "test", "Layer", ""}));
  }
  ASSERT_TRUE(settle([&] { EXPECT_NE(centre(), background); }));
  EXPECT_THAT(centre(), colour(0, 0, 190));
}

TEST_F(LayerChangesTest, ToggledHeightsReachHeightAtAndComeBack) {
  const std::string file = raster(
      "h.tif", [](int, double, double) { return 1234.5; }, 1, GDT_Float32);
  RenderableGlobe& globe = addGlobe({{"HeightLayers", listOf({fileLayer("H", file)})}});
  ASSERT_TRUE(settle());
  EXPECT_NEAR(globe.heightAt(0.1, 0.2), 1234.5, 1e-3);
  Layer* layer = globe.layers().group(LayerGroupId::HeightLayers).find("H");
  layer->enabled.put(false);
  ASSERT_TRUE(settle([&] { EXPECT_NE(centre(), background); }));
  EXPECT_NEAR(globe.heightAt(0.1, 0.2), 0.0, 1e-3);
  layer->enabled.put(true);
  layer->multiplier.put(2.0);
  ASSERT_TRUE(settle([&] { EXPECT_NE(centre(), background); }));
  EXPECT_NEAR(globe.heightAt(0.1, 0.2), 2469.0, 1e-3);
}

TEST_F(LayerChangesTest, AnEnabledGlobeComesBackAfterBeingDisabled) {
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({solidLayer("Red", {1, 0, 0})})}});
  ASSERT_TRUE(settle());
  globe.enabled.put(false);
  frame();
  EXPECT_EQ(centre(), background);
  EXPECT_TRUE(globe.settled(0).complete);
  EXPECT_EQ(statistics_.chunks.drawn, 0U);
  for (int n = 0; n < 1100; ++n) {
    frame();
  }
  EXPECT_EQ(statistics_.memory.texturePool, 0U) << "its textures are given back";
  globe.enabled.put(true);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(255, 0, 0));
}

TEST_F(LayerChangesTest, MixesATransparentGlobeWithWhatIsBehind) {
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({solidLayer("White", {1, 1, 1})})}});
  ASSERT_TRUE(settle());
  globe.opacity.put(0.5);
  ASSERT_TRUE(settle());
  EXPECT_THAT(centre(), colour(128, 128, 128));
}

TEST_F(LayerChangesTest, AnotherFilePathOpensTheLayerAnew) {
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("A", uniformRaster("red.tif", {200, 0, 0}))})}});
  uniformRaster("green.tif", {0, 200, 0});
  ASSERT_TRUE(settle());
  EXPECT_EQ(centre(), (Pixel{200, 0, 0}));
  Property* path = globe.layers().propertyAt("ColorLayers.A.TileProvider.FilePath");
  ASSERT_NE(path, nullptr);
  ASSERT_TRUE(path->set("green.tif")) << "beside the asset";
  ASSERT_TRUE(settle());
  EXPECT_EQ(centre(), (Pixel{0, 200, 0}));

  const Layer& layer = *globe.layers().group(LayerGroupId::ColorLayers).find("A");
  ASSERT_TRUE(path->set("missing.tif"));
  ASSERT_TRUE(framesUntil([&] { return layer.status.get() == "failed"; }));
  EXPECT_NE(layer.lastError.get().find("missing.tif"), std::string::npos) << layer.lastError.get();
  ASSERT_TRUE(path->set(""));
  frame();
  EXPECT_NE(layer.lastError.get().find("FilePath is empty"), std::string::npos) << layer.lastError.get();
  ASSERT_TRUE(path->set("red.tif"));
  ASSERT_TRUE(settle());
  EXPECT_EQ(centre(), (Pixel{200, 0, 0}));
  EXPECT_EQ(layer.lastError.get(), "");
  EXPECT_EQ(globe.layers().propertyAt("ColorLayers.A.TileProvider.FilePath"), path) << "it is still the same property";
  EXPECT_EQ(globe.layers().propertyAt("ColorLayers.A.TileProvider.FolderPath"), nullptr);
  EXPECT_TRUE(globe.layers().propertyAt("ColorLayers.A.TileProvider.TilePixelSize")->set(256));
}

TEST_F(LayerChangesTest, AnotherFolderPathOpensTheSequenceAnew) {
  for (const auto& [folder, colour] : {std::pair{"red", Pixel{200, 0, 0}}, std::pair{"green", Pixel{0, 200, 0}}}) {
    std::filesystem::create_directories(folder_ / folder);
    uniformRaster(std::string(folder) + "/a.tif", colour);
  }
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({tableOf({{"Identifier", "A"},
                                                                      {"Type", "ImageSequenceTileProvider"},
                                                                      {"FolderPath", "red"},
                                                                      {"Enabled", true}})})}});
  ASSERT_TRUE(settle());
  EXPECT_EQ(centre(), (Pixel{200, 0, 0}));
  ASSERT_TRUE(globe.layers().propertyAt("ColorLayers.A.TileProvider.FolderPath")->set("green"));
  ASSERT_TRUE(settle());
  EXPECT_EQ(centre(), (Pixel{0, 200, 0}));
  EXPECT_NE(globe.layers().propertyAt("ColorLayers.A.TileProvider.Index"), nullptr);
}

}  // namespace
}  // namespace meridian::globebrowsing
