#include "host/navigation/flight.h"

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/navigation/flight_scripts.h"
#include "host/navigation/geodetic_pose.h"
#include "host/navigation/placing_scripts.h"
#include "smooth_ground.h"

namespace meridian::navigation {

namespace {

using testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180.0;

class Flights : public testing::Test {
 protected:
  Flights() {
    scene_.registerRenderable("SmoothGround", [](const RenderableRequest&) -> Result<std::unique_ptr<Renderable>> {
      return std::make_unique<test::SmoothGround>(0.0);
    });
    add({{"Identifier", "Globe"}, {"Renderable", Table{{}, {{"Type", "SmoothGround"}}}}});
    const Value place = Table{{}, {{"Type", "StaticTranslation"}, {"Position", Value(glm::dvec3(1e9, 0, 0))}}};
    add({{"Identifier", "Far"}, {"BoundingSphere", 1000.0}, {"Transform", Table{{}, {{"Translation", place}}}}});
    EXPECT_TRUE(camera_.setPose("Globe", poseFromGeodetic(ground(), {{0.8, 0.1, 2e6}, 0.0, -1.5, 0.0})));
  }
  void add(std::map<std::string, Value, std::less<>> node) {
    EXPECT_TRUE(scene_.addNode(Table{{}, std::move(node)}, "test", "/"));
  }
  [[nodiscard]] const Ground& ground() const { return *scene_.node("Globe")->ground(); }
  [[nodiscard]] GeodeticPosition place() const { return ground().geodetic(camera_.pose().position); }
  std::string call(const std::string& name, std::vector<Value> arguments) {
    const ScriptLibrary flights = flightLibrary(camera_, navigator_, flight_);
    const ScriptLibrary paths = pathLibrary(camera_, navigator_, flight_);
    const ScriptLibrary placing{"", placingFunctions(scene_, camera_, navigator_)};
    for (const ScriptLibrary* library : {&flights, &paths, &placing}) {
      for (const ScriptFunction& function : library->functions) {
        if (function.name == name) {
          const ScriptResult result = function.call(arguments);
          results_ = result.value_or(std::vector<Value>());
          return result ? "" : result.error().message();
        }
      }
    }
    return "no function " + name;
  }
  void fly(double seconds) {
    for (double t = 0.0; t < seconds; t += 0.1) {
      flight_.advance(0.1);
      navigator_.update(0.1);
    }
  }

  scene::Scene scene_;
  Camera camera_{scene_};
  OrbitNavigator navigator_{camera_};
  Flight flight_{camera_, navigator_};
  std::vector<Value> results_;
};

TEST_F(Flights, ArriveWhereTheyShould) {
  EXPECT_EQ(call("flyToGeo", {"Globe", -33.0, 151.0, 5000.0, 4.0}), "");
  EXPECT_TRUE(flight_.isFlying());
  double lowest = 1e9;
  for (int i = 0; i < 50; ++i) {
    fly(0.1);
    lowest = std::min(lowest, place().height);
  }
  EXPECT_FALSE(flight_.isFlying());
  EXPECT_GE(lowest, 4999.9) << "never below where it ends";
  EXPECT_NEAR(place().latitude / degree, -33.0, 1e-6);
  EXPECT_NEAR(place().longitude / degree, 151.0, 1e-6);
  EXPECT_NEAR(place().height, 5000.0, 1e-3);
}

TEST_F(Flights, ToTheOtherSideGoRoundTheBody) {
  const Pose from{{1.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}};
  const Pose to{{-1.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}};
  for (double share = 0.0; share <= 1.0; share += 0.05) {
    EXPECT_GE(glm::length(poseBetween(from, to, share).position), 1.0 - 1e-12) << share;
  }
  EXPECT_LT(glm::distance(poseBetween(from, to, 1.0).position, to.position), 1e-12);
}

TEST_F(Flights, ToOtherNodesChangeTheAnchor) {
  EXPECT_EQ(call("flyTo", {"Far", true, 2.0}), "");
  EXPECT_EQ(camera_.anchor().identifier(), "Far");
  fly(3.0);
  EXPECT_NEAR(glm::length(camera_.pose().position), 3000.0, 1.0);
  EXPECT_LT(glm::distance(camera_.pose().ahead(), -glm::normalize(camera_.pose().position)), 1e-6);
  EXPECT_EQ(call("flyToHeight", {"Far", 500.0, 1.0}), "");
  fly(2.0);
  EXPECT_NEAR(glm::length(camera_.pose().position), 1500.0, 1.0);
}

TEST_F(Flights, EndWhenTheUserMoves) {
  EXPECT_EQ(call("flyToGeo2", {"Globe", 10.0, 20.0, true, 4.0}), "");
  fly(1.0);
  navigator_.scroll(0.1);
  fly(0.1);
  EXPECT_FALSE(flight_.isFlying());
}

TEST_F(Flights, CanBePausedSkippedAndStopped) {
  const Value path = Table{{}, {{"TargetType", "Node"}, {"Target", "Far"}, {"Duration", 3.0}}};
  EXPECT_EQ(call("createPath", {path}), "");
  EXPECT_EQ(call("pausePath", {}), "");
  const glm::dvec3 before = camera_.pose().position;
  flight_.advance(1.0);
  EXPECT_EQ(camera_.pose().position, before);
  EXPECT_EQ(call("skipToEnd", {}), "");
  EXPECT_NEAR(glm::length(camera_.pose().position), 3000.0, 1e-6);
  EXPECT_EQ(call("createPath", {path}), "");
  EXPECT_EQ(call("stopPath", {}), "");
  EXPECT_EQ(call("isFlying", {}), "");
  EXPECT_EQ(results_.at(0), Value(false));
}

TEST_F(Flights, RefuseWhatIsNowhere) {
  EXPECT_THAT(call("flyTo", {"Nobody"}), HasSubstr("Nobody"));
  EXPECT_THAT(call("flyToGeo", {"Far", 1.0, 2.0, 3.0}), HasSubstr("not a globe"));
  EXPECT_THAT(call("flyToGeo", {"Globe", 91.0, 2.0, 3.0}), HasSubstr("-90..90"));
  EXPECT_THAT(call("flyToGeo", {"Globe", std::nan(""), 2.0, 3.0}), HasSubstr("finite"));
  EXPECT_THAT(call("createPath", {Table{}}), HasSubstr("TargetType"));
  EXPECT_FALSE(flight_.isFlying());
}

TEST_F(Flights, NodesArePlacedOverGlobes) {
  const Value fixed = Table{{}, {{"Type", "StaticTranslation"}, {"Position", Value(glm::dvec3(0.0))}}};
  add({{"Identifier", "Pin"}, {"Transform", Table{{}, {{"Translation", fixed}}}}});
  EXPECT_EQ(call("setNodePosition", {"Pin", "Globe", 10.0, 20.0, 300.0}), "");
  scene_.evaluate(Time());
  EXPECT_EQ(scene_.node("Pin")->parentNode()->identifier(), "Globe");
  EXPECT_LT(glm::distance(scene_.node("Pin")->parentFromNode().translation,
                          ground().cartesian({10 * degree, 20 * degree, 300.0})),
            1e-6);
  const Value onGlobe = Table{{}, {{"Type", "GlobeTranslation"}, {"Globe", "Globe"}}};
  add({{"Identifier", "Flag"}, {"Parent", "Globe"}, {"Transform", Table{{}, {{"Translation", onGlobe}}}}});
  EXPECT_EQ(call("setNodePositionFromCamera", {"Flag", true}), "");
  scene_.evaluate(Time());
  EXPECT_LT(glm::distance(scene_.node("Flag")->parentFromNode().translation, camera_.pose().position), 1e-2);
  EXPECT_THAT(call("setNodePosition", {"Far", "Far", 1.0, 2.0}), HasSubstr("not a globe"));
  EXPECT_THAT(call("setNodePosition", {"Globe", "Globe", 1.0, 2.0}), HasSubstr("cannot be placed"));
}

TEST_F(Flights, TellAndTakePlacesOfTheCamera) {
  EXPECT_EQ(call("goToChunk", {"Globe", 1.0, 0.0, 1.0}), "");
  EXPECT_EQ(call("geoPositionForCamera", {}), "");
  ASSERT_EQ(results_.size(), 3U);
  EXPECT_NEAR(*results_[0].number(), 0.0, 1e-6);
  EXPECT_NEAR(*results_[1].number(), 90.0, 1e-6);
  EXPECT_GT(*results_[2].number(), 6e6);
  for (const std::vector<Value>& bad :
       {std::vector<Value>{"Globe", 2.0, 0.0, 1.0}, {"Globe", 0.0, 1.0, 1.0}, {"Globe", 0.0, 0.0, 31.0}}) {
    EXPECT_THAT(call("goToChunk", bad), HasSubstr("no such chunk"));
  }
}

}  // namespace

}  // namespace meridian::navigation
