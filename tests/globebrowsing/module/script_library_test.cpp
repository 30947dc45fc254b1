#include <gmock/gmock.h>

#include "globe_fixture.h"
#include "host/scripting/script_engine.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;

class ScriptLibraryTest : public GlobeTest {
 protected:
  void SetUp() override {
    GlobeTest::SetUp();
    if (!graphics_) {
      return;
    }
    for (const ScriptLibrary& library : host_->libraries) {
      engine_.registerLibrary(library);
    }
    globe_ = &addGlobe({{"ColorLayers", listOf({solidLayer("A", {1, 0, 0}), solidLayer("B", {0, 1, 0})})}});
  }
  void run(const std::string& script) {
    const Result<void> result = engine_.run(script, "test.lua");
    EXPECT_TRUE(result) << (result ? "" : result.error().message());
  }
  [[nodiscard]] std::string layers() {
    const auto found = engine_.evaluate("openspace.globebrowsing.layers('Globe', 'ColorLayers')", "test.lua");
    return found ? found->front().toLua() : found.error().message();
  }
  scripting::ScriptEngine engine_;
  RenderableGlobe* globe_ = nullptr;
};

TEST_F(ScriptLibraryTest, AddsDeletesListsAndMovesLayers) {
  EXPECT_EQ(layers(), listOf({"A", "B"}).toLua());
  run("openspace.globebrowsing.addLayer('Globe', 'ColorLayers', "
      "{ Identifier = 'C', Type = 'SolidColor', Color = { 0, 0, 1 }, Enabled = true })");
  EXPECT_EQ(layers(), listOf({"A", "B", "C"}).toLua());
  run("openspace.globebrowsing.moveLayer('Globe', 'ColorLayers', 'C', 'A')");
  EXPECT_EQ(layers(), listOf({"C", "A", "B"}).toLua());
  run("openspace.globebrowsing.moveLayer('Globe', 'ColorLayers', 0, 2)");
  EXPECT_EQ(layers(), listOf({"A", "B", "C"}).toLua());
  run("openspace.globebrowsing.deleteLayer('Globe', 'ColorLayers', 'A')");
  run("openspace.globebrowsing.deleteLayer('Globe', 'ColorLayers', { Identifier = 'B' })");
  EXPECT_EQ(layers(), listOf({"C"}).toLua());
  run("openspace.globebrowsing.deleteLayer('Globe', 'ColorLayers', 'C')");
  ASSERT_TRUE(settle());
  EXPECT_NEAR(centre()[0], 76, 1);
}

TEST_F(ScriptLibraryTest, ListsGlobes) {
  addGlobe({}, {}, "Another");
  const auto found = engine_.evaluate("openspace.globebrowsing.globes()", "test.lua");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->front(), listOf({listOf({"Another", "Globe"}), 1}));
}

TEST_F(ScriptLibraryTest, WrongArgumentsGiveAnErrorWithItsPlaceAndChangeNothing) {
  struct Case {
    const char* call;
    const char* says;
  };
  for (const Case& wrong : {
           Case{"addLayer('Nowhere', 'ColorLayers', {})", "there is no globe \"Nowhere\""},
           Case{"addLayer(3, 'ColorLayers', {})", "must be a string"},
           Case{"addLayer('Globe', 'Colours', {})", "Colours"},
           Case{"addLayer('Globe', 'ColorLayers', 'A')", "table"},
           Case{"addLayer('Globe')", "addLayer"},
           Case{"deleteLayer('Globe', 'ColorLayers', 'Z')", "Z"},
           Case{"deleteLayer('Globe', 'ColorLayers', {})", "must be a string"},
           Case{"deleteLayer('Globe', nil, 'A')", "must be a string"},
           Case{"layers('Globe', 'Colours')", "Colours"},
           Case{"layers('Globe', 7)", "must be a string"},
           Case{"moveLayer('Globe', 'Colours', 'A', 'B')", "Colours"},
           Case{"moveLayer('Globe', 'ColorLayers', 'A', 'Z')", "Z"},
           Case{"moveLayer('Globe', 'ColorLayers', 'Z', 'A')", "Z"},
           Case{"moveLayer('Globe', 'ColorLayers', 0, 2)", "2"},
           Case{"moveLayer('Globe', 'ColorLayers', 0.5, 1)", "0.5"},
           Case{"moveLayer('Globe', 'ColorLayers', -1, 1)", "-1"},
           Case{"moveLayer('Globe', 'ColorLayers', 0/0, 1)", "nan"},
           Case{"moveLayer('Globe', 'ColorLayers', {}, 1)", "must be a string"},
           Case{"globes('x')", "globes"},
       }) {
    const Result<void> result = engine_.run(std::string("\nopenspace.globebrowsing.") + wrong.call, "test.lua");
    ASSERT_FALSE(result) << wrong.call;
    EXPECT_THAT(result.error().message(), HasSubstr(wrong.says)) << wrong.call;
    EXPECT_THAT(result.error().where, HasSubstr("test.lua:2")) << wrong.call << ": " << result.error().message();
    EXPECT_EQ(layers(), listOf({"A", "B"}).toLua()) << wrong.call;
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
