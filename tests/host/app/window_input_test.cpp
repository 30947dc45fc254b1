#include "host/app/window_input.h"

#include <gtest/gtest.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "host/app/start_view.h"

namespace meridian::app {
namespace {

/// Without a window: events are handed over as its callbacks would.
class WindowInputTest : public ::testing::Test {
 protected:
  void SetUp() override {
    Table table;
    table.fields["Identifier"] = "Ball";
    table.fields["BoundingSphere"] = 1000.0;
    ASSERT_TRUE(scene_.addNode(Value(std::move(table)), "test:1", "/"));
    ASSERT_TRUE(showNode(camera_, "Ball"));
  }

  void drag(int button) {
    input_.mouseMove({100.0, 100.0}, 500.0);
    input_.mouseButton(button, true);
    input_.mouseMove({150.0, 130.0}, 500.0);
    input_.mouseButton(button, false);
    navigator_.update(1.0 / 60.0);
  }

  bool hasMoved() const { return glm::distance(camera_.pose().position, start_.position) > 1.0; }
  bool hasTurned() const { return glm::dot(camera_.pose().ahead(), start_.ahead()) < 1.0 - 1e-9; }

  scene::Scene scene_;
  navigation::Camera camera_{scene_};
  navigation::OrbitNavigator navigator_{camera_};
  bool panelHasInput_ = false;
  int panels_ = 0;
  int pauses_ = 0;
  int quits_ = 0;
  WindowInput input_{nullptr,
                     navigator_,
                     {[this] { ++panels_; }, [this] { ++pauses_; }, [this] { ++quits_; },
                      [this] { return panelHasInput_; }, [this] { return panelHasInput_; }}};
  navigation::Pose start_{};
};

TEST_F(WindowInputTest, LeftDragOrbits) {
  start_ = camera_.pose();
  drag(GLFW_MOUSE_BUTTON_LEFT);
  EXPECT_TRUE(hasMoved());
  EXPECT_NEAR(glm::length(camera_.pose().position), glm::length(start_.position), 1e-6);
}

TEST_F(WindowInputTest, RightDragAndWheelGoNearer) {
  start_ = camera_.pose();
  drag(GLFW_MOUSE_BUTTON_RIGHT);
  const double dragged = glm::length(camera_.pose().position);
  EXPECT_LT(dragged, glm::length(start_.position));
  input_.mouseWheel(1.0);
  navigator_.update(1.0 / 60.0);
  EXPECT_LT(glm::length(camera_.pose().position), dragged);
}

TEST_F(WindowInputTest, MiddleDragTiltsOnTheSpot) {
  start_ = camera_.pose();
  drag(GLFW_MOUSE_BUTTON_MIDDLE);
  EXPECT_TRUE(hasTurned());
  EXPECT_FALSE(hasMoved());
}

TEST_F(WindowInputTest, MovingWithoutAButtonDoesNothing) {
  start_ = camera_.pose();
  input_.mouseMove({0.0, 0.0}, 500.0);
  input_.mouseMove({400.0, 100.0}, 500.0);
  navigator_.update(1.0 / 60.0);
  EXPECT_FALSE(hasMoved());
}

TEST_F(WindowInputTest, WhatAPanelTakesDoesNotReachTheCamera) {
  start_ = camera_.pose();
  panelHasInput_ = true;
  drag(GLFW_MOUSE_BUTTON_LEFT);
  input_.mouseWheel(3.0);
  input_.key(GLFW_KEY_SPACE, true, 0);
  navigator_.update(1.0 / 60.0);
  EXPECT_FALSE(hasMoved());
  EXPECT_EQ(pauses_, 0);
}

TEST_F(WindowInputTest, KeysCallTheirCommandsOnce) {
  for (const int key : {GLFW_KEY_F1, GLFW_KEY_SPACE, GLFW_KEY_ESCAPE}) {
    input_.key(key, true, 0);
    input_.key(key, false, 0);
  }
  EXPECT_EQ(panels_, 1);
  EXPECT_EQ(pauses_, 1);
  EXPECT_EQ(quits_, 1);
}

}  // namespace
}  // namespace meridian::app
