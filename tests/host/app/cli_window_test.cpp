// The program in a real window, on a display of its own that Xvfb makes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli_fixture.h"
#include "host/graphics/image.h"

namespace meridian::app {
namespace {

class WindowCommandLine : public CommandLine {
 protected:
  void SetUp() override {
    if (std::system("command -v xvfb-run >/dev/null") != 0) {
      GTEST_SKIP() << "no xvfb-run; scripts/test installs it (Debian: xvfb, xauth)";
    }
  }
  Outcome runInWindow(const std::string& arguments) const {
    return run(arguments, "xvfb-run --auto-servernum --server-args '-screen 0 800x600x24'");
  }
};

TEST_F(WindowCommandLine, DrawsFramesWithItsPanels) {
  emptyScene();
  const Outcome outcome = runInWindow("empty.asset --size 320x240 --frames 5 --stats figures.json");
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors.find("no window"), std::string::npos) << outcome.errors;
  EXPECT_EQ(nlohmann::json::parse(readFile(in("figures.json"))).at("frames"), 5);
}

TEST_F(WindowCommandLine, ShowsTheGlobeOfAnAsset) {
  write("globe.asset", R"(
    local globe = { Identifier = "Ball", Renderable = { Type = "RenderableGlobe", Radii = 1e6, PerformShading = false,
      Layers = { ColorLayers = { { Identifier = "Green", Type = "SolidColor", Color = { 0, 0.8, 0 }, Enabled = true } } } } }
    asset.onInitialize(function() openspace.addSceneGraphNode(globe) end)
  )");
  const Outcome outcome = runInWindow(
      "globe.asset --anchor Ball --camera 0,0,2e6 --size 320x240 --frames 2 --settle 60 --output picture.png");
  if (outcome.errors.find("globes need the module") != std::string::npos) {
    GTEST_SKIP() << "built without the module that brings globes";
  }
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors.find("no window"), std::string::npos) << outcome.errors;
  const auto picture = graphics::readPng(in("picture.png"));
  ASSERT_TRUE(picture) << picture.error().message();
  const auto pixel = [&](int x, int y) {
    const std::size_t at = 4 * (static_cast<std::size_t>(y) * 320 + static_cast<std::size_t>(x));
    return std::vector<int>(picture->pixels.begin() + static_cast<std::ptrdiff_t>(at),
                            picture->pixels.begin() + static_cast<std::ptrdiff_t>(at) + 3);
  };
  EXPECT_EQ(pixel(160, 120), (std::vector{0, 204, 0}));
  EXPECT_EQ(pixel(5, 5), (std::vector{0, 0, 0}));
}

}  // namespace
}  // namespace meridian::app
