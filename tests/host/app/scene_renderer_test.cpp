#include "host/app/scene_renderer.h"

#include <filesystem>
#include <iostream>
#include <memory>

#include <gtest/gtest.h>

#include "host/api/statistics.h"
#include "host/graphics/context.h"
#include "host/navigation/camera.h"
#include "host/scene/scene.h"

namespace meridian::app {
namespace {

/// Counts its calls.
class Counter final : public Renderable {
 public:
  Counter() : Renderable("Counter") {}
  void update(const FrameContext& /*frame*/) override { ++updates; }
  void draw(const FrameContext& /*frame*/, std::size_t /*view*/) override { ++draws; }
  int updates = 0;
  int draws = 0;
};

TEST(SceneRenderer, UpdatesWhatIsDisabledAndDoesNotDrawIt) {
  auto context = graphics::OffscreenContext::create({.debug = false});
  if (!context && context.error().what.starts_with("no EGL display")) {
    std::cerr << "NO OPENGL HERE, NOTHING IS TESTED: " << context.error().message() << "\n";
    GTEST_SKIP() << context.error().message();
  }
  ASSERT_TRUE(context) << context.error().message();
  ASSERT_TRUE((*context)->makeCurrent());
  Paths paths;
  paths.shaders = std::filesystem::path(MERIDIAN_SOURCE_FOLDER) / "shaders";
  Statistics statistics;
  scene::Scene scene;
  Counter* counter = nullptr;
  scene.registerRenderable("Counter", [&](const RenderableRequest& /*request*/) -> Result<std::unique_ptr<Renderable>> {
    auto made = std::make_unique<Counter>();
    counter = made.get();
    return made;
  });
  const Value node = Table{{}, {{"Identifier", "N"}, {"Renderable", Table{{}, {{"Type", "Counter"}}}}}};
  ASSERT_TRUE(scene.addNode(node, "test.asset:1", "/"));
  const navigation::Camera camera(scene);
  auto renderer = SceneRenderer::create(**context, paths, statistics, scene);
  ASSERT_TRUE(renderer) << renderer.error().message();
  for (const bool isEnabled : {true, false}) {
    counter->enabled.put(isEnabled);
    (*renderer)->beginFrame();
    ASSERT_TRUE((*renderer)->draw({}, camera, {.size = {8, 8}}));
    (*renderer)->endFrame();
  }
  EXPECT_EQ(counter->updates, 2);
  EXPECT_EQ(counter->draws, 1);
}

}  // namespace
}  // namespace meridian::app
