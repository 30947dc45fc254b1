// What openspace.globebrowsing offers beside layers: GIBS, map servers, patches, GeoJSON. No OpenGL.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <cpl_minixml.h>
#include <gmock/gmock.h>

#include "globe_fixture.h"
#include "globebrowsing/gibs.h"
#include "globebrowsing/map_servers.h"
#include "host/scripting/script_engine.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;

class GlobeScripts : public testing::Test {
 protected:
  GlobeScripts() {
    std::string pattern = (std::filesystem::temp_directory_path() / "meridian-test-XXXXXX").string();
    host_.folder = ::mkdtemp(pattern.data());
    EXPECT_TRUE(module_->initialize(host_));
    for (const ScriptLibrary& library : host_.libraries) {
      engine_.registerLibrary(library);
    }
    for (const char* node : {"Earth", "Moon"}) {
      auto made = host_.factories.at("RenderableGlobe")({tableOf({{"Radii", 1e6}}), "test.asset:1", "/", node});
      EXPECT_TRUE(made);
      host_.renderables.emplace(node, std::move(*made));
    }
  }
  ~GlobeScripts() override {
    host_.renderables.clear();  // before the module, whose services they use
    std::filesystem::remove_all(host_.folder);
  }

  Value value(const std::string& call) {
    const auto values = engine_.evaluate("openspace.globebrowsing." + call, "test.lua");
    return !values ? Value(values.error().message()) : values->empty() ? Value() : values->front();
  }
  std::string run(const std::string& call) {
    const auto done = engine_.run("openspace.globebrowsing." + call, "test.lua");
    return done ? "" : done.error().message();
  }
  void write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = std::filesystem::path(host_.folder) / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file) << text;
  }
  LayerGroup& group(const std::string& node, LayerGroupId id) {
    return dynamic_cast<RenderableGlobe&>(*host_.renderable(node)).layers().group(id);
  }

  Paths paths_;
  Statistics statistics_;
  FakeHost host_{paths_, statistics_};
  std::unique_ptr<Module> module_ = makeModule();
  scripting::ScriptEngine engine_;
};

/// The text at a path of an XML document, by GDAL's parser.
std::string xmlAt(const Value& document, const char* path) {
  CPLXMLTreeCloser tree(CPLParseXMLString(document.string() != nullptr ? document.string()->c_str() : ""));
  const char* found = tree ? CPLGetXMLValue(tree.get(), path, "nothing") : "no XML";
  return found;
}

TEST_F(GlobeScripts, DescribesGibsLayers) {
  const Value daily = value("createTemporalGibsGdalXml('MODIS_Terra', '250m', 'jpg')");
  EXPECT_EQ(xmlAt(daily, "=GDAL_WMS.Service.ServerUrl"),
            "https://gibs.earthdata.nasa.gov/wmts/epsg4326/best/MODIS_Terra/default/${OpenSpaceTimeId}/250m/${z}/${y}/"
            "${x}.jpg");
  EXPECT_EQ(xmlAt(daily, "=GDAL_WMS.DataWindow.TileLevel"), "8");
  EXPECT_EQ(xmlAt(daily, "=GDAL_WMS.DataWindow.LowerRightX"), "396.0");
  EXPECT_EQ(xmlAt(daily, "=GDAL_WMS.BandsCount"), "3");
  const Value oneDay = value("createGibsGdalXml('Coastlines', '2020-01-02', '15.625m', 'png')");
  EXPECT_THAT(xmlAt(oneDay, "=GDAL_WMS.Service.ServerUrl"), HasSubstr("/Coastlines/default/2020-01-02/15.625m/"));
  EXPECT_EQ(xmlAt(oneDay, "=GDAL_WMS.DataWindow.TileLevel"), "12");
  EXPECT_EQ(xmlAt(oneDay, "=GDAL_WMS.BandsCount"), "4");
  EXPECT_EQ(xmlAt(value("createGibsGdalXml('ASTER_GDEM_Greyscale_Shaded_Relief', '', '31.25m', 'jpg')"),
                  "=GDAL_WMS.BandsCount"),
            "1");
  const Value older = value("createTemporalGibsGdalXml('L', '2000-02-24', 'Today', '1d', '2km', 'png')");
  EXPECT_EQ(xmlAt(older, "=OpenSpaceTemporalGDALDataset.OpenSpaceTimeStart"), "2000-02-24");
  EXPECT_EQ(xmlAt(older, "=OpenSpaceTemporalGDALDataset.OpenSpaceTimeEnd"), "Today");
  EXPECT_EQ(xmlAt(older, "=OpenSpaceTemporalGDALDataset.OpenSpaceTimeResolution"), "1d");
  EXPECT_EQ(xmlAt(older, "=OpenSpaceTemporalGDALDataset.OpenSpaceTimeIdFormat"), "YYYY-MM-DD");
  EXPECT_EQ(xmlAt(older, "=OpenSpaceTemporalGDALDataset.GDAL_WMS.DataWindow.TileLevel"), "5");
  EXPECT_EQ(value("createGibsGdalXml('L', '2020-01-02', '3km', 'png')"), Value(""));
  EXPECT_EQ(value("createGibsGdalXml('L', '2020-01-02', '2km', 'tif')"), Value(""));
  EXPECT_THAT(run("createTemporalGibsGdalXml('L', 'a', 'b', 'c')"), HasSubstr("6 to 7"));
}

TEST_F(GlobeScripts, LayersThatAreWrongAreDroppedAndKept) {
  EXPECT_EQ(run("addLayer('Earth', 'ColorLayers', { Identifier = 'A', FilePath = 'a.tif' })"), "");
  EXPECT_EQ(run("addLayer('Earth', 'ColorLayers', { Identifier = 'A', FilePath = 'b.tif' })"), "")
      << "the name is taken";
  EXPECT_EQ(run("addLayer('Earth', 'ColorLayers', { Identifier = 'B', Type = 'NoSuchType' })"), "");
  EXPECT_THAT(run("addLayer('Earth', 'NoSuchLayers', { Identifier = 'C' })"), HasSubstr("unknown layer group"));
  EXPECT_THAT(run("addLayer('Pluto', 'ColorLayers', { Identifier = 'C' })"), HasSubstr("no globe"));
  EXPECT_THAT(run("addLayer('Earth', 'ColorLayers', 'C')"), HasSubstr("must be a table"));
  const Renderable::Contents contents = host_.renderable("Earth")->contents();
  ASSERT_EQ(contents.layers.size(), 2U);
  EXPECT_EQ(contents.layers[0].name, "ColorLayers.A");
  EXPECT_THAT(contents.layers[0].unusable->message(), HasSubstr(host_.folder + "/a.tif")) << "beside the asset";
  EXPECT_THAT(contents.layers[1].unusable->message(), HasSubstr("NoSuchType"));
}

TEST_F(GlobeScripts, WhatAnAssetAddedCanBeTakenBack) {
  const std::string add = "addLayer('Earth', 'ColorLayers', { Identifier = 'A', FilePath = 'a.tif' })";
  host_.isAsset = true;
  ASSERT_EQ(run(add), "");
  const auto takeBack = host_.registrations.at("layer Earth ColorLayers A");
  host_.registrations.clear();
  ASSERT_EQ(run(add), "") << "it is left out";
  EXPECT_TRUE(host_.registrations.empty());
  takeBack();
  EXPECT_TRUE(group("Earth", LayerGroupId::ColorLayers).layers().empty());
  takeBack();
  host_.place = "other.lua:1";
  ASSERT_EQ(run(add), "");
  takeBack();
  EXPECT_EQ(group("Earth", LayerGroupId::ColorLayers).layers().size(), 1U) << "that is another one";

  const std::string addGeoJson = "addGeoJson('Earth', { Identifier = 'G', File = 'g.json' })";
  ASSERT_EQ(run(addGeoJson), "");
  EXPECT_NE(run(addGeoJson), "");
  host_.registrations.at("GeoJSON Earth G")();
  EXPECT_EQ(run(addGeoJson), "");
}

TEST_F(GlobeScripts, UnknownKeysAreNoted) {
  EXPECT_EQ(run("addLayer('Earth', 'ColorLayers', { Identifier = 'A', FilePath = 'a.tif', Enable = true, PadTiles = "
                "false, Strange = 1 })"),
            "");
  const std::vector<Error> notes = host_.renderable("Earth")->contents().notes;
  ASSERT_EQ(notes.size(), 2U);
  EXPECT_THAT(notes[0].message(), HasSubstr("unknown key Enable, did you mean Enabled"));
  EXPECT_THAT(notes[1].message(), HasSubstr("unknown key Strange"));
}

TEST_F(GlobeScripts, AddsPatchesOfAFolder) {
  write("patches/a/one.info",
        "local path = 'one'\nName = 'Patch One'\nIdentifier = 'One'\nColorFile = path .. '_color.vrt'\n"
        "HeightFile = path .. '_height.vrt'\nLocation = { Center = { 12.5, -4.5 } }\nZIndex = 7");
  write("patches/two.info", "Name = 'Two'\nColorFile = 'two.vrt'\nBlendMode = 'Normal'");
  write("patches/broken.info", "Name = ");
  write("patches/nameless.info", "ColorFile = 'x.vrt'");
  EXPECT_EQ(run("addBlendingLayersFromDirectory('patches', 'Moon')"), "");
  LayerGroup& colours = group("Moon", LayerGroupId::ColorLayers);
  ASSERT_EQ(colours.layers().size(), 2U);
  ASSERT_NE(colours.find("One"), nullptr);
  EXPECT_EQ(colours.find("One")->zIndex(), 7);
  EXPECT_EQ(colours.find("One")->blend(), BlendMode::Color);
  EXPECT_EQ(*colours.find("One")->request().table.find("FilePath")->string(),
            host_.folder + "/patches/a/one_color.vrt");
  EXPECT_EQ(colours.find("Two")->blend(), BlendMode::Normal);
  ASSERT_NE(group("Moon", LayerGroupId::HeightLayers).find("One"), nullptr);
  EXPECT_EQ(run("addFocusNodesFromDirectory('patches', 'Moon')"), "");
  ASSERT_EQ(host_.addedNodes.size(), 1U);
  const Value* translation = host_.addedNodes[0].find("Transform")->find("Translation");
  EXPECT_EQ(*translation->find("Latitude"), Value(-4.5));
  EXPECT_EQ(*translation->find("Longitude"), Value(12.5));
  EXPECT_EQ(*host_.addedNodes[0].find("Identifier"), Value("Patch_One"));
  const Value parsed = value("parseInfoFile('patches/a/one.info')");
  EXPECT_EQ(*parsed.find("Height")->find("TilePixelSize"), Value(65));
  EXPECT_EQ(*parsed.find("Name"), Value("Patch One"));
  EXPECT_THAT(run("parseInfoFile('patches/broken.info')"), HasSubstr("broken.info:1"));
  EXPECT_EQ(run("addBlendingLayersFromDirectory('nowhere', 'Moon')"), "");
  EXPECT_THAT(run("addBlendingLayersFromDirectory('patches', 'Pluto')"), HasSubstr("no globe"));
}

TEST_F(GlobeScripts, AddsFocusNodes) {
  EXPECT_EQ(run("addFocusNodeFromLatLong('Some place', 'Earth', 1.5, 2.5, 300)"), "");
  ASSERT_EQ(host_.addedNodes.size(), 1U);
  EXPECT_EQ(*host_.addedNodes[0].find("Parent"), Value("Earth"));
  EXPECT_EQ(*host_.addedNodes[0].find("Transform")->find("Translation")->find("Altitude"), Value(300));
  EXPECT_THAT(run("addFocusNodeFromLatLong('x', 'Earth', 'north', 2)"), HasSubstr("latitude must be a finite number"));
}

TEST_F(GlobeScripts, KeepsMapServers) {
  write("servers.lua", "return { Moon = { { Name = 'M1', URL = 'https://a' }, { Name = 'M2', URL = 'https://b' } } }");
  EXPECT_EQ(run("loadWMSServersFromFile('servers.lua')"), "");
  EXPECT_EQ(run("loadWMSCapabilities('M0', 'Moon', 'https://c')"), "");
  EXPECT_EQ(value("urlInfo('Moon')[1].name"), Value("M0"));
  EXPECT_EQ(value("urlInfo('Moon')[3].url"), Value("https://b"));
  EXPECT_EQ(value("urlInfo('Earth')"), Value(Table{}));
  const Value globes = value("globes()");
  EXPECT_EQ(globes, listOf({listOf({"Moon", "Earth"}), 2}));
  EXPECT_EQ(value("capabilitiesWMS('M1')"), Value(Table{}));
  EXPECT_EQ(run("removeWMSServer('M1') openspace.globebrowsing.removeWMSServer('M1')"), "");
  write("bad.lua", "return { Moon = { { Name = 'M1' } } }");
  EXPECT_THAT(run("loadWMSServersFromFile('bad.lua')"), HasSubstr("Moon[1]"));
}

TEST_F(GlobeScripts, AScriptTakesALayerOfAServerThatItNamedJustNow) {
  write("capabilities.xml", R"(<WMS_Capabilities version="1.3.0"><Capability><Request><GetMap><Format>image/png</Format>
      <DCPType><HTTP><Get><OnlineResource xlink:href="http://127.0.0.1:9/wms?" xmlns:xlink="http://www.w3.org/1999/xlink"/>
      </Get></HTTP></DCPType></GetMap></Request><Layer><CRS>EPSG:4326</CRS><Layer><Name>clouds</Name><Title>Clouds</Title>
      </Layer></Layer></Capability></WMS_Capabilities>)");
  EXPECT_EQ(run("loadWMSCapabilities('Own', 'Earth', '" + host_.folder + R"(/capabilities.xml')
      for _, layer in ipairs(openspace.globebrowsing.capabilitiesWMS('Own')) do
        openspace.globebrowsing.addLayer('Earth', 'ColorLayers', { Identifier = layer.Name, FilePath = layer.URL })
      end)"),
            "");
  EXPECT_TRUE(engine_.hasWaiting()) << "nothing is read on the render thread";
  while (engine_.hasWaiting()) {
    EXPECT_TRUE(engine_.resumeWaiting().empty());
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_NE(group("Earth", LayerGroupId::ColorLayers).find("Clouds"), nullptr);
}

TEST_F(GlobeScripts, AScriptGoesOnWhenTheServerItWaitsForIsForgotten) {
  EXPECT_EQ(run("loadWMSCapabilities('Gone', 'Earth', '/no/such/file.xml')"
                " list = openspace.globebrowsing.capabilitiesWMS('Gone')"),
            "");
  EXPECT_TRUE(engine_.hasWaiting());
  EXPECT_EQ(run("removeWMSServer('Gone')"), "");
  EXPECT_TRUE(engine_.resumeWaiting().empty());
  EXPECT_FALSE(engine_.hasWaiting());
  EXPECT_EQ(engine_.evaluate("#list", "test")->front(), Value(0));
}

TEST_F(GlobeScripts, KeepsGeoJson) {
  EXPECT_EQ(run("addGeoJson('Earth', { Identifier = 'Borders', File = 'b.geojson' })"), "");
  EXPECT_THAT(run("addGeoJson('Earth', { Identifier = 'Borders', File = 'b.geojson' })"), HasSubstr("already"));
  EXPECT_EQ(run("addGeoJson('Moon', { Identifier = 'Borders', File = 'b.geojson' })"), "");
  EXPECT_EQ(run("deleteGeoJson('Earth', { Identifier = 'Borders' })"), "");
  EXPECT_THAT(run("deleteGeoJson('Earth', 'Borders')"), HasSubstr("no GeoJSON"));
  EXPECT_THAT(run("addGeoJson('Earth', { Identifier = 'X' })"), HasSubstr("File"));
  EXPECT_EQ(run("addGeoJsonFromFile('b.geojson')"), "");
}

TEST(MapServers, OfferWhatTheirLoaderFinds) {
  MapServers servers;
  std::vector<std::function<void(MapServers::Offer)>> waiting;
  servers.setLoader([&](const MapServer&, auto done) { waiting.push_back(std::move(done)); });
  servers.add({"S", "Earth", "https://a"});
  EXPECT_THAT(servers.offered("S").error().message(), HasSubstr("not arrived"));
  servers.add({"S", "Earth", "https://b"});
  waiting.at(0)(ServerOffer{{{"Old", "WMS:a"}}});
  EXPECT_FALSE(servers.offered("S")) << "the answer of a server that was replaced";
  waiting.at(1)(ServerOffer{{{"New", "WMS:b"}}});
  ASSERT_TRUE(servers.offered("S"));
  EXPECT_EQ(servers.offered("S")->layers.front().url, "WMS:b");
  servers.add({"Bad", "Earth", "https://c"});
  waiting.at(2)(failure("refused", "https://c"));
  EXPECT_THAT(servers.offered("Bad").error().message(), HasSubstr("refused"));
  EXPECT_TRUE(servers.remove("S"));
  EXPECT_FALSE(servers.remove("S"));
  EXPECT_FALSE(servers.offered("S"));
}

}  // namespace
}  // namespace meridian::globebrowsing
