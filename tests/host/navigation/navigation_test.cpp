#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "host/navigation/camera.h"
#include "host/navigation/geodetic_pose.h"
#include "host/navigation/navigation_state.h"
#include "host/navigation/orbit_navigator.h"
#include "host/navigation/script_library.h"
#include "smooth_ground.h"

namespace meridian::navigation {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
constexpr double terrain = 1000.0;

Value table(std::map<std::string, Value, std::less<>> fields) {
  return Table{{}, std::move(fields)};
}

/// A globe far from the barycentre, on a parent of its own.
struct World {
  World() {
    scene.registerRenderable("SmoothGround", [](const RenderableRequest&) -> Result<std::unique_ptr<Renderable>> {
      return std::make_unique<test::SmoothGround>(terrain);
    });
    const Value far = table({{"Type", "StaticTranslation"}, {"Position", Value(glm::dvec3(1.1e11, -0.8e11, 0.5e11))}});
    const Value turn = table({{"Type", "StaticRotation"}, {"Rotation", Value(glm::dvec3(0.4, -1.0, 2.0))}});
    add(table({{"Identifier", "Center"}, {"Transform", table({{"Translation", far}})}}));
    add(table({{"Identifier", "Globe"},
               {"Parent", "Center"},
               {"Renderable", table({{"Type", "SmoothGround"}})},
               {"Transform", table({{"Rotation", turn}})}}));
  }
  void add(const Value& node) { EXPECT_TRUE(scene.addNode(node, "test", "/")); }
  void goTo(const GeodeticPose& pose) {
    EXPECT_TRUE(camera.setPose("Globe", poseFromGeodetic(*scene.node("Globe")->ground(), pose)));
  }
  scene::Scene scene;
  Camera camera{scene};
  OrbitNavigator navigator{camera};
};

double angleBetween(const glm::dquat& a, const glm::dquat& b) {
  return 2.0 * glm::length(glm::dvec3((a * glm::conjugate(b)).x, (a * glm::conjugate(b)).y, (a * glm::conjugate(b)).z));
}

Result<std::vector<Value>> call(const ScriptLibrary& library, std::string_view name, std::vector<Value> arguments) {
  for (const ScriptFunction& function : library.functions) {
    if (function.name == name) {
      return function.call(arguments);
    }
  }
  return failure("no such function");
}

}  // namespace

TEST(Camera, NeverTakesWhatIsNotFinite) {
  World world;
  const Pose before{{1.0, 2.0, 3.0}, {1.0, 0.0, 0.0, 0.0}};
  ASSERT_TRUE(world.camera.setPose(before));
  const double infinity = std::numeric_limits<double>::infinity();
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const Pose& bad :
       {Pose{{none, 0, 0}, {1, 0, 0, 0}}, Pose{{0, infinity, 0}, {1, 0, 0, 0}}, Pose{{0, 0, 0}, {0, 0, 0, 0}},
        Pose{{0, 0, 0}, {none, 0, 0, 0}}, Pose{{0, 0, 0}, {0, infinity, 0, 0}}, Pose{{1e200, 0, 0}, {1, 0, 0, 0}}}) {
    EXPECT_FALSE(world.camera.setPose(bad));
    EXPECT_EQ(world.camera.pose().position, before.position);
  }
  EXPECT_FALSE(world.camera.setPose("Nobody", before));
  EXPECT_TRUE(world.camera.setPose({{0, 0, 0}, {1e-300, 0, 0, 0}}));
  EXPECT_NEAR(glm::length(world.camera.pose().rotation), 1.0, 1e-15);
}

TEST(Camera, StaysWhereItIsWhenItsAnchorChangesOrGoes) {
  World world;
  world.goTo({{0.4, 1.0, 5000.0}, 0.3, -0.2, 0.1});
  const Pose inCenter = world.camera.poseIn(*world.scene.node("Center"));
  ASSERT_TRUE(world.camera.setAnchor("Center"));
  EXPECT_LT(glm::distance(world.camera.pose().position, inCenter.position), 1e-8);
  ASSERT_TRUE(world.camera.setAnchor("Globe"));
  ASSERT_TRUE(world.scene.removeNode("Globe"));
  EXPECT_EQ(world.camera.anchor().identifier(), "Center");
  EXPECT_LT(glm::distance(world.camera.pose().position, inCenter.position), 1e-8);
  EXPECT_LT(angleBetween(world.camera.pose().rotation, inCenter.rotation), 1e-12);
}

TEST(Views, PutTheNodeInFrontOfTheEyeWithReversedDepth) {
  World world;
  world.goTo({{0.3, -0.7, 2e6}, 0.5, -0.5 * std::numbers::pi, 0.0});
  const Viewport viewports[] = {{{1280, 720}}, {{600, 600}, glm::dmat4(1.0), 1.0}};
  std::vector<View> views;
  makeViews(world.camera, *world.scene.node("Globe"), viewports, views);
  ASSERT_EQ(views.size(), 2U);
  const View& view = views[0];
  EXPECT_EQ(view.size, glm::ivec2(1280, 720));
  EXPECT_LT(glm::distance(view.cameraPosition, world.camera.pose().position), 1e-8);
  const glm::dvec3 below = world.scene.node("Globe")->ground()->cartesian({0.3, -0.7, 0.0});
  const glm::dvec4 seen = view.cameraFromModel * glm::dvec4(below, 1.0);
  EXPECT_LT(glm::distance(glm::dvec3(seen), glm::dvec3(0, 0, -2e6)), 1e-6);
  const glm::dvec4 clip = view.clipFromCamera * seen;
  EXPECT_NEAR(clip.z / clip.w, nearPlane / 2e6, 1e-12);
  const glm::dvec4 edge = view.clipFromCamera * glm::dvec4(0, std::tan(25 * degree), -1, 1);
  EXPECT_NEAR(edge.y / edge.w, 1.0, 1e-12);
  EXPECT_NEAR(views[1].pixelsPerRadian, 300 / std::tan(0.5), 1e-9);
  EXPECT_NEAR(glm::length(view.lightDirection), 1.0, 1e-14);
}

TEST(GeodeticPose, GoesThereAndBack) {
  const test::SmoothGround ground;
  for (const double latitude : {-89.9, -45.0, 0.0, 27.9, 89.9}) {
    for (const double heading : {-179.0, -90.0, 0.0, 45.0, 120.0}) {
      for (const double pitch : {-89.0, -30.0, 0.0, 60.0}) {
        const GeodeticPose pose{{latitude * degree, 86.9 * degree, 8848.0}, heading * degree, pitch * degree, 0.2};
        const GeodeticPose back = geodeticFromPose(ground, poseFromGeodetic(ground, pose));
        EXPECT_NEAR(back.position.latitude, pose.position.latitude, 1e-13);
        EXPECT_NEAR(back.position.height, 8848.0, 1e-8);
        EXPECT_NEAR(back.heading, pose.heading, 1e-9);
        EXPECT_NEAR(back.pitch, pose.pitch, 1e-9);
        EXPECT_NEAR(back.roll, pose.roll, 1e-9);
      }
    }
  }
  const GeodeticPose down{{0.5, 0.5, 1e6}, 0.7, -0.5 * std::numbers::pi, 0.0};
  EXPECT_NEAR(geodeticFromPose(ground, poseFromGeodetic(ground, down)).heading, 0.7, 1e-9);
  const Pose level = poseFromGeodetic(ground, {{0.0, 0.0, 0.0}, 0.5 * std::numbers::pi, 0.0, 0.0});
  EXPECT_LT(glm::distance(level.ahead(), glm::dvec3(0, 1, 0)), 1e-15);
  EXPECT_LT(glm::distance(level.up(), glm::dvec3(1, 0, 0)), 1e-15);
}

TEST(GeodeticPose, ReadsTheCommandLine) {
  const auto pose = geodeticPoseFromText("27.9, 86.9,20000,-30,-15");
  ASSERT_TRUE(pose);
  EXPECT_NEAR(pose->position.latitude, 27.9 * degree, 1e-15);
  EXPECT_NEAR(pose->heading, -30 * degree, 1e-15);
  EXPECT_NEAR(geodeticPoseFromText("1,2,3")->pitch, -90 * degree, 1e-15);
  for (const char* bad :
       {"", "1,2", "1,2,3,4", "1,2,3,4,5,6", "91,0,0", "a,b,c", "1,2,nan", "1,2,inf", "1,,3", "1,2,3,4,99"}) {
    EXPECT_FALSE(geodeticPoseFromText(bad)) << bad;
  }
}

TEST(OrbitNavigator, SpeedIsProportionalToTheHeightOverTheTerrain) {
  const auto moved = [](double height) {
    World world;
    world.navigator.friction.put(0.0);
    world.goTo({{0.2, 0.3, terrain + height}, 0.0, -1.0, 0.0});
    const glm::dvec3 before = world.camera.pose().position;
    world.navigator.drag(OrbitNavigator::Motion::Orbit, {0.1, 0.0});
    world.navigator.update(1.0 / 60.0);
    return glm::distance(before, world.camera.pose().position);
  };
  EXPECT_NEAR(moved(10000.0) / moved(100.0), 100.0, 1.0);
  EXPECT_NEAR(moved(100.0), 0.1 * 2.0 * std::tan(25 * degree) * 100.0, 1.0);
}

TEST(OrbitNavigator, DraggingCarriesTheGroundAlong) {
  World world;
  world.navigator.friction.put(0.0);
  world.goTo({{0.2, 0.3, 1e5}, 0.0, -0.5 * std::numbers::pi, 0.0});
  world.navigator.drag(OrbitNavigator::Motion::Orbit, {0.1, 0.1});
  world.navigator.update(1.0 / 60.0);
  const GeodeticPose after = geodeticFromPose(*world.scene.node("Globe")->ground(), world.camera.pose());
  EXPECT_LT(after.position.longitude, 0.3);      // to the right in the picture: the camera goes west
  EXPECT_GT(after.position.latitude, 0.2);       // down in the picture: the camera goes north
  EXPECT_NEAR(after.position.height, 1e5, 2e3);  // round the centre, not along the ellipsoid
}

TEST(OrbitNavigator, NeverGoesBelowTheTerrain) {
  World world;
  world.goTo({{0.2, 0.3, terrain + 500.0}, 0.0, -1.0, 0.0});
  for (int frame = 0; frame < 300; ++frame) {
    world.navigator.scroll(5.0);
    world.navigator.drag(OrbitNavigator::Motion::Zoom, {0.0, 0.5});
    world.navigator.update(1.0 / 60.0);
    ASSERT_GE(world.navigator.height(), world.navigator.minimumClearance.get() - 1e-6);
  }
  EXPECT_NEAR(world.navigator.height(), world.navigator.minimumClearance.get(), 1e-3);
  world.goTo({{0.2, 0.3, -50.0}, 0.0, -1.0, 0.0});
  world.navigator.stop();
  world.navigator.update(1.0 / 60.0);
  EXPECT_NEAR(world.navigator.height(), world.navigator.minimumClearance.get(), 1e-6);
}

TEST(OrbitNavigator, TellsWhetherItHadToLiftTheCamera) {
  World world;
  world.goTo({{0.2, 0.3, terrain - 800.0}, 0.0, -1.0, 0.0});
  EXPECT_TRUE(world.navigator.keepClear());
  EXPECT_NEAR(world.navigator.height(), world.navigator.minimumClearance.get(), 1e-6);
  EXPECT_FALSE(world.navigator.keepClear()) << "rounding is no motion: what waits for it would wait for ever";
  world.goTo({{0.2, 0.3, terrain + 800.0}, 0.0, -1.0, 0.0});
  EXPECT_FALSE(world.navigator.keepClear());
  EXPECT_NEAR(world.navigator.height(), 800.0, 1e-6);
}

TEST(OrbitNavigator, InertiaDiesOutAndAltogetherMovesWhatWasDragged) {
  World fast;
  World slow;
  fast.goTo({{0.2, 0.3, 1e6}, 0.0, -1.0, 0.0});
  slow.goTo({{0.2, 0.3, 1e6}, 0.0, -1.0, 0.0});
  fast.navigator.friction.put(0.0);
  for (World* world : {&fast, &slow}) {
    world->navigator.drag(OrbitNavigator::Motion::Tilt, {0.2, 0.0});
    for (int frame = 0; frame < 600; ++frame) {
      world->navigator.update(1.0 / 60.0);
    }
  }
  EXPECT_LT(angleBetween(fast.camera.pose().rotation, slow.camera.pose().rotation), 1e-9);
  slow.navigator.drag(OrbitNavigator::Motion::Orbit, {std::nan(""), 0.0});
  slow.navigator.update(std::nan(""));
  EXPECT_TRUE(std::isfinite(slow.camera.pose().position.x));
}

TEST(NavigationState, GivesBackTheCamera) {
  World world;
  for (const char* frame : {"", "Root", "Center"}) {
    world.goTo({{0.4, -2.0, 9000.0}, 1.1, -0.25, 0.15});
    const Pose before = world.camera.pose();
    const auto state = navigationState(world.camera, frame);
    ASSERT_TRUE(state);
    const auto read = NavigationState::fromValue(state->toValue(), "test");
    ASSERT_TRUE(read) << read.error().message();
    world.goTo({{0.0, 0.0, 1e7}, 0.0, -1.0, 0.0});
    ASSERT_TRUE(setNavigationState(world.camera, *read));
    EXPECT_LT(glm::distance(world.camera.pose().position, before.position), 1e-6) << frame;
    EXPECT_LT(angleBetween(world.camera.pose().rotation, before.rotation), 1e-9) << frame;
  }
  EXPECT_FALSE(NavigationState::fromValue(table({{"Anchor", "Globe"}}), "test"));
  EXPECT_FALSE(
      NavigationState::fromValue(table({{"Anchor", "Globe"}, {"Position", Value(glm::dvec3(std::nan("")))}}), "test"));
}

TEST(NavigationLibrary, JumpsToPlacesOnAGlobe) {
  World world;
  const ScriptLibrary library = navigationLibrary(world.camera, world.navigator);
  ASSERT_TRUE(call(library, "jumpToGeo", {"Globe", 27.9, 86.9, 20000}));
  const GeodeticPose pose = geodeticFromPose(*world.scene.node("Globe")->ground(), world.camera.pose());
  EXPECT_NEAR(pose.position.latitude, 27.9 * degree, 1e-12);
  EXPECT_NEAR(pose.position.height, 20000, 1e-6);
  EXPECT_NEAR(pose.pitch, -90 * degree, 1e-7);
  const auto local = call(library, "localPositionFromGeo", {"Globe", 0, 90, 10});
  ASSERT_TRUE(local && local->size() == 3);
  EXPECT_NEAR(*(*local)[1].number(), 6378147.0, 1e-6);
  EXPECT_FALSE(call(library, "jumpToGeo", {"Globe", 27.9, 86.9, 10}));  // below the surface
  EXPECT_FALSE(call(library, "jumpToGeo", {"Globe", 127.9, 86.9, 20000}));
  EXPECT_FALSE(call(library, "jumpToGeo", {"Center", 27.9, 86.9, 20000}));
  EXPECT_FALSE(call(library, "jumpToGeo", {"Nobody", 27.9, 86.9, 20000}));
  ASSERT_TRUE(call(library, "jumpTo", {"Globe"}));
  EXPECT_NEAR(*call(library, "distanceToFocus", {})->at(0).number(), 3 * 6378137.0, 1e-3);
  EXPECT_NEAR(*call(library, "distanceToFocusBoundingSphere", {})->at(0).number(), 2 * 6378137.0, 1e-3);
  ASSERT_TRUE(call(library, "setFocus", {"Center"}));
  EXPECT_EQ(world.camera.anchor().identifier(), "Center");
}

}  // namespace meridian::navigation
