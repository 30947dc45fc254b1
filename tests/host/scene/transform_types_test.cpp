// Every type of transform that assets name: what it does, and what it says of mistakes.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../navigation/smooth_ground.h"
#include "host/scene/scene.h"
#include "host/scene/scene_scripts.h"

namespace meridian::scene {

namespace {

using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180.0;

Value table(std::map<std::string, Value, std::less<>> fields) {
  return Table{{}, std::move(fields)};
}
Value list(std::vector<Value> items) {
  return Table{std::move(items), {}};
}
Value numbers(std::vector<double> items) {
  return Value(std::span<const double>(items));
}
Value translation(const glm::dvec3& position) {
  return table({{"Type", "StaticTranslation"}, {"Position", Value(position)}});
}
Value rotation(const glm::dvec3& angles) {
  return table({{"Type", "StaticRotation"}, {"Rotation", Value(angles)}});
}
Value scale(double factor) {
  return table({{"Type", "StaticScale"}, {"Scale", factor}});
}

class Transforms : public testing::Test {
 protected:
  Transforms() {
    std::string pattern = (std::filesystem::temp_directory_path() / "meridian-test-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    scene_.registerRenderable("SmoothGround", [](const RenderableRequest&) -> Result<std::unique_ptr<Renderable>> {
      return std::make_unique<test::SmoothGround>(250.0);
    });
  }
  ~Transforms() override { std::filesystem::remove_all(folder_); }

  /// The frame, in its parent's, of a node with that one part of a transform, at that UTC date.
  Transform frame(const char* part, const Value& value, const char* date = "2000-01-01T12:00:00") {
    (void)scene_.removeNode("Node");
    const auto added =
        scene_.addNode(table({{"Identifier", "Node"}, {"Parent", parent_}, {"Transform", table({{part, value}})}}),
                       "test.asset:3", folder_.string());
    EXPECT_TRUE(added) << added.error().message();
    scene_.evaluate(*Time::fromUtc(date));
    return added ? (*added)->parentFromNode() : Transform{};
  }
  std::string refusal(const char* part, const Value& value) {
    const auto added = scene_.addNode(table({{"Identifier", "Bad"}, {"Transform", table({{part, value}})}}),
                                      "test.asset:3", folder_.string());
    return added ? "accepted" : added.error().message();
  }
  void addGlobe() {
    ASSERT_TRUE(scene_.addNode(table({{"Identifier", "Globe"}, {"Renderable", table({{"Type", "SmoothGround"}})}}),
                               "test.asset:1", "/"));
    parent_ = "Globe";
  }
  std::string script(const std::string& text) {
    std::ofstream(folder_ / "script.lua") << text;
    return "script.lua";
  }

  std::filesystem::path folder_;
  Scene scene_;
  std::string parent_ = "Root";
};

TEST_F(Transforms, SeveralAreCombined) {
  const Value two = list({translation({1, 2, 3}), translation({10, 20, 30})});
  EXPECT_EQ(frame("Translation", table({{"Type", "MultiTranslation"}, {"Translations", two}})).translation,
            glm::dvec3(11, 22, 33));
  EXPECT_EQ(frame("Translation", two).translation, glm::dvec3(11, 22, 33)) << "a list means the same";
  EXPECT_EQ(frame("Scale", table({{"Type", "MultiScale"}, {"Scales", list({scale(2), scale(1.5)})}})).scale, 3.0);
  // First about x, which takes y to z, then about z, which leaves it there.
  const Value turns = list({rotation({0.5 * std::numbers::pi, 0, 0}), rotation({0, 0, 0.5 * std::numbers::pi})});
  const glm::dmat3 turned = frame("Rotation", table({{"Type", "MultiRotation"}, {"Rotations", turns}})).rotation;
  EXPECT_LT(glm::distance(turned * glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)), 1e-12);
  EXPECT_LT(glm::distance(turned * glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)), 1e-12);
}

TEST_F(Transforms, TimelinesMixWhatIsBetweenTheirKeyframes) {
  const Value frames = table({{"2000 JAN 01 12:00:00", translation({0, 0, 0})},
                              {"2000 JAN 02 12:00:00", translation({24, 0, 0})},
                              {"2000-01-03T12:00:00", translation({24, 48, 0})}});
  const Value mixed = table({{"Type", "TimelineTranslation"}, {"Keyframes", frames}});
  EXPECT_LT(glm::distance(frame("Translation", mixed, "2000-01-01T18:00:00").translation, glm::dvec3(6, 0, 0)), 1e-6);
  EXPECT_LT(glm::distance(frame("Translation", mixed, "2000-01-03T00:00:00").translation, glm::dvec3(24, 24, 0)), 1e-6);
  EXPECT_EQ(frame("Translation", mixed, "1990-01-01").translation, glm::dvec3(0, 0, 0));
  EXPECT_EQ(frame("Translation", mixed, "2020-01-01").translation, glm::dvec3(24, 48, 0));
  const Value stepped = table({{"Type", "TimelineTranslation"}, {"Keyframes", frames}, {"ShouldInterpolate", false}});
  EXPECT_EQ(frame("Translation", stepped, "2000-01-02T11:59:59").translation, glm::dvec3(0, 0, 0));

  const Value sizes = table({{"2000 JAN 01 12:00:00", scale(2.0)}, {"2000 JAN 02 12:00:00", scale(4.0)}});
  EXPECT_NEAR(frame("Scale", table({{"Type", "TimelineScale"}, {"Keyframes", sizes}}), "2000-01-02").scale, 3.0, 1e-9);
  const Value turns =
      table({{"2000 JAN 01 12:00:00", rotation({0, 0, 0})}, {"2000 JAN 02 12:00:00", rotation({0, 0, 1})}});
  const glm::dmat3 half =
      frame("Rotation", table({{"Type", "TimelineRotation"}, {"Keyframes", turns}}), "2000-01-02").rotation;
  EXPECT_LT(glm::distance(half * glm::dvec3(1, 0, 0), glm::dvec3(std::cos(0.5), std::sin(0.5), 0)), 1e-9);
}

TEST_F(Transforms, ScalesStayUsable) {
  EXPECT_EQ(frame("Scale", scale(0.0)).scale, 1e-30);
  EXPECT_EQ(frame("Scale", scale(-10.0)).scale, 1e-30);
  EXPECT_NEAR(frame("Scale", table({{"Type", "NonUniformStaticScale"}, {"Scale", numbers({1, 2, 4})}})).scale, 2.0,
              1e-12);
  const Value growing =
      table({{"Type", "TimeDependentScale"}, {"ReferenceDate", "2000 JAN 01 12:00:00"}, {"Speed", 2.0}});
  EXPECT_NEAR(frame("Scale", growing, "2000-01-01T12:00:10").scale, 20.0, 1e-6);
  EXPECT_EQ(frame("Scale", growing, "1999-01-01").scale, 1e-30);
}

TEST_F(Transforms, NodesStandOnGlobes) {
  addGlobe();
  const Value place = table(
      {{"Type", "GlobeTranslation"}, {"Globe", "Globe"}, {"Latitude", 47.0}, {"Longitude", 8.0}, {"Altitude", 10.0}});
  const test::SmoothGround ground;
  EXPECT_LT(glm::distance(frame("Translation", place).translation, ground.cartesian({47 * degree, 8 * degree, 10.0})),
            1e-6);
  const Value onTerrain = table({{"Type", "GlobeTranslation"},
                                 {"Globe", "Globe"},
                                 {"Latitude", 47.0},
                                 {"Longitude", 8.0},
                                 {"UseHeightmap", true}});
  EXPECT_LT(
      glm::distance(frame("Translation", onTerrain).translation, ground.cartesian({47 * degree, 8 * degree, 250.0})),
      1e-6);
  scene_.setEye([&](const SceneNode&) { return ground.cartesian({-30 * degree, 100 * degree, 5000.0}); });
  const Value below = table({{"Type", "GlobeTranslation"}, {"Globe", "Globe"}, {"UseCamera", true}});
  EXPECT_LT(glm::distance(frame("Translation", below).translation, ground.cartesian({-30 * degree, 100 * degree, 0.0})),
            1e-3);
  // +y is up and +x east; a quarter turn about up takes +x to the north.
  const Value upright =
      table({{"Type", "GlobeRotation"}, {"Globe", "Globe"}, {"Latitude", 0.0}, {"Longitude", 90.0}, {"Angle", 90.0}});
  const glm::dmat3 frameThere = frame("Rotation", upright).rotation;
  EXPECT_LT(glm::distance(frameThere * glm::dvec3(0, 1, 0), glm::dvec3(0, 1, 0)), 1e-12);
  EXPECT_LT(glm::distance(frameThere * glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1)), 1e-12);
  EXPECT_NEAR(glm::determinant(frameThere), 1.0, 1e-12);
  const Value atThePole = table({{"Type", "GlobeRotation"}, {"Globe", "Globe"}, {"Latitude", 90.0}});
  EXPECT_NEAR(glm::determinant(frame("Rotation", atThePole).rotation), 1.0, 1e-12);
  const Value nowhere = table({{"Type", "GlobeTranslation"}, {"Globe", "Gone"}});
  EXPECT_EQ(frame("Translation", nowhere).translation, glm::dvec3(0.0));
}

TEST_F(Transforms, FixedRotationPointsAxes) {
  ASSERT_TRUE(scene_.addNode(
      table({{"Identifier", "Mark"}, {"Transform", table({{"Translation", translation({0, 0, -9})}})}}), "t:1", "/"));
  const Value fixed = table({{"Type", "FixedRotation"},
                             {"Attached", "Node"},
                             {"YAxis", numbers({0, 1, 0.5})},
                             {"YAxisOrthogonal", true},
                             {"ZAxis", "Mark"}});
  const glm::dmat3 matrix = frame("Rotation", fixed).rotation;
  EXPECT_LT(glm::distance(matrix[2], glm::dvec3(0, 0, -1)), 1e-12);
  EXPECT_LT(glm::distance(matrix[1], glm::dvec3(0, 1, 0)), 1e-12);
  EXPECT_NEAR(glm::determinant(matrix), 1.0, 1e-12);
  const Value away = table({{"Type", "FixedRotation"}, {"ZAxis", "Mark"}, {"ZAxisInvert", true}});
  EXPECT_LT(glm::distance(frame("Rotation", away).rotation[2], glm::dvec3(0, 0, 1)), 1e-12);
  const Value nothing = table({{"Type", "FixedRotation"}, {"XAxis", numbers({0, 0, 0})}});
  EXPECT_EQ(frame("Rotation", nothing).rotation, glm::dmat3(1.0));
}

TEST_F(Transforms, LuaScriptsDecide) {
  const std::string file = script(
      "function translation(time, before, wall) return { time, 1, 2 } end\n"
      "function rotation() return { 0, 1, 0, -1, 0, 0, 0, 0, 1 } end\n"
      "function scale() return 7 end");
  const double seconds = Time::fromUtc("2000-01-01T12:00:00")->tdbSeconds();
  EXPECT_LT(glm::distance(frame("Translation", table({{"Type", "LuaTranslation"}, {"Script", file}})).translation,
                          glm::dvec3(seconds, 1, 2)),
            1e-9);
  EXPECT_LT(glm::distance(frame("Rotation", table({{"Type", "LuaRotation"}, {"Script", file}})).rotation[0],
                          glm::dvec3(0, 1, 0)),
            1e-12);
  EXPECT_EQ(frame("Scale", table({{"Type", "LuaScale"}, {"Script", file}})).scale, 7.0);
  // What goes wrong later leaves the node where it was.
  script("function translation() while true do end end function scale() return 'big' end");
  EXPECT_EQ(frame("Translation", table({{"Type", "LuaTranslation"}, {"Script", file}})).translation, glm::dvec3(0.0));
  EXPECT_EQ(frame("Scale", table({{"Type", "LuaScale"}, {"Script", file}})).scale, 1.0);
  script("function (");
  EXPECT_THAT(refusal("Scale", table({{"Type", "LuaScale"}, {"Script", file}})), HasSubstr("script.lua:1"));
}

TEST_F(Transforms, WhatNeedsDataWeDoNotReadStaysAtTheOrigin) {
  for (const char* type : {"GPTranslation", "HorizonsTranslation"}) {
    EXPECT_EQ(frame("Translation", table({{"Type", type}, {"File", "nowhere"}})).translation, glm::dvec3(0.0)) << type;
  }
  const Value unknown =
      table({{"Type", "SpiceRotation"}, {"SourceFrame", "IAU_NIBIRU"}, {"DestinationFrame", "GALACTIC"}});
  EXPECT_EQ(frame("Rotation", unknown).rotation, glm::dmat3(1.0));
}

TEST_F(Transforms, MistakesAreToldWithTheirKey) {
  const struct {
    const char* part;
    Value value;
    const char* says;
  } cases[] = {
      {"Translation", list({translation({1, 2, 3}), table({{"Type", "StaticTranslation"}})}),
       "Transform.Translation[2].Position"},
      {"Translation", table({{"Type", "MultiTranslation"}}), "Transform.Translation.Translations"},
      {"Translation", table({{"Type", "MultiTranslation"}, {"Translations", list({1.0})}}),
       "Transform.Translation.Translations[1]"},
      {"Translation", table({{"Type", "TimelineTranslation"}}), "Keyframes"},
      {"Translation",
       table({{"Type", "TimelineTranslation"}, {"Keyframes", table({{"soon", translation({1, 2, 3})}})}}),
       "Keyframes[soon]"},
      {"Translation", table({{"Type", "GlobeTranslation"}, {"Globe", "G"}, {"Latitude", 91.0}}), "Latitude"},
      {"Translation", table({{"Type", "LuaTranslation"}, {"Script", "missing.lua"}}), "missing.lua"},
      {"Scale", table({{"Type", "TimeDependentScale"}, {"ReferenceDate", "never"}}), "ReferenceDate"},
      {"Rotation", table({{"Type", "FixedRotation"}, {"XAxis", 4.0}}), "XAxis"},
  };
  for (const auto& each : cases) {
    EXPECT_THAT(refusal(each.part, each.value), HasSubstr(each.says)) << each.value.toLua();
    EXPECT_THAT(refusal(each.part, each.value), HasSubstr("test.asset:3")) << each.value.toLua();
  }
  Value deep = translation({1, 2, 3});
  for (int i = 0; i < 200; ++i) {
    deep = list({deep});
  }
  EXPECT_THAT(refusal("Translation", deep), HasSubstr("nested"));
}

TEST_F(Transforms, NodesMoveToOtherParents) {
  for (const char* node : {"A", "B", "Child"}) {
    ASSERT_TRUE(scene_.addNode(table({{"Identifier", node},
                                      {"Parent", node == std::string("Child") ? "A" : "Root"},
                                      {"Transform", table({{"Translation", translation({1, 0, 0})}})}}),
                               "t:1", "/"));
  }
  ASSERT_TRUE(scene_.setParent("A", "B"));
  EXPECT_EQ(scene_.worldFromNode(*scene_.node("Child")).translation, glm::dvec3(3, 0, 0));
  EXPECT_EQ(scene_.node("Child")->depth(), 3);
  EXPECT_FALSE(scene_.setParent("B", "Child")) << "it would hang on itself";
  EXPECT_FALSE(scene_.setParent("Root", "A"));
  EXPECT_FALSE(scene_.setParent("A", "Nobody"));
  ASSERT_TRUE(scene_.removeNode("B"));
  EXPECT_EQ(scene_.nodes().size(), 1U);
}

}  // namespace

}  // namespace meridian::scene
