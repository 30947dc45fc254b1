#include "host/app/scene_renderer.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

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
  explicit Counter(std::vector<const Counter*>& drawn) : Renderable("Counter"), drawn_(drawn) {}
  void update(const FrameContext& /*frame*/) override { ++updates; }
  void draw(const FrameContext& /*frame*/, std::size_t /*view*/) override { drawn_.push_back(this); }
  int updates = 0;

 private:
  std::vector<const Counter*>& drawn_;
};

class SceneRendererTest : public testing::Test {
 protected:
  void SetUp() override {
    auto context = graphics::OffscreenContext::create({.debug = false});
    if (!context && context.error().what.starts_with("no EGL display")) {
      std::cerr << "NO OPENGL HERE, NOTHING IS TESTED: " << context.error().message() << "\n";
      GTEST_SKIP() << context.error().message();
    }
    ASSERT_TRUE(context) << context.error().message();
    context_ = std::move(*context);
    ASSERT_TRUE(context_->makeCurrent());
    paths_.shaders = std::filesystem::path(MERIDIAN_SOURCE_FOLDER) / "shaders";
    scene_.registerRenderable("Counter", [this](const RenderableRequest& /*request*/) {
      return Result<std::unique_ptr<Renderable>>(std::make_unique<Counter>(drawn_));
    });
    auto renderer = SceneRenderer::create(*context_, paths_, statistics_, scene_);
    ASSERT_TRUE(renderer) << renderer.error().message();
    renderer_ = std::move(*renderer);
  }
  /// At that distance from the camera.
  Counter& add(const std::string& identifier, double distance) {
    const Value translation =
        Table{{}, {{"Type", "StaticTranslation"}, {"Position", Value(glm::dvec3(0.0, 0.0, -distance))}}};
    const Value node = Table{{},
                             {{"Identifier", identifier},
                              {"Renderable", Table{{}, {{"Type", "Counter"}}}},
                              {"Transform", Table{{}, {{"Translation", translation}}}}}};
    const auto added = scene_.addNode(node, "test.asset:1", "/");
    EXPECT_TRUE(added);
    return dynamic_cast<Counter&>(*(*added)->renderable());
  }
  void frame() {
    drawn_.clear();
    renderer_->beginFrame();
    ASSERT_TRUE(renderer_->draw({}, camera_, {.size = {8, 8}}));
    renderer_->endFrame();
  }

  std::unique_ptr<graphics::OffscreenContext> context_;
  Paths paths_;
  Statistics statistics_;
  std::vector<const Counter*> drawn_;
  scene::Scene scene_;
  navigation::Camera camera_{scene_};
  std::unique_ptr<SceneRenderer> renderer_;
};

TEST_F(SceneRendererTest, UpdatesWhatIsDisabledAndDoesNotDrawIt) {
  Counter& counter = add("N", 0.0);
  frame();
  EXPECT_EQ(drawn_.size(), 1U);
  counter.enabled.put(false);
  frame();
  EXPECT_EQ(drawn_.size(), 0U);
  EXPECT_EQ(counter.updates, 2);
}

TEST_F(SceneRendererTest, WhatFadesIsDrawnAfterWhatIsOpaque) {
  ASSERT_TRUE(camera_.setPose("Root", {}));
  Counter& nearOne = add("Near", 10.0);
  Counter& farOne = add("Far", 1000.0);
  using Order = std::vector<const Counter*>;
  frame();
  EXPECT_EQ(drawn_, (Order{&nearOne, &farOne}));
  nearOne.fade.put(0.5);
  frame();
  EXPECT_EQ(drawn_, (Order{&farOne, &nearOne}));
  nearOne.fade.put(1.0);
  nearOne.opacity.put(0.5);
  frame();
  EXPECT_EQ(drawn_, (Order{&farOne, &nearOne}));
}

}  // namespace
}  // namespace meridian::app
