#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>

#include "globe_fixture.h"
#include "host/scripting/script_engine.h"

namespace meridian::globebrowsing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// The two ways by which layers come to a globe: its node's table, and scripts.
class LayerTablesTest : public testing::Test {
 protected:
  LayerTablesTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "meridian-tables-XXXXXX").string();
    host_.folder = ::mkdtemp(pattern.data());
    host_.tokens["ASSETS"] = host_.folder + "/assets";
    std::filesystem::create_directories(host_.folder + "/assets/days");
    std::ofstream(host_.folder + "/assets/x.tif") << "x";
    EXPECT_TRUE(module_->initialize(host_));
    for (const ScriptLibrary& library : host_.libraries) {
      engine_.registerLibrary(library);
    }
  }
  ~LayerTablesTest() override {
    host_.renderables.clear();
    std::filesystem::remove_all(host_.folder);
  }

  RenderableGlobe& addGlobe(const Value& layers) {
    auto made = host_.factories.at("RenderableGlobe")(
        {tableOf({{"Radii", 1e6}, {"Layers", layers}}), "globe.asset:2", host_.folder, "Globe"});
    EXPECT_TRUE(made);
    host_.renderables["Globe"] = std::move(*made);
    return dynamic_cast<RenderableGlobe&>(*host_.renderables["Globe"]);
  }
  void run(const std::string& script) {
    const auto done = engine_.run("local add = openspace.globebrowsing.addLayer " + script, "test.lua");
    EXPECT_TRUE(done) << done.error().message();
  }
  /// "NAME: MESSAGE" of what is not usable, "NAME" of the others.
  static std::vector<std::string> told(const RenderableGlobe& globe) {
    std::vector<std::string> lines;
    for (const auto& layer : globe.contents().layers) {
      lines.push_back(layer.name + (layer.unusable ? ": " + layer.unusable->message() : ""));
    }
    return lines;
  }

  Paths paths_;
  Statistics statistics_;
  FakeHost host_{paths_, statistics_};
  std::unique_ptr<Module> module_ = makeModule();
  scripting::ScriptEngine engine_;
};

TEST_F(LayerTablesTest, TokensAreReplacedHoweverALayerIsAdded) {
  const RenderableGlobe& globe =
      addGlobe(tableOf({{"ColorLayers", listOf({tableOf({{"Identifier", "A"}, {"FilePath", "${ASSETS}/x.tif"}}),
                                                tableOf({{"Identifier", "B"}, {"FilePath", "${NOPE}/x.tif"}})})}}));
  run(R"(
    add('Globe', 'ColorLayers', { Identifier = 'C', FilePath = '${ASSETS}/x.tif' })
    add('Globe', 'ColorLayers', { Identifier = 'D', FilePath = '/data/${NOPE}/x.tif' })
    add('Globe', 'ColorLayers', { Identifier = 'E', Type = 'TemporalTileProvider', Colormap = '${ASSETS}/x.tif',
                                  Folder = { Folder = '${ASSETS}/days', Format = '%Y' } }))");
  EXPECT_THAT(told(globe),
              ElementsAre("ColorLayers.A",
                          HasSubstr("ColorLayers.B: globe.asset:2: Renderable.Layers.ColorLayers.B.FilePath: unknown "
                                    "path token ${NOPE}"),
                          "ColorLayers.C",
                          HasSubstr("ColorLayers.D: test.lua:1: addLayer ColorLayers.D.FilePath: unknown path token "
                                    "${NOPE}"),
                          "ColorLayers.E"));
}

TEST_F(LayerTablesTest, TokensAreReplacedInPathsThatAreSet) {
  RenderableGlobe& globe = addGlobe(tableOf(
      {{"ColorLayers",
        listOf({tableOf({{"Identifier", "A"}, {"FilePath", "gone.tif"}}),
                tableOf({{"Identifier", "B"}, {"Type", "ImageSequenceTileProvider"}, {"FolderPath", "gone"}})})}}));
  Property* file = globe.propertyAt("Layers.ColorLayers.A.TileProvider.FilePath");
  Property* folder = globe.propertyAt("Layers.ColorLayers.B.TileProvider.FolderPath");
  ASSERT_NE(file, nullptr);
  ASSERT_NE(folder, nullptr);
  ASSERT_TRUE(file->set("${ASSETS}/x.tif"));
  ASSERT_TRUE(folder->set("${ASSETS}/days"));
  globe.layers().update();
  EXPECT_THAT(told(globe), ElementsAre("ColorLayers.A", "ColorLayers.B"));
  const Value table = globe.layers().group(LayerGroupId::ColorLayers).find("A")->table();
  EXPECT_EQ(*table.find("FilePath")->string(), host_.folder + "/assets/x.tif") << "what is written holds anywhere";

  ASSERT_TRUE(file->set("${LATER}/x.tif"));
  globe.layers().update();
  EXPECT_THAT(told(globe), ElementsAre(HasSubstr("unknown path token ${LATER}"), "ColorLayers.B"));
  host_.tokens["LATER"] = host_.folder + "/assets";
  ASSERT_TRUE(globe.propertyAt("Layers.ColorLayers.A.Reset")->set({}));
  EXPECT_THAT(told(globe), ElementsAre("ColorLayers.A", "ColorLayers.B"));
}

TEST_F(LayerTablesTest, AFormatThatCannotBeReadKeepsItsLayer) {
  const RenderableGlobe& globe = addGlobe(tableOf({{"ColorLayers", listOf({})}}));
  run(R"(
    for name, format in pairs({ A = 'a_%m.png', B = '%Y %I%p', C = '%Q' }) do
      add('Globe', 'ColorLayers', { Identifier = name, Type = 'TemporalTileProvider', ZIndex = string.byte(name),
                                    Folder = { Folder = '${ASSETS}/days', Format = format } })
    end)");
  EXPECT_THAT(told(globe), ElementsAre("ColorLayers.A", "ColorLayers.B",
                                       HasSubstr("ColorLayers.C.Folder.Format: the format \"%Q\" has an unknown "
                                                 "conversion %Q")));
}

TEST_F(LayerTablesTest, WhatIsRefusedIsNamedByGroupLayerAndKey) {
  const auto layer = [](Fields more) {
    more["Type"] = "SolidColor";
    return tableOf(std::move(more));
  };
  const RenderableGlobe& globe = addGlobe(
      tableOf({{"ColorLayers", listOf({layer({{"Identifier", "Good"}}), layer({{"Identifier", "Bad"}, {"ZIndex", 0}}),
                                       layer({}), layer({{"Identifier", "Odd"}, {"Nonsense", 1}})})},
               {"Colours", listOf({})}}));
  run(R"(
    local function helper(more)
      more.Type = 'SolidColor' add('Globe', 'ColorLayers', more) add('Globe', 'NightLayers', more)
    end
    helper({ Identifier = 'One', ZIndex = 0 }) helper({ Color = 'red' })
    add('Globe', 'GrayScaleLayers', { Identifier = 'Two', Opacity = 2 }) )");
  const std::string table = "globe.asset:2: Renderable.Layers.";
  const std::string script = "test.lua:1: addLayer ";
  EXPECT_THAT(told(globe),
              ElementsAre("ColorLayers.Good", "ColorLayers.Odd",
                          HasSubstr("ColorLayers.Bad: " + table + "ColorLayers.Bad.ZIndex: "),
                          HasSubstr("ColorLayers[3]: " + table + "ColorLayers[3].Identifier: "),
                          HasSubstr("Colours: " + table + "Colours: unknown layer group"),
                          HasSubstr("ColorLayers.One: " + script + "ColorLayers.One.ZIndex: "),
                          HasSubstr("NightLayers.One: " + script + "NightLayers.One.ZIndex: "),
                          HasSubstr("ColorLayers[6]: " + script + "ColorLayers[6].Identifier: "),
                          HasSubstr("NightLayers[2]: " + script + "NightLayers[2].Identifier: "),
                          HasSubstr("ColorLayers.Two: test.lua:1: addLayer GrayScaleLayers.Two.Opacity: ")));
  const std::vector<Error> notes = globe.contents().notes;
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].message(), table + "ColorLayers.Odd: unknown key Nonsense");
}

/// Section b of openspace-formats.md: what RenderableGlobe's table may hold, and what it held once.
TEST_F(LayerTablesTest, EveryDocumentedKeyOfAGlobeIsUsedOrIgnored) {
  Fields table{{"Type", "RenderableGlobe"}, {"Radii", 1e6}, {"Tag", "planet"}};
  for (const char* key : {"PerformShading", "UseAccurateNormals", "RenderAtDistance", "Enabled", "DimInAtmosphere"}) {
    table[key] = true;
  }
  for (const char* key : {"AmbientIntensity", "Opacity", "OrenNayarRoughness"}) {
    table[key] = 0.5;
  }
  table["TargetLodScaleFactor"] = 15.0;
  table["LightSourceNode"] = "Sun";
  for (const char* group : {"HeightLayers", "ColorLayers", "Overlays", "NightLayers", "WaterMasks"}) {
    table["Layers"] = tableOf({{group, listOf({})}});
  }
  for (const char* key :
       {"ModelSpaceRenderingCutoffLevel", "Labels", "ShadowGroup", "Rings", "Shadows", "RenderBinMode",
        "SegmentsPerPatch", "CameraMinHeight", "InteractionDepthBelowEllipsoid", "Atmosphere", "LightSource"}) {
    table[key] = tableOf({});
  }
  const auto notesOf = [&] {
    const auto made = host_.factories.at("RenderableGlobe")({tableOf(table), "globe.asset:2", "/", "Globe"});
    EXPECT_TRUE(made);
    return (*made)->contents().notes.size();
  };
  EXPECT_EQ(notesOf(), 0U);
  table["LightSources"] = tableOf({});
  EXPECT_EQ(notesOf(), 1U);
}

}  // namespace
}  // namespace meridian::globebrowsing
