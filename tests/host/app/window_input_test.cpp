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
  std::string pressed_;
  std::string bound_;
  WindowInput input_{nullptr,
                     navigator_,
                     {[this] { ++panels_; }, [this] { ++pauses_; }, [this] { ++quits_; },
                      [this](const std::string& key) { return pressed_ = key, key == bound_; },
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

TEST_F(WindowInputTest, BoundKeysComeFirst) {
  bound_ = "Shift+SPACE";
  input_.key(GLFW_KEY_SPACE, true, GLFW_MOD_SHIFT);
  EXPECT_EQ(pauses_, 0);
  input_.key(GLFW_KEY_SPACE, true, 0);
  EXPECT_EQ(pauses_, 1);
  EXPECT_EQ(pressed_, "SPACE");
  panelHasInput_ = true;
  bound_ = "A";
  input_.key(GLFW_KEY_A, true, 0);
  EXPECT_EQ(pressed_, "SPACE") << "a panel has the keyboard";
}

TEST(KeyName, SpellsKeysAsBindingsDo) {
  EXPECT_EQ(keyName(GLFW_KEY_H, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT), "Ctrl+Shift+H");
  EXPECT_EQ(keyName(GLFW_KEY_7, 0), "7");
  EXPECT_EQ(keyName(GLFW_KEY_F12, GLFW_MOD_ALT), "Alt+F12");
  EXPECT_EQ(keyName(GLFW_KEY_KP_0, 0), "KP_0");
  EXPECT_EQ(keyName(GLFW_KEY_PRINT_SCREEN, 0), "PRINT_SCREEN");
  EXPECT_EQ(keyName(GLFW_KEY_LEFT_SHIFT, GLFW_MOD_SHIFT), "");
}

}  // namespace
}  // namespace meridian::app
