#include "globebrowsing/layers/layer_manager.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../streaming/streamer_fixture.h"
#include "globebrowsing/streaming/tile_streamer.h"
#include "layer_fixture.h"

namespace meridian::globebrowsing {
namespace {

using testing::ElementsAre;

class LayerManagerTest : public testing::Test {
 protected:
  Layer& add(const std::string& identifier, Fields more = {}, const std::string& group = "ColorLayers") {
    const Result<Layer*> added = manager_.addLayer(group, requestFor(solidLayer(identifier, std::move(more))));
    EXPECT_TRUE(added) << added.error().message();
    return **added;
  }
  [[nodiscard]] LayerGroup& colours() { return manager_.group(LayerGroupId::ColorLayers); }
  [[nodiscard]] std::vector<std::string> order() {
    std::vector<std::string> identifiers;
    for (const auto& layer : colours().layers()) {
      identifiers.push_back(layer->identifier());
    }
    return identifiers;
  }
  [[nodiscard]] std::vector<int> depths() {
    std::vector<int> zIndices;
    for (const auto& layer : colours().layers()) {
      zIndices.push_back(layer->zIndex());
    }
    return zIndices;
  }

  LayerManager manager_;
};

TEST_F(LayerManagerTest, LayersWithoutZFollowTheLastOne) {
  add("a");
  add("b");
  EXPECT_THAT(depths(), ElementsAre(1, 1));
  add("c", {{"ZIndex", 5}});
  add("d");
  add("e");
  EXPECT_THAT(order(), ElementsAre("a", "b", "c", "d", "e"));
  EXPECT_THAT(depths(), ElementsAre(1, 1, 5, 6, 6));
  add("f", {{"ZIndex", 5}});
  add("g", {{"ZIndex", 1}});
  EXPECT_THAT(order(), ElementsAre("a", "b", "g", "c", "f", "d", "e"));
  std::vector<std::string> owners;
  for (const PropertyOwner* child : colours().children()) {
    owners.push_back(child->identifier());
  }
  EXPECT_EQ(owners, order()) << "the property tree shows the drawing order";
}

TEST_F(LayerManagerTest, AMovedLayerTakesItsNeighboursZ) {
  add("a", {{"ZIndex", 1}});
  add("b", {{"ZIndex", 2}});
  add("c", {{"ZIndex", 3}});
  ASSERT_TRUE(manager_.moveLayer("ColorLayers", "a", 1));
  EXPECT_THAT(order(), ElementsAre("b", "a", "c"));
  EXPECT_THAT(depths(), ElementsAre(2, 2, 3));
  ASSERT_TRUE(manager_.moveLayer("ColorLayers", "c", -5));
  EXPECT_THAT(order(), ElementsAre("c", "b", "a"));
  ASSERT_TRUE(manager_.moveLayer("ColorLayers", "c", 99));
  EXPECT_THAT(order(), ElementsAre("b", "a", "c"));
  EXPECT_THAT(depths(), ElementsAre(2, 2, 2));
  EXPECT_FALSE(manager_.moveLayer("ColorLayers", "x", 0));
  EXPECT_FALSE(manager_.moveLayer("Colours", "a", 0));
}

TEST_F(LayerManagerTest, PropertiesHangWhereScriptsExpectThem) {
  add("Blue", {{"Color", Value(glm::dvec3(0.0, 0.0, 1.0))}});
  for (const char* uri :
       {"Type", "BlendMode", "Enabled", "Reset", "Remove", "Opacity", "Fade", "GuiDescription", "Attribution", "Color",
        "Settings.Gamma", "Settings.Multiplier", "Settings.Offset", "Settings.SetDefault", "Adjustment.Type",
        "Adjustment.ChromaKeyColor", "Adjustment.ChromaKeyTolerance", "Status", "LastError"}) {
    EXPECT_NE(manager_.propertyAt(std::string("ColorLayers.Blue.") + uri), nullptr) << uri;
  }
  EXPECT_NE(manager_.propertyAt("ColorLayers.BlendTileLevels"), nullptr);
  EXPECT_EQ(manager_.propertyAt("ColorLayers.Blue.Opacity")->uri(), "Layers.ColorLayers.Blue.Opacity");
  EXPECT_FALSE(manager_.propertyAt("ColorLayers.Blue.Settings.Gamma")->set(5.5));
  EXPECT_TRUE(manager_.propertyAt("ColorLayers.Blue.BlendMode")->set("Multiply"));
  EXPECT_FALSE(manager_.propertyAt("ColorLayers.Blue.Type")->set(0));
}

TEST_F(LayerManagerTest, StructureGrowsWithWhatTheProgramDependsOnAndNothingElse) {
  Layer& a = add("a", {{"Enabled", true}});
  Layer& b = add("b");
  const auto grows = [&](auto&& change) {
    const std::uint64_t structure = manager_.structureVersion();
    const std::uint64_t settings = manager_.settingsVersion(LayerGroupId::ColorLayers);
    change();
    const bool restructured = manager_.structureVersion() > structure;
    const bool recomposed = manager_.settingsVersion(LayerGroupId::ColorLayers) > settings;
    return std::pair(restructured, recomposed);
  };
  const std::pair nothing(false, false);
  const std::pair recompose(false, true);
  const std::pair both(true, true);
  EXPECT_EQ(grows([&] { a.opacity.put(0.5); }), nothing) << "looked at in every frame";
  EXPECT_EQ(grows([&] { a.gamma.put(1.0); }), nothing) << "no change";
  EXPECT_EQ(grows([&] { a.fade.put(0.5); }), nothing);
  EXPECT_EQ(grows([&] { a.gamma.put(2.0); }), recompose);
  EXPECT_EQ(grows([&] { a.chromaKeyTolerance.put(0.2); }), recompose);
  EXPECT_EQ(grows([&] { a.colour.put(glm::dvec3(0.5)); }), recompose);
  EXPECT_EQ(grows([&] { b.gamma.put(2.0); }), nothing) << "not enabled";
  EXPECT_EQ(grows([&] { b.blendMode.put(2); }), nothing) << "not enabled";
  EXPECT_EQ(grows([&] { a.blendMode.put(1); }), both);
  EXPECT_EQ(grows([&] { a.adjustmentType.put(1); }), both);
  EXPECT_EQ(grows([&] { b.enabled.put(true); }), both);
  EXPECT_EQ(grows([&] { colours().move("a", 1); }), both);
  EXPECT_EQ(grows([&] { add("c"); }), nothing);
  EXPECT_EQ(grows([&] { add("d", {{"Enabled", true}}); }), both);
  EXPECT_EQ(grows([&] { add("e", {{"Enabled", true}}, "Overlays"); }), std::pair(true, false)) << "another group";
  EXPECT_EQ(grows([&] { manager_.deleteLayer("ColorLayers", "c"); }), nothing);
  EXPECT_EQ(grows([&] { manager_.deleteLayer("ColorLayers", "d"); }), both);
  EXPECT_EQ(grows([&] { manager_.update(); }), nothing);
}

TEST_F(LayerManagerTest, KeysTellStructureNotIdentity) {
  add("a", {{"Enabled", true}, {"BlendMode", "Add"}});
  const StructureKey before = colours().structureKey();
  EXPECT_EQ(before.text(), "ColorLayers:SolidColor,Add,None");
  ASSERT_TRUE(manager_.deleteLayer("ColorLayers", "a"));
  EXPECT_TRUE(colours().structureKey().empty());
  EXPECT_TRUE(colours().enabledLayers().empty());
  add("b", {{"Enabled", true}, {"BlendMode", "Add"}, {"Opacity", 0.1}});
  EXPECT_EQ(colours().structureKey(), before);
  EXPECT_THAT(colours().enabledLayers(), ElementsAre(colours().find("b")));
}

TEST_F(LayerManagerTest, SetDefaultTellsOnce) {
  Layer& a =
      add("a", {{"Enabled", true}, {"Settings", tableOf({{"Gamma", 2.0}, {"Multiplier", 3.0}, {"Offset", 4.0}})}});
  const std::uint64_t before = colours().settingsVersion();
  a.setDefault.fire();
  EXPECT_TRUE(a.settings().isIdentity());
  EXPECT_EQ(colours().settingsVersion(), before + 1);
  a.setDefault.fire();
  EXPECT_EQ(colours().settingsVersion(), before + 1);
}

TEST_F(LayerManagerTest, RemoveTakesEffectInTheNextUpdate) {
  Layer& a = add("a", {{"Enabled", true}});
  ASSERT_TRUE(manager_.propertyAt("ColorLayers.a.Remove")->set({}));
  EXPECT_EQ(colours().find("a"), &a);
  manager_.update();
  EXPECT_EQ(colours().find("a"), nullptr);
  EXPECT_TRUE(colours().structureKey().empty());
  EXPECT_EQ(manager_.propertyAt("ColorLayers.a.Enabled"), nullptr);
}

TEST_F(LayerManagerTest, ABadLayerIsLeftOutAndTheOthersLoad) {
  const Value layers =
      tableOf({{"ColorLayers",
                listOf({solidLayer("a"), solidLayer("a"), tableOf({{"Identifier", "b"}}), solidLayer("BlendTileLevels"),
                        solidLayer("c", {{"Opacity", "much"}}), solidLayer("d"), tableOf({{"Type", "SolidColor"}})})},
               {"ColorOverlays", listOf({solidLayer("e")})},
               {"Rings", listOf({solidLayer("f")})},
               {"NightLayers", tableOf({{"Identifier", "g"}})},
               {"WaterMasks", listOf({})}});
  const std::vector<RefusedLayer> refused = manager_.load(layers, "earth.asset:3", "Renderable.Layers", "/data");
  EXPECT_THAT(order(), ElementsAre("a", "d"));
  EXPECT_NE(manager_.group(LayerGroupId::Overlays).find("e"), nullptr);
  EXPECT_EQ(manager_.layerCount(), 3U);
  std::vector<std::string> places;
  std::vector<std::string> names;
  for (const auto& [name, error] : refused) {
    names.push_back(name);
    places.push_back(error.where);
  }
  const std::string start = "earth.asset:3: Renderable.Layers.";
  EXPECT_THAT(places, ElementsAre(start + "ColorLayers.a.Identifier", start + "ColorLayers.b.FilePath",
                                  start + "ColorLayers.BlendTileLevels.Identifier", start + "ColorLayers.c.Opacity",
                                  start + "ColorLayers[7].Identifier", start + "NightLayers", start + "Rings"));
  EXPECT_THAT(names, ElementsAre("ColorLayers.a", "ColorLayers.b", "ColorLayers.BlendTileLevels", "ColorLayers.c",
                                 "ColorLayers[7]", "NightLayers", "Rings"));
  EXPECT_EQ(manager_.load("text", "x", "Layers", "").size(), 1U);
}

TEST(LayerWithServices, OpensItsProviderWhenFirstEnabledAndTellsWhatWentWrong) {
  WorkerPool pool(1);
  Statistics statistics;
  TileStreamer streamer(pool, statistics);
  LayerManager manager({&pool, &streamer});
  const Value table = tableOf({{"Identifier", "a"}, {"FilePath", "no_such_file.tif"}});
  Layer& layer = **manager.addLayer("HeightLayers", requestFor(table));
  Layer& other = **manager.addLayer("ColorLayers", requestFor(table));
  EXPECT_NE(layer.stream(), 0U);
  EXPECT_NE(layer.stream(), other.stream());
  manager.update();
  pool.drain();
  EXPECT_EQ(layer.provider()->state(), TileProvider::State::NotOpened);
  layer.enabled.put(true);
  Gate gate(pool);  // that it fails is to be noticed by the second update
  manager.update();
  gate.open();
  pool.drain();
  const std::uint64_t before = manager.settingsVersion(LayerGroupId::HeightLayers);
  manager.update();
  EXPECT_GT(manager.settingsVersion(LayerGroupId::HeightLayers), before);
  EXPECT_EQ(layer.status.get(), "failed");
  EXPECT_THAT(layer.lastError.get(), testing::HasSubstr("/data/no_such_file.tif"));
  EXPECT_FALSE(layer.isReady());
  EXPECT_EQ(other.status.get(), "not opened");

  const std::uint32_t stream = layer.stream();
  layer.reset.fire();
  EXPECT_NE(layer.stream(), stream);
  EXPECT_EQ(layer.status.get(), "not opened");
  EXPECT_EQ(layer.lastError.get(), "");
  manager.update();
  pool.drain();
  manager.update();
  EXPECT_EQ(layer.status.get(), "failed");
}

TEST(LayerWithServices, ShowsTheLastErrorOfItsTiles) {
  class FailingJob final : public TileJob {
    Result<TileDataPointer> run(const std::stop_token& /*stop*/) override { return failure("damaged block", "a.tif"); }
  };
  WorkerPool pool(1);
  Statistics statistics;
  TileStreamer streamer(pool, statistics);
  LayerManager manager({&pool, &streamer});
  Layer& layer = **manager.addLayer("ColorLayers", requestFor(solidLayer("a", {{"Enabled", true}})));
  streamer.beginFrame();
  streamer.request({layer.stream(), {}}, 1.0, [] { return std::make_unique<FailingJob>(); });
  streamer.endFrame();
  pool.drain();
  streamer.beginFrame();
  manager.update();
  EXPECT_EQ(layer.lastError.get(), "a.tif: damaged block");
  ASSERT_TRUE(manager.deleteLayer("ColorLayers", "a"));
  EXPECT_EQ(streamer.bytes(), 0U) << "a deleted layer's stream is forgotten";
}

}  // namespace
}  // namespace meridian::globebrowsing
