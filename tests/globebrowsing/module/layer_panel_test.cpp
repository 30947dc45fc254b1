// The panel of layers, as the module registers it.
#include <gmock/gmock.h>

#include "globe_fixture.h"

namespace meridian::globebrowsing {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Key;
using testing::Not;

/// Opens all sections and notes the properties in them by their path, "Earth/ColorLayers/Blue/Enabled".
class Reader final : public PanelBuilder {
 public:
  void text(std::string_view text) override { texts.emplace_back(text); }
  void warning(std::string_view text) override { warnings.emplace_back(text); }
  void property(Property& property) override { properties[path_ + property.identifier()] = &property; }
  [[nodiscard]] bool button(std::string_view /*label*/) override { return false; }
  [[nodiscard]] bool beginSection(std::string_view title) override {
    lengths_.push_back(path_.size());
    path_ += std::string(title.substr(0, title.find("##"))) + '/';
    return true;
  }
  void endSection() override {
    path_.resize(lengths_.back());
    lengths_.pop_back();
  }

  std::vector<std::string> texts;
  std::vector<std::string> warnings;
  std::map<std::string, Property*> properties;

 private:
  std::string path_;
  std::vector<std::size_t> lengths_;
};

class LayerPanelTest : public testing::Test {
 protected:
  LayerPanelTest() { EXPECT_TRUE(module_->initialize(host_)); }
  ~LayerPanelTest() override { host_.renderables.clear(); }

  RenderableGlobe& addGlobe(const std::string& node, Fields layers) {
    auto made = host_.factories.at("RenderableGlobe")(
        {tableOf({{"Radii", 1e6}, {"Layers", tableOf(std::move(layers))}}), "test.asset:1", "/", node});
    EXPECT_TRUE(made) << (made ? "" : made.error().message());
    host_.renderables[node] = std::move(*made);
    return dynamic_cast<RenderableGlobe&>(*host_.renderables[node]);
  }
  Reader read() {
    const auto panel = std::find_if(host_.panels.begin(), host_.panels.end(),
                                    [](const auto& candidate) { return candidate->title() == "Layers"; });
    Reader reader;
    EXPECT_NE(panel, host_.panels.end());
    if (panel != host_.panels.end()) {
      (*panel)->build(reader);
    }
    return reader;
  }
  void set(const std::string& path, const Value& value) {
    const Reader reader = read();
    const auto found = reader.properties.find(path);
    ASSERT_NE(found, reader.properties.end()) << path;
    ASSERT_TRUE(found->second->set(value)) << path;
  }

  Paths paths_;
  Statistics statistics_;
  FakeHost host_{paths_, statistics_};
  std::unique_ptr<Module> module_ = makeModule();
};

TEST_F(LayerPanelTest, TogglesLayersAndSetsTheirOpacityAndSettings) {
  RenderableGlobe& earth =
      addGlobe("Earth", {{"ColorLayers", listOf({solidLayer("Blue", {0, 0, 1}), solidLayer("Red", {1, 0, 0})})},
                         {"Overlays", listOf({solidLayer("Grid", {1, 1, 1})})}});
  RenderableGlobe& moon = addGlobe("Moon", {{"ColorLayers", listOf({solidLayer("Blue", {0, 0, 1})})}});
  LayerGroup& colours = earth.layers().group(LayerGroupId::ColorLayers);
  const Layer& moons = *moon.layers().group(LayerGroupId::ColorLayers).find("Blue");
  Layer& blue = *colours.find("Blue");
  ASSERT_EQ(colours.enabledLayers().size(), 2U);

  set("Earth/ColorLayers/Blue/Enabled", false);
  EXPECT_EQ(colours.enabledLayers().size(), 1U);
  EXPECT_EQ(colours.enabledLayers().front()->identifier(), "Red");
  EXPECT_TRUE(moons.enabled.get()) << "the other globe's layer of that name";
  set("Earth/ColorLayers/Blue/Enabled", true);
  set("Earth/ColorLayers/Blue/Opacity", 0.25);
  EXPECT_EQ(blue.effectiveOpacity(), 0.25);
  EXPECT_EQ(moons.effectiveOpacity(), 1.0);
  set("Earth/ColorLayers/Blue/Gamma", 2.0);
  EXPECT_EQ(blue.settings().gamma, 2.0);
  set("Earth/Overlays/Grid/BlendMode", "Multiply");
  EXPECT_EQ(earth.layers().group(LayerGroupId::Overlays).find("Grid")->blend(), BlendMode::Multiply);
  set("Moon/Enabled", false);
  EXPECT_FALSE(moon.enabled.get());
}

TEST_F(LayerPanelTest, ShowsGroupsThatHaveLayersAndWhatIsWrongWithThem) {
  RenderableGlobe& earth = addGlobe("Earth", {{"ColorLayers", listOf({fileLayer("Map", "/nowhere/map.tif")})}});
  EXPECT_THAT(read().properties, Contains(Key("Earth/ColorLayers/Map/Enabled")));
  EXPECT_THAT(read().properties, Not(Contains(Key(HasSubstr("NightLayers")))));
  EXPECT_THAT(read().warnings, IsEmpty());
  earth.layers().group(LayerGroupId::ColorLayers).find("Map")->lastError.put("/nowhere/map.tif: no such file");
  EXPECT_THAT(read().warnings, Contains(HasSubstr("no such file")));
  ASSERT_TRUE(earth.layers().deleteLayer("ColorLayers", "Map"));
  EXPECT_THAT(read().properties, Not(Contains(Key(HasSubstr("ColorLayers")))));
}

}  // namespace
}  // namespace meridian::globebrowsing
