// The panel of map servers, driven as a user does; what it writes is loaded again.
#include "globebrowsing/map_server_panel.h"

#include <fstream>
#include <set>

#include <gmock/gmock.h>

#include "globe_fixture.h"
#include "globebrowsing/layers_file.h"
#include "host/scripting/script_engine.h"

namespace meridian::globebrowsing {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Opens the sections and presses the buttons that it is told to: "SECTION/BUTTON", by the innermost section; with or
/// without what tells apart those that are called the same.
class Hand final : public PanelBuilder {
 public:
  void text(std::string_view text) override { texts.emplace_back(text); }
  void warning(std::string_view text) override { warnings.emplace_back(text); }
  void property(Property& property) override { properties[property.identifier()] = &property; }
  [[nodiscard]] bool button(std::string_view label) override {
    const std::string whole = sections_.back() + '/' + std::string(label);
    buttons.push_back(shown(sections_.back()) + '/' + shown(label));
    note(label);
    return whole == pressed || buttons.back() == pressed;
  }
  [[nodiscard]] bool beginSection(std::string_view title) override {
    note(title);
    sections.push_back(shown(title));
    sections_.emplace_back(title);
    return true;
  }
  void endSection() override { sections_.pop_back(); }

  std::string pressed;
  std::vector<std::string> texts;
  std::vector<std::string> warnings;
  std::vector<std::string> sections;
  std::vector<std::string> buttons;
  std::map<std::string, Property*> properties;

 private:
  static std::string shown(std::string_view label) { return std::string(label.substr(0, label.find("##"))); }
  /// Of two widgets of one label in one section a user could reach only the first.
  void note(std::string_view label) {
    std::string path;
    for (const std::string& section : sections_) {
      path += section + '\n';
    }
    EXPECT_TRUE(labels_.insert(path + std::string(label)).second) << label;
  }

  std::vector<std::string> sections_{""};
  std::set<std::string> labels_;
};

class MapServerPanelTest : public testing::Test {
 protected:
  MapServerPanelTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "meridian-panel-XXXXXX").string();
    host_.folder = ::mkdtemp(pattern.data());
    EXPECT_TRUE(module_->initialize(host_));
    for (const ScriptLibrary& library : host_.libraries) {
      engine_.registerLibrary(library);
    }
    addGlobe("Earth");
    servers_.setLoader([this](const MapServer& server, auto done) { asked_.emplace_back(server, std::move(done)); });
  }
  ~MapServerPanelTest() override {
    host_.renderables.clear();
    std::filesystem::remove_all(host_.folder);
  }

  void addGlobe(const std::string& node) {
    host_.renderables[node] =
        std::move(*host_.factories.at("RenderableGlobe")({tableOf({{"Radii", 1e6}}), "test.asset:1", "/", node}));
  }
  RenderableGlobe& globe(const std::string& node) { return dynamic_cast<RenderableGlobe&>(*host_.renderable(node)); }
  Hand build(const std::string& pressed = {}) {
    Hand hand;
    hand.pressed = pressed;
    panel_.build(hand);
    return hand;
  }
  void set(const std::string& property, const Value& value) {
    ASSERT_TRUE(build().properties.at(property)->set(value)) << property;
  }
  static std::string textOf(const Layer& layer) { return *layer.table().find("FilePath")->string(); }
  static OfferedLayer offered(const std::string& name, const std::vector<std::string>& styles) {
    OfferedLayer layer{name, "<GDAL_WMS/>"};
    layer.extent = Extent{-0.5, -0.25, 0.5, 0.25};
    layer.times = "2000-01-01/2020-01-01/P1D";
    layer.attribution = "Somebody";
    for (const std::string& style : styles) {
      layer.styles.push_back({style, tableOf({{"Identifier", name},
                                              {"Name", name},
                                              {"Attribution", "Somebody"},
                                              {"FilePath", "http://localhost:9/" + style + "/{z}/{x}/{y}.png"},
                                              {"Enabled", false}})});
    }
    return layer;
  }

  Paths paths_;
  Statistics statistics_;
  FakeHost host_{paths_, statistics_};
  std::unique_ptr<Module> module_ = makeModule();
  scripting::ScriptEngine engine_;
  MapServers servers_;
  std::vector<std::pair<MapServer, std::function<void(MapServers::Offer)>>> asked_;
  MapServerPanel panel_{host_, servers_};
};

TEST_F(MapServerPanelTest, LoadsAServerAndListsWhatItOffers) {
  set("Url", " https://maps/capabilities");
  build("New server/Load");
  ASSERT_EQ(asked_.size(), 1U);
  EXPECT_EQ(asked_[0].first.url, "https://maps/capabilities");
  EXPECT_EQ(asked_[0].first.globe, "Earth");
  EXPECT_THAT(build().texts, Contains("loading ..."));
  OfferedLayer broken{"Broken", ""};
  broken.obstacle = "it has no tiles";
  asked_[0].second(
      ServerOffer{{offered("Clouds", {"plain"}), offered("Ice", {"a", "b"}), broken}, "1 of 3 documents was left out"});
  const Hand all = build();
  EXPECT_THAT(all.texts, testing::IsSupersetOf({"3 of 3 layers", "times 2000-01-01/2020-01-01/P1D", "Somebody",
                                                "west -28.65, south -14.32, east 28.65, north 14.32"}));
  EXPECT_THAT(all.buttons, testing::IsSupersetOf({"Clouds/Add", "Ice/Add, style a", "Ice/Add, style b"}));
  EXPECT_THAT(all.warnings, ElementsAre("1 of 3 documents was left out", HasSubstr("it has no tiles")));
  set("Filter", "iC");
  const Hand filtered = build();
  EXPECT_THAT(filtered.sections, testing::AllOf(Contains("Ice"), testing::Not(Contains("Clouds"))));
  EXPECT_THAT(filtered.texts, Contains("1 of 3 layers"));
}

TEST_F(MapServerPanelTest, LayersAndStylesOfOneNameAreEachAdded) {
  servers_.add({"New server", "Earth", "https://maps"});
  asked_[0].second(ServerOffer{{offered("Ice", {"a"}), offered("Ice", {"b", "b"})}});
  build("Ice##1/Add, style b##1");
  build("Ice##0/Add##0");
  const LayerGroup& group = globe("Earth").layers().group(LayerGroupId::ColorLayers);
  ASSERT_EQ(group.layers().size(), 2U);
  EXPECT_EQ(textOf(*group.layers()[0]), "http://localhost:9/b/{z}/{x}/{y}.png");
  EXPECT_EQ(textOf(*group.layers()[1]), "http://localhost:9/a/{z}/{x}/{y}.png");
}

TEST_F(MapServerPanelTest, SaysWhyAServerCannotBeUsedAndAsksAgain) {
  servers_.add({"S", "Earth", "https://maps"});
  asked_[0].second(failure("refused", "https://maps"));
  EXPECT_THAT(build().warnings, ElementsAre(HasSubstr("refused")));
  build("S/Load again");
  ASSERT_EQ(asked_.size(), 2U);
  EXPECT_THAT(build().warnings, IsEmpty());
  build("S/Forget");
  EXPECT_THAT(servers_.all(), IsEmpty());
}

TEST_F(MapServerPanelTest, ListsSoManyOnly) {
  servers_.add({"S", "Earth", "https://maps"});
  std::vector<OfferedLayer> many;
  for (int i = 0; i < 500; ++i) {
    many.push_back(offered("L" + std::to_string(i), {"s"}));
  }
  asked_[0].second(ServerOffer{many});
  const Hand hand = build();
  EXPECT_EQ(std::count_if(hand.sections.begin(), hand.sections.end(), [](auto& each) { return each.starts_with("L"); }),
            static_cast<std::ptrdiff_t>(MapServerPanel::mostListed));
  EXPECT_THAT(hand.texts, Contains(HasSubstr("500 of 500")));
}

TEST_F(MapServerPanelTest, WhatIsAddedIsWrittenAsAnAssetThatAddsItAgain) {
  addGlobe("Moon");
  servers_.add({"S", "Earth", "https://maps"});
  asked_[0].second(ServerOffer{{offered("Ice", {"a", "b"})}});
  EXPECT_THAT(build().buttons, testing::Not(Contains("Added layers/Write asset"))) << "there is nothing to write";
  set("Globe", "Moon");
  build("Ice/Add, style b");
  set("Group", "Overlays");
  build("Ice/Add, style a");
  build("Ice/Add, style a");
  EXPECT_EQ(globe("Earth").layers().layerCount(), 0U);
  const LayerGroup& overlays = globe("Moon").layers().group(LayerGroupId::Overlays);
  ASSERT_EQ(overlays.layers().size(), 2U);
  EXPECT_EQ(overlays.layers()[1]->identifier(), "Ice_2");
  overlays.layers()[0]->opacity.put(0.25);
  overlays.layers()[0]->blendMode.put(static_cast<int>(BlendMode::Multiply));
  overlays.layers()[0]->gamma.put(2.0);
  const Hand hand = build();
  EXPECT_THAT(hand.texts, Contains("ColorLayers.Ice: not opened"));

  // Loaded into a Moon without layers.
  set("File", "layers/moon.asset");
  EXPECT_THAT(build("Added layers/Write asset").warnings, IsEmpty());
  const std::filesystem::path file = std::filesystem::path(host_.folder) / "layers/moon.asset";
  EXPECT_THAT(build().texts, Contains("written: " + file.string()));
  addGlobe("Moon");
  host_.isAsset = true;
  std::ifstream stream(file);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const std::string frame =
      "begin, finish = nil, nil asset = { export = function() end, "
      "onInitialize = function(f) begin = f end, onDeinitialize = function(f) finish = f end }\n";
  ASSERT_TRUE(engine_.run(frame + text + "\nbegin()", "moon.asset")) << text;
  ASSERT_EQ(globe("Moon").layers().layerCount(), 3U);
  const Layer& again = *globe("Moon").layers().group(LayerGroupId::Overlays).layers()[0];
  EXPECT_EQ(again.identifier(), "Ice");
  EXPECT_EQ(again.opacity.get(), 0.25);
  EXPECT_EQ(again.blend(), BlendMode::Multiply);
  EXPECT_EQ(again.gamma.get(), 2.0);
  EXPECT_EQ(again.attribution.get(), "Somebody");
  EXPECT_EQ(*again.table().find("FilePath")->string(), "http://localhost:9/a/{z}/{x}/{y}.png");
  EXPECT_THAT(usersLayers(globe("Moon")), IsEmpty()) << "an asset's are not written once more";
  ASSERT_TRUE(engine_.run(frame + text + "\nfinish()", "moon.asset"));
  EXPECT_EQ(globe("Moon").layers().layerCount(), 0U);
}

TEST_F(MapServerPanelTest, ScriptsWriteTheLayersThatScriptsAdded) {
  const auto write = [this](const std::string& file) {
    const auto done = engine_.evaluate("openspace.globebrowsing.writeLayers('Earth', '" + file + "')", "test.lua");
    return done ? *done->front().string() : done.error().message();
  };
  EXPECT_THAT(write("a.asset"), HasSubstr("no layers were added"));
  ASSERT_TRUE(
      engine_.run("openspace.globebrowsing.addLayer('Earth', 'ColorLayers', "
                  "{ Identifier = 'A', FilePath = 'a.tif' })",
                  "test.lua"));
  EXPECT_THAT(write("../a.asset"), HasSubstr("may not write"));
  EXPECT_EQ(write("a.asset"), host_.folder + "/a.asset");
  std::ifstream stream(host_.folder + "/a.asset");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_THAT(text, HasSubstr(host_.folder + "/a.tif")) << "the asset lies elsewhere than the script";
}

TEST_F(MapServerPanelTest, WithoutGlobesItSaysSo) {
  host_.renderables.clear();
  EXPECT_EQ(build().texts.size(), 1U);
}

}  // namespace
}  // namespace meridian::globebrowsing
