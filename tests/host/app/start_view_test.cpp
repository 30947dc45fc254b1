#include "host/app/start_view.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace meridian::app {
namespace {

class StartViewTest : public ::testing::Test {
 protected:
  void addNode(const char* identifier, double boundingSphere) {
    Table table;
    table.fields["Identifier"] = identifier;
    if (boundingSphere > 0.0) {
      table.fields["BoundingSphere"] = boundingSphere;
    }
    const auto node = scene_.addNode(Value(std::move(table)), "test:1", "/");
    ASSERT_TRUE(node) << node.error().message();
  }

  scene::Scene scene_;
  navigation::Camera camera_{scene_};
};

TEST_F(StartViewTest, AnEmptySceneIsSeenFromItsRoot) {
  ASSERT_TRUE(placeCamera(camera_, "", {}));
  EXPECT_EQ(&camera_.anchor(), &scene_.root());
}

TEST_F(StartViewTest, TheFirstNodeWithAnExtentIsShown) {
  addNode("Point", 0.0);
  addNode("Ball", 2000.0);
  ASSERT_TRUE(placeCamera(camera_, "", {}));
  EXPECT_EQ(camera_.anchor().identifier(), "Ball");
}

TEST_F(StartViewTest, ANodeFillsMostOfThePictureAndLiesInItsMiddle) {
  addNode("Ball", 2000.0);
  ASSERT_TRUE(showNode(camera_, "Ball"));
  const double distance = glm::length(camera_.pose().position);
  const double halfAngle = std::asin(2000.0 / distance);
  const double halfView = 0.5 * camera_.verticalFieldOfViewDegrees.get() * std::numbers::pi / 180.0;
  EXPECT_GT(halfAngle, 0.7 * halfView);
  EXPECT_LT(halfAngle, halfView);
  EXPECT_NEAR(glm::dot(camera_.pose().ahead(), -camera_.pose().position / distance), 1.0, 1e-12);
}

TEST_F(StartViewTest, ItsLitSideIsShown) {
  addNode("Ball", 2000.0);
  ASSERT_TRUE(showNode(camera_, "Ball"));
  const glm::dvec3 light = scene_.lightDirection(*scene_.node("Ball"));
  EXPECT_GT(glm::dot(light, glm::normalize(camera_.pose().position)), 0.5);
}

TEST_F(StartViewTest, ACameraThatScriptsHavePlacedStays) {
  addNode("Ball", 2000.0);
  addNode("Other", 0.0);
  ASSERT_TRUE(camera_.setPose("Other", {.position = {1.0, 2.0, 3.0}}));
  ASSERT_TRUE(placeCamera(camera_, "", {}));
  EXPECT_EQ(camera_.anchor().identifier(), "Other");
  EXPECT_EQ(camera_.pose().position, glm::dvec3(1.0, 2.0, 3.0));
}

TEST_F(StartViewTest, AnUnknownAnchorIsAnErrorWithItsName) {
  const auto placed = placeCamera(camera_, "Nowhere", {});
  ASSERT_FALSE(placed);
  EXPECT_NE(placed.error().message().find("Nowhere"), std::string::npos);
}

TEST_F(StartViewTest, APlaceNeedsAGlobe) {
  addNode("Ball", 2000.0);
  EXPECT_FALSE(placeCamera(camera_, "Ball", navigation::GeodeticPose{}));
}

}  // namespace
}  // namespace meridian::app
