#include "host/scene/scene.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/ephemeris/body_positions.h"
#include "host/ephemeris/frames.h"

namespace meridian::scene {

namespace {

using testing::HasSubstr;

constexpr double astronomicalUnit = 149597870700.0;

Value table(std::map<std::string, Value, std::less<>> fields) {
  return Table{{}, std::move(fields)};
}

Value translation(const glm::dvec3& position) {
  return table({{"Translation", table({{"Type", "StaticTranslation"}, {"Position", Value(position)}})}});
}

SceneNode& add(Scene& scene, const Value& node) {
  auto added = scene.addNode(node, "test.asset:1", "/");
  EXPECT_TRUE(added) << added.error().message();
  return **added;
}

std::string refusal(Scene& scene, const Value& node) {
  const auto added = scene.addNode(node, "test.asset:7", "/");
  return added ? "" : added.error().message();
}

class Ball final : public Renderable {
 public:
  Ball() : Renderable("Ball") {}
  [[nodiscard]] double boundingSphere() const override { return 42.0; }
  [[nodiscard]] std::string_view lightSourceNode() const override { return light; }
  std::string light;
};

}  // namespace

TEST(Scene, SiblingsFarFromTheBarycentreAreExactToEachOther) {
  for (const double distance : {1.0, 10.0, 100.0}) {
    Scene scene;
    add(scene, table({{"Identifier", "Center"},
                      {"Transform", translation(glm::dvec3(0.6, -0.64, 0.48) * distance * astronomicalUnit)}}));
    add(scene, table({{"Identifier", "Left"}, {"Parent", "Center"}, {"Transform", translation({1000.125, 0, 0})}}));
    add(scene, table({{"Identifier", "Right"}, {"Parent", "Center"}, {"Transform", translation({0, 500.0005, 7})}}));
    const Transform relation = Scene::relativeTransform(*scene.node("Left"), *scene.node("Right"));
    EXPECT_LT(glm::distance(relation.translation, glm::dvec3(1000.125, -500.0005, -7)), 1e-9) << distance;
    // The way through the world is worse than a millimetre at 100 AU: that is why it is not taken.
    const glm::dvec3 left = scene.worldFromNode(*scene.node("Left")).translation;
    const glm::dvec3 right = scene.worldFromNode(*scene.node("Right")).translation;
    if (distance == 100.0) {
      EXPECT_GT(glm::distance(left - right, glm::dvec3(1000.125, -500.0005, -7)), 1e-4);
    }
  }
}

TEST(Scene, RelationsHoldThroughRotationsAndScales) {
  Scene scene;
  const auto turned = [](const glm::dvec3& position, double angle, double scale) {
    return table({{"Translation", table({{"Type", "StaticTranslation"}, {"Position", Value(position)}})},
                  {"Rotation", table({{"Type", "StaticRotation"}, {"Rotation", Value(glm::dvec3(angle, 0.3, -0.2))}})},
                  {"Scale", table({{"Type", "StaticScale"}, {"Scale", scale}})}});
  };
  add(scene, table({{"Identifier", "A"}, {"Transform", turned({1, 2, 3}, 0.7, 2.0)}}));
  add(scene, table({{"Identifier", "B"}, {"Parent", "A"}, {"Transform", turned({-4, 5, 6}, 1.2, 0.5)}}));
  add(scene, table({{"Identifier", "C"}, {"Parent", "A"}, {"Transform", turned({7, 8, -9}, -2.0, 3.0)}}));
  for (const char* from : {"Root", "A", "B", "C"}) {
    for (const char* to : {"Root", "A", "B", "C"}) {
      const glm::dvec4 point(1.5, -2.5, 3.5, 1.0);
      const glm::dmat4 expected =
          glm::inverse(scene.worldFromNode(*scene.node(to)).matrix()) * scene.worldFromNode(*scene.node(from)).matrix();
      const glm::dvec3 actual = Scene::relativeTransform(*scene.node(from), *scene.node(to)).point(glm::dvec3(point));
      EXPECT_LT(glm::distance(actual, glm::dvec3(expected * point)), 1e-12) << from << ' ' << to;
    }
  }
}

TEST(Scene, BodiesStandAndTurnWhereTheEphemerisSays) {
  Scene scene;
  const auto spice = [](Value target, Value observer) {
    return table(
        {{"Translation",
          table({{"Type", "SpiceTranslation"}, {"Target", std::move(target)}, {"Observer", std::move(observer)}})}});
  };
  add(scene, table({{"Identifier", "EarthBarycenter"}, {"Transform", spice(3, "SSB")}}));
  add(scene, table({{"Identifier", "EarthCenter"},
                    {"Parent", "EarthBarycenter"},
                    {"Transform", spice("EARTH", "EARTH BARYCENTER")}}));
  add(scene, table({{"Identifier", "Earth"},
                    {"Parent", "EarthCenter"},
                    {"Transform", table({{"Rotation", table({{"Type", "SpiceRotation"},
                                                             {"SourceFrame", "IAU_EARTH"},
                                                             {"DestinationFrame", "GALACTIC"}})}})}}));
  add(scene, table({{"Identifier", "Moon"}, {"Parent", "EarthBarycenter"}, {"Transform", spice("301", "3")}}));
  const Time time = *Time::fromUtc("2026-06-21T06:00:00");
  scene.evaluate(time);
  const auto galactic = ephemeris::Frame::galactic();
  const glm::dvec3 earth = glm::transpose(galactic.icrfFromFrame(time)) * ephemeris::relativePosition(399, 0, time);
  EXPECT_LT(glm::distance(scene.worldFromNode(*scene.node("Earth")).translation, earth), 1e-3);
  EXPECT_NEAR(glm::length(Scene::relativeTransform(*scene.node("Moon"), *scene.node("Earth")).translation),
              glm::length(ephemeris::relativePosition(301, 399, time)), 1e-3);
  // At the June solstice the Sun is over the tropic; at 06:00 UTC near 90 degrees east.
  const glm::dvec3 light = scene.lightDirection(*scene.node("Earth"));
  EXPECT_NEAR(glm::degrees(std::asin(light.z)), 23.44, 0.1);
  EXPECT_NEAR(glm::degrees(std::atan2(light.y, light.x)), 90.5, 1.0);
  // A node named Sun decides instead.
  add(scene, table({{"Identifier", "Sun"}, {"Transform", spice("SUN", "SSB")}}));
  EXPECT_LT(glm::distance(scene.lightDirection(*scene.node("Earth")), light), 1e-9);
}

TEST(Scene, WithoutASunLightComesFromTheOrigin) {
  Scene scene;
  SceneNode& node = add(scene, table({{"Identifier", "N"}, {"Transform", translation({0, 0, -5})}}));
  EXPECT_EQ(scene.lightDirection(node), glm::dvec3(0, 0, 1));
  EXPECT_EQ(scene.lightDirection(scene.root()), glm::dvec3(1, 0, 0));
}

TEST(Scene, ARenderableNamesTheNodeThatLightsIt) {
  Scene scene;
  scene.registerRenderable("Ball", [](const RenderableRequest&) { return std::make_unique<Ball>(); });
  SceneNode& node = add(
      scene,
      table({{"Identifier", "N"}, {"Renderable", table({{"Type", "Ball"}})}, {"Transform", translation({0, 0, -5})}}));
  add(scene, table({{"Identifier", "Sun"}, {"Transform", translation({0, 0, 5})}}));
  add(scene, table({{"Identifier", "Lamp"}, {"Transform", translation({0, -7, -5})}}));
  std::string& light = dynamic_cast<Ball&>(*node.renderable()).light;
  EXPECT_EQ(scene.lightDirection(node), glm::dvec3(0, 0, 1));
  light = "Lamp";
  EXPECT_EQ(scene.lightDirection(node), glm::dvec3(0, -1, 0));
  for (const char* useless : {"Gone", "N"}) {
    light = useless;
    EXPECT_EQ(scene.lightDirection(node), glm::dvec3(0, 0, 1)) << useless;
  }
}

TEST(Scene, ABodyWithoutAnEphemerisStaysAtItsParent) {
  Scene scene;
  SceneNode& titan =
      add(scene,
          table({{"Identifier", "Titan"},
                 {"Transform", table({{"Translation", table({{"Type", "SpiceTranslation"}, {"Target", "TITAN"}})}})}}));
  EXPECT_EQ(titan.parentFromNode().translation, glm::dvec3(0.0));
}

TEST(Scene, RefusesBadNodesAndSaysWhy) {
  Scene scene;
  add(scene, table({{"Identifier", "Taken"}}));
  const auto transform = [](const char* part, Value value) {
    return table({{"Identifier", "New"}, {"Transform", table({{part, std::move(value)}})}});
  };
  const std::pair<Value, const char*> cases[] = {
      {table({}), "Identifier"},
      {table({{"Identifier", "Taken"}}), "already"},
      {table({{"Identifier", "New"}, {"Parent", "Nobody"}}), "Nobody"},
      {table({{"Identifier", "New"}, {"GUI", table({{"Path", "Solar System"}})}}), "GUI.Path"},
      {table({{"Identifier", "New"}, {"Renderable", table({{"Type", "RenderableGlobe"}})}}), "globebrowsing"},
      {transform("Translation", table({{"Type", "StaticTranslation"}})), "Position"},
      {transform("Translation", table({{"Type", "GlobeTranslation"}})), "Globe"},
      {transform("Translation", table({{"Type", "WarpTranslation"}})), "not a transform type"},
      {transform("Translation", table({})), "no Type"},
      {transform("Rotation", table({{"Type", "StaticRotation"}, {"Rotation", Value(glm::dvec2(1, 2))}})), "3 (Euler"},
      {transform("Rotation", table({{"Type", "SpiceRotation"}, {"DestinationFrame", "GALACTIC"}})), "SourceFrame"},
      {transform("Rotation",
                 table({{"Type", "ConstantRotation"}, {"RotationAxis", Value(glm::dvec3(0))}, {"RotationRate", 1}})),
       "axis"},
      {transform("Scale", table({{"Type", "StaticScale"}})), "Scale"},
  };
  for (const auto& [node, expected] : cases) {
    const std::string message = refusal(scene, node);
    EXPECT_THAT(message, HasSubstr(expected)) << node.toLua();
    EXPECT_THAT(message, HasSubstr("test.asset:7")) << node.toLua();
    EXPECT_EQ(scene.node("New"), nullptr);
  }
}

TEST(Scene, RenderablesOfRegisteredTypesAreMadeAndOthersLeaveABareNode) {
  Scene scene;
  scene.registerRenderable("Ball", [](const RenderableRequest& request) -> Result<std::unique_ptr<Renderable>> {
    EXPECT_EQ(request.identifier, "N");
    return std::make_unique<Ball>();
  });
  SceneNode& node = add(scene, table({{"Identifier", "N"}, {"Renderable", table({{"Type", "Ball"}})}}));
  EXPECT_EQ(node.boundingSphere(), 42.0);
  EXPECT_EQ(node.renderable()->enabled.uri(), "Scene.N.Renderable.Enabled");
  EXPECT_EQ(add(scene, table({{"Identifier", "M"}, {"Renderable", table({{"Type", "Trail"}})}})).renderable(), nullptr);
}

TEST(Scene, RemovingANodeTakesWhatHangsOnItChildrenFirst) {
  Scene scene;
  add(scene, table({{"Identifier", "A"}}));
  add(scene, table({{"Identifier", "B"}, {"Parent", "A"}}));
  add(scene, table({{"Identifier", "Other"}}));
  add(scene, table({{"Identifier", "C"}, {"Parent", "B"}}));
  std::string order;
  const int key = scene.onRemove([&](SceneNode& node) { order += node.identifier(); });
  ASSERT_TRUE(scene.removeNode("A"));
  scene.forget(key);
  EXPECT_EQ(order, "CBA");
  EXPECT_EQ(scene.nodes().size(), 2U);
  EXPECT_EQ(scene.child("B"), nullptr);
  EXPECT_FALSE(scene.removeNode("A"));
  EXPECT_FALSE(scene.removeNode("Root"));
}

}  // namespace meridian::scene
