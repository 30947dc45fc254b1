#include <cstdlib>
#include <limits>

#include <gmock/gmock.h>

#include "globe_fixture.h"

namespace meridian::globebrowsing {
namespace {

using RenderableGlobeTest = GlobeTest;
using testing::HasSubstr;

TEST_F(RenderableGlobeTest, SchemaErrorsNameFileLineAndKey) {
  struct Case {
    const char* key;
    Value value;
  };
  const Value negative = listOf({-1.0, 1.0, 1.0});
  for (const Case& wrong :
       {Case{"Radii", "large"}, Case{"Radii", listOf({1.0, 2.0})}, Case{"Radii", 0.0}, Case{"Radii", negative},
        Case{"Opacity", 2.0}, Case{"Enabled", "yes"}, Case{"TargetLodScaleFactor", 0.0}, Case{"Layers", 3.0}}) {
    const auto made = create({{wrong.key, wrong.value}});
    ASSERT_FALSE(made) << wrong.key;
    EXPECT_THAT(made.error().where, HasSubstr("test.asset:7")) << made.error().message();
    EXPECT_THAT(made.error().message(), HasSubstr(std::string("Renderable.") + wrong.key));
  }
}

TEST_F(RenderableGlobeTest, AWrongLayerIsLeftOutAndTold) {
  RenderableGlobe& globe = addGlobe(
      {{"ColorLayers", listOf({solidLayer("Good", {0, 1, 0}), tableOf({{"Type", "SolidColor"}}),
                               solidLayer("Good", {1, 0, 0}), solidLayer("Other", {0, 0, 1}, {{"Opacity", 7.0}})})},
       {"NoSuchGroup", listOf({})}});
  ASSERT_EQ(globe.refusedLayers().size(), 4U);
  for (const auto& [name, error] : globe.refusedLayers()) {
    EXPECT_THAT(error.where, HasSubstr("test.asset:7")) << error.message();
    EXPECT_THAT(error.where, HasSubstr("Renderable.Layers." + name)) << error.message();
  }
  ASSERT_TRUE(settle());
  EXPECT_EQ(centre(), (Pixel{0, 255, 0}));
}

TEST_F(RenderableGlobeTest, TakesItsPropertiesFromTheTable) {
  RenderableGlobe& globe = addGlobe({}, {{"Opacity", 0.25}, {"Enabled", false}, {"AmbientIntensity", 0.5}});
  EXPECT_EQ(globe.opacity.get(), 0.25);
  EXPECT_FALSE(globe.enabled.get());
  EXPECT_EQ(globe.ambientIntensity.get(), 0.5);
  EXPECT_EQ(globe.radii(), glm::dvec3(radius));
}

TEST_F(RenderableGlobeTest, FadeMultipliesItsOpacity) {
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({solidLayer("White", {1, 1, 1})})}});
  ASSERT_TRUE(settle());
  EXPECT_EQ(centre()[0], 255);
  // Another program may have to be built first.
  const auto becomes = [this](int grey) { return framesUntil([&] { return std::abs(centre()[0] - grey) <= 1; }); };
  ASSERT_TRUE(globe.property("Fade")->set(0.5));
  EXPECT_TRUE(becomes(128));
  globe.opacity.put(0.5);
  EXPECT_TRUE(becomes(64));
  globe.fade.put(0.0);
  EXPECT_TRUE(becomes(0));
  globe.fade.put(1.0);
  EXPECT_TRUE(becomes(128));
}

TEST_F(RenderableGlobeTest, HasThePropertiesOfOpenSpacesGlobes) {
  RenderableGlobe& globe =
      addGlobe({{"ColorLayers", listOf({solidLayer("A", {1, 0, 0}), solidLayer("B", {0, 1, 0}, {{"Enabled", false}})})},
                {"Overlays", listOf({solidLayer("C", {0, 0, 1})})}},
               {{"Type", "RenderableGlobe"}, {"LightSourceNode", "Lamp"}, {"OrenNayarRoughness", 0.25}});
  EXPECT_EQ(globe.property("Type")->value(), Value("RenderableGlobe"));
  EXPECT_EQ(globe.lightSourceNode(), "Lamp");
  EXPECT_EQ(globe.property("OrenNayarRoughness")->value(), Value(0.25));
  frame();
  EXPECT_EQ(globe.property("NActiveLayers")->value(), Value(2));
  ASSERT_TRUE(globe.propertyAt("Layers.ColorLayers.B.Enabled")->set(true));
  frame();
  EXPECT_EQ(globe.property("NActiveLayers")->value(), Value(3));
  ASSERT_TRUE(globe.property("TargetLodScaleFactor")->set(20.0));
  EXPECT_EQ(globe.property("CurrentLodScaleFactor")->value(), Value(20.0));
  for (const char* readOnly : {"Type", "NActiveLayers", "CurrentLodScaleFactor"}) {
    EXPECT_TRUE(globe.property(readOnly)->isReadOnly()) << readOnly;
  }
  const std::pair<const char*, Value> others[] = {{"DimInAtmosphere", true},
                                                  {"Eclipse", true},
                                                  {"EclipseHardShadows", true},
                                                  {"ShadowMapping.ShadowMapping", true},
                                                  {"ShadowMapping.ZFightingPercentage", 0.5},
                                                  {"ShadowMapping.NumberShadowSamples", 3},
                                                  {"Debug.ModelSpaceRenderingCutoffLevel", 12},
                                                  {"Debug.DynamicLodIterationCount", 32}};
  for (const auto& [uri, value] : others) {
    Property* property = globe.propertyAt(uri);
    ASSERT_NE(property, nullptr) << uri;
    EXPECT_TRUE(property->set(value)) << uri;
  }
}

TEST_F(RenderableGlobeTest, DebugPropertiesOfOpenSpaceWork) {
  RenderableGlobe& globe =
      addGlobe({{"ColorLayers", listOf({solidLayer("A", {1, 0, 0}), solidLayer("B", {0, 1, 0}, {{"Enabled", false}})})},
                {"Overlays", listOf({solidLayer("C", {0, 0, 1})})}});
  Property& byArea = *globe.propertyAt("Debug.LevelByProjectedAreaElseDistance");
  ASSERT_TRUE(byArea.set(false));
  EXPECT_EQ(globe.evaluator.word(), "Distance");
  ASSERT_TRUE(byArea.set(true));
  EXPECT_EQ(globe.evaluator.word(), "ScreenSpaceError");
  ASSERT_TRUE(globe.evaluator.set("Distance"));
  EXPECT_EQ(byArea.value(), Value(false));
  ASSERT_TRUE(globe.evaluator.set("ProjectedArea"));
  EXPECT_EQ(byArea.value(), Value(true));
  EXPECT_EQ(globe.evaluator.word(), "ProjectedArea");
  int resets = 0;
  for (const LayerGroupId id : allLayerGroups) {
    for (const auto& layer : globe.layers().group(id).layers()) {
      layer->reset.onChange([&resets] { ++resets; });
    }
  }
  ASSERT_TRUE(globe.propertyAt("Debug.ResetTileProviders")->set({}));
  EXPECT_EQ(resets, 3);
}

/// Every float in every uniform buffer that is bound.
void expectFiniteUniforms(const std::string& what) {
  for (GLuint binding = 0; binding < 4; ++binding) {
    GLint buffer = 0;
    glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, binding, &buffer);
    if (buffer == 0) {
      continue;
    }
    GLint64 bytes = 0;
    glGetNamedBufferParameteri64v(static_cast<GLuint>(buffer), GL_BUFFER_SIZE, &bytes);
    std::vector<float> floats(static_cast<std::size_t>(bytes) / sizeof(float));
    glGetNamedBufferSubData(static_cast<GLuint>(buffer), 0, static_cast<GLsizeiptr>(floats.size() * sizeof(float)),
                            floats.data());
    for (const float value : floats) {
      ASSERT_TRUE(std::isfinite(value)) << what << ", binding " << binding;
    }
  }
}

TEST_F(RenderableGlobeTest, NoBadCameraReachesTheGpu) {
  addGlobe({{"ColorLayers", listOf({solidLayer("Red", {1, 0, 0})})}}, {{"RenderAtDistance", true}});
  ASSERT_TRUE(settle());
  const View good = view_;
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::map<std::string, View> bad;
  for (const auto& [name, value] : {std::pair("nan", nan), std::pair("infinite", infinity), std::pair("zero", 0.0),
                                    std::pair("huge", 1e300), std::pair("1e35", 1e35), std::pair("tiny", 1e-300)}) {
    View view = good;
    view.cameraPosition = glm::dvec3(value);
    bad[std::string(name) + " position"] = view;
    view = good;
    view.cameraFromModel = glm::dmat4(value);
    bad[std::string(name) + " camera matrix"] = view;
    view = good;
    view.clipFromCamera = glm::dmat4(value);
    bad[std::string(name) + " projection"] = view;
    view = good;
    view.pixelsPerRadian = value;
    bad[std::string(name) + " pixels"] = view;
    view = good;
    view.lightDirection = glm::dvec3(value);
    bad[std::string(name) + " light"] = view;
  }
  look(0.1, 0.2, 1000.0);
  bad["inside the planet"] = view_;
  for (const auto& [name, view] : bad) {
    view_ = view;
    for (int n = 0; n < 3; ++n) {
      frame();
      expectFiniteUniforms(name);
    }
  }
  view_ = good;
  ASSERT_TRUE(settle());
  EXPECT_EQ(centre(), (Pixel{255, 0, 0}));
}

TEST_F(RenderableGlobeTest, AQueryOfANonNumberAnswers) {
  RenderableGlobe& globe = addGlobe({});
  ASSERT_TRUE(settle());
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isfinite(globe.heightAt(nan, nan)));
  EXPECT_FALSE(globe.pick(glm::dvec3(nan), {1, 0, 0}));
  EXPECT_FALSE(globe.pick({1e7, 0, 0}, glm::dvec3(nan)));
  EXPECT_FALSE(globe.pick({1e7, 0, 0}, glm::dvec3(0.0)));
}

TEST_F(RenderableGlobeTest, TooSmallAPoolStillSettlesSaysWhyAndHoldsStill) {
  setModuleProperty("TexturePoolSize", 64);
  const auto checks = [](int, double longitude, double latitude) {
    return 80.0 + 40.0 * std::sin(longitude) + 40.0 * std::cos(latitude);
  };
  const std::string file = raster("fine.tif", checks, 3, GDT_Byte, 4096);
  RenderableGlobe& globe = addGlobe({{"ColorLayers", listOf({fileLayer("A", file)})},
                                     {"Overlays", listOf({fileLayer("B", file, {{"Opacity", 0.5}})})},
                                     {"NightLayers", listOf({fileLayer("C", file)})}},
                                    {{"TargetLodScaleFactor", 50.0}, {"PerformShading", true}});
  look(0.3, 0.4, 8.5e6);
  ASSERT_TRUE(settle());
  EXPECT_THAT(globe.settled(0).reason, HasSubstr("TexturePoolSize"));
  const std::vector<std::uint8_t> first = target_->readPixels();
  for (int n = 0; n < 30; ++n) {
    frame();
    ASSERT_TRUE(target_->readPixels() == first) << "frame " << n << " flickers";
  }
  for (int n = 0; n < 20; ++n) {
    look(0.3 + 0.02 * n, 0.4 + 0.05 * n, 8.5e6);
    frame();
    EXPECT_NE(centre(), (Pixel{0, 0, 0})) << "frame " << n;
  }
}

TEST_F(RenderableGlobeTest, ATinyTileCacheStillSettles) {
  setModuleProperty("TileCacheSize", 16);
  const std::string file = uniformRaster("fine.tif", {10, 200, 30}, 4096);
  addGlobe({{"ColorLayers", listOf({fileLayer("A", file)})}, {"HeightLayers", listOf({fileLayer("H", file)})}});
  for (const double distance : {8e6, 6.6e6, 1.5e7}) {
    look(0.3, 0.4, distance);
    ASSERT_TRUE(settle()) << distance;
    EXPECT_EQ(centre(), (Pixel{10, 200, 30})) << distance;
  }
}

TEST_F(RenderableGlobeTest, CountsWhatIsInTheTexturePoolOfAllGlobes) {
  const std::string file = uniformRaster("a.tif", {10, 200, 30});
  addGlobe({{"ColorLayers", listOf({fileLayer("A", file)})}}, {}, "First");
  ASSERT_TRUE(settle());
  const auto one = statistics_.memory.texturePool;
  EXPECT_GT(one, 2 * (Composer::bytesPerComposite() + Composer::bytesPerRawTile()));
  addGlobe({{"ColorLayers", listOf({fileLayer("A", file)})}}, {}, "Second");
  ASSERT_TRUE(settle());
  EXPECT_GT(statistics_.memory.texturePool, one);
  EXPECT_LE(statistics_.memory.texturePool, std::uint64_t{512} << 20);
  EXPECT_GT(statistics_.tiles.loaded.load(), 0U);
  EXPECT_EQ(statistics_.tiles.failed.load(), 0U);
  EXPECT_GE(statistics_.tiles.requested.load(), statistics_.tiles.loaded.load() + statistics_.tiles.cancelled.load());
}

TEST_F(RenderableGlobeTest, ChangingThePoolsSizeMovesTheGlobeWithoutAGap) {
  const std::string file = uniformRaster("a.tif", {10, 200, 30}, 1024);
  addGlobe({{"ColorLayers", listOf({fileLayer("A", file)})}});
  ASSERT_TRUE(settle());
  setModuleProperty("TexturePoolSize", 128);
  frame();
  EXPECT_FALSE(unsettled().empty()) << "it moves";
  ASSERT_TRUE(settle([&] { EXPECT_EQ(centre(), (Pixel{10, 200, 30})); }));
}

}  // namespace
}  // namespace meridian::globebrowsing
