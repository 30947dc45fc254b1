// What --validate says of assets, as a user reads it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli_fixture.h"

namespace meridian::app {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(CommandLine, ValidateCountsAndEndsWithThree) {
  write("assets/good.asset", "asset.export('number', 3)\n");
  write("assets/below/bad.asset", "local = 3\n");
  const Outcome bad = run("--validate assets");
  EXPECT_EQ(bad.code, 3);
  EXPECT_EQ(bad.out, "assets 1 ok 1 failed; globes 0; layers 0 usable 0\n");
  EXPECT_THAT(bad.errors, HasSubstr("bad.asset:1"));
  const Outcome good = run("--validate assets/good.asset");
  EXPECT_EQ(good.code, 0) << good.errors;
  EXPECT_EQ(good.out, "assets 1 ok 0 failed; globes 0; layers 0 usable 0\n");
  const Outcome missing = run("--validate nowhere");
  EXPECT_EQ(missing.code, 3);
  EXPECT_THAT(missing.errors, HasSubstr("nowhere"));
}

TEST_F(CommandLine, ValidateNamesLayersAndKnowsPathTokens) {
  write("assets/x.tif", "x");
  write("assets/globe.asset", R"(
    openspace.setPathToken("${MINE}", asset.directory)
    local globe = { Identifier = "G1", Renderable = { Type = "RenderableGlobe", Radii = 6e6, Layers = {
      ColorLayers = { { Identifier = "Here", FilePath = "${ASSETS}/x.tif" },
                      { Identifier = "Mine", FilePath = "${MINE}/x.tif" },
                      { Identifier = "Lost", FilePath = "${NOPE}/x.tif" },
                      { Identifier = "Bad", FilePath = "x.tif", ZIndex = 0 } } } } }
    local function add(layer) openspace.globebrowsing.addLayer("G1", "NightLayers", layer) end
    asset.onInitialize(function()
      openspace.addSceneGraphNode(globe)
      add({ Identifier = "Added", FilePath = "${ASSETS}/x.tif", CacheSettings = { Enabled = true } })
      add({ Identifier = "Wrong", FilePath = "x.tif", ZIndex = 0 })
      add({ FilePath = "x.tif" })
    end)
  )");
  const Outcome outcome = run("--validate assets");
  if (outcome.errors.find("globes need the module") != std::string::npos) {
    GTEST_SKIP() << "built without the module that brings globes";
  }
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  for (const char* line :
       {"G1 ColorLayers.Here is usable", "G1 ColorLayers.Mine is usable",
        "G1 ColorLayers.Lost is not usable: ", "ColorLayers.Lost.FilePath: unknown path token ${NOPE}",
        "G1 ColorLayers.Bad is not usable: ", "Renderable.Layers.ColorLayers.Bad.ZIndex: ",
        "G1 NightLayers.Added is usable", "G1 NightLayers.Wrong is not usable: ", "addLayer NightLayers.Wrong.ZIndex: ",
        "G1 NightLayers[3] is not usable: ", "addLayer NightLayers[3].Identifier: "}) {
    EXPECT_THAT(outcome.errors, HasSubstr(line));
  }
  EXPECT_THAT(outcome.errors, Not(HasSubstr("unknown key")));
}

TEST_F(CommandLine, ValidatesAssetsOfAllDialects) {
  const Outcome outcome = run("--validate '" MERIDIAN_SOURCE_FOLDER "/tests/host/app/dialects/assets'");
  if (outcome.errors.find("globes need the module") != std::string::npos) {
    GTEST_SKIP() << "built without the module that brings globes";
  }
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  // Current: 11 layers of its own, 5 added, 2 of a patch; middle: 11; old: 6.
  EXPECT_THAT(outcome.out, HasSubstr("assets 6 ok 0 failed; globes 4; layers 35 usable "));
  EXPECT_THAT(outcome.errors, HasSubstr("CurrentGlobe ColorLayers.Local is usable"));
  EXPECT_THAT(outcome.errors, HasSubstr("MiddleGlobe ColorLayers.Map is usable"));
  EXPECT_THAT(outcome.errors, HasSubstr("OldGlobe Overlays.Lines is usable"));
  EXPECT_THAT(outcome.errors, HasSubstr("OldGlobe ColorLayers.Grey is usable"));
  EXPECT_THAT(outcome.errors, HasSubstr("CurrentGlobe ColorLayers.Whole is not usable"));
  EXPECT_THAT(outcome.errors, HasSubstr("no videos are played"));
  EXPECT_THAT(outcome.errors, HasSubstr("unknown key Enable, did you mean Enabled"));
  EXPECT_THAT(outcome.errors, Not(HasSubstr("warning not available:"))) << "nothing asserted by the assets failed";
}

}  // namespace
}  // namespace meridian::app
