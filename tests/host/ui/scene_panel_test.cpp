#include "host/ui/scene_panel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recording_builder.h"

namespace meridian::ui {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ScenePanelTest : public ::testing::Test {
 protected:
  RecordingBuilder build(const std::set<std::string>& pressed = {}) {
    RecordingBuilder builder;
    builder.pressed = pressed;
    panel_.build(builder);
    return builder;
  }

  scene::Scene scene_;
  navigation::Camera camera_{scene_};
  navigation::OrbitNavigator navigator_{camera_};
  scripting::Clock clock_{Time::fromUtc("2026-03-20T14:46:00").value()};
  std::vector<std::string> visited_;
  ScenePanel panel_{{clock_, camera_, navigator_, [this](std::string_view node) { visited_.emplace_back(node); }}};
};

TEST_F(ScenePanelTest, ShowsTheTime) {
  EXPECT_THAT(build().texts, Contains(HasSubstr("2026-03-20T14:46:00")));
}

TEST_F(ScenePanelTest, PausesAndRunsTheClock) {
  build({"Pause"});
  EXPECT_TRUE(clock_.isPaused());
  build({"Run"});
  EXPECT_FALSE(clock_.isPaused());
}

TEST_F(ScenePanelTest, ChangesTheSpeedByOneStep) {
  build({"Faster"});
  EXPECT_EQ(clock_.deltaTime(), 5.0);
  build({"Slower"});
  EXPECT_EQ(clock_.deltaTime(), 1.0);
}

TEST_F(ScenePanelTest, GoesToNodesThatHaveAnExtent) {
  for (const double radius : {0.0, 1000.0}) {
    Table table;
    table.fields["Identifier"] = radius > 0.0 ? "Ball" : "Point";
    if (radius > 0.0) {
      table.fields["BoundingSphere"] = radius;
    }
    const auto added = scene_.addNode(Value(std::move(table)), "test:1", "/");
    ASSERT_TRUE(added) << added.error().message();
  }
  build({"Ball", "Point"});
  EXPECT_THAT(visited_, ElementsAre("Ball"));
}

TEST(LengthText, ChoosesAUnit) {
  EXPECT_EQ(lengthText(0.25), "25.0 cm");
  EXPECT_EQ(lengthText(1234.0), "1234.0 m");
  EXPECT_EQ(lengthText(-12345.0), "-12.3 km");
  EXPECT_EQ(lengthText(384.4e6), "384400.0 km");
  EXPECT_EQ(lengthText(149'597'870'700.0), "1.000 au");
}

}  // namespace
}  // namespace meridian::ui
