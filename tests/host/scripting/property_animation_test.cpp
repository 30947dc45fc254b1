#include "host/scripting/property_animation.h"

#include <optional>

#include <gtest/gtest.h>

#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::scripting {
namespace {

class PropertyAnimationTest : public testing::Test {
 protected:
  PropertyAnimationTest() {
    for (Property* property :
         {static_cast<Property*>(&opacity_), static_cast<Property*>(&count_), static_cast<Property*>(&offset_)}) {
      root_.addProperty(*property);
    }
  }
  PropertyAnimation::Movement to(Value target, double seconds, std::string script = {}) {
    return {std::move(target), seconds, *easingFromName("Linear"), std::move(script)};
  }

  PropertyOwner root_{""};
  FloatProperty opacity_{{"Opacity"}, 0.0, {0.0, 1.0}};
  IntProperty count_{{"Count"}, 0};
  Vec3Property offset_{{"Offset"}, glm::dvec3(0.0)};
  PropertyIndex index_{root_};
  std::vector<std::string> scripts_;
  PropertyAnimation animation_{index_, [this](std::string text) { scripts_.push_back(std::move(text)); }};
};

TEST_F(PropertyAnimationTest, GoesThereInFrameTime) {
  animation_.start({&opacity_}, to(1.0, 2.0));
  animation_.advance(0.5);
  EXPECT_DOUBLE_EQ(opacity_.get(), 0.25);
  animation_.advance(1.0);
  EXPECT_DOUBLE_EQ(opacity_.get(), 0.75);
  EXPECT_TRUE(animation_.isMoving(opacity_));
  animation_.advance(5.0);
  EXPECT_EQ(opacity_.get(), 1.0);
  EXPECT_TRUE(animation_.isIdle());
}

TEST_F(PropertyAnimationTest, MovesVectorsAndRoundsWholeNumbers) {
  animation_.start({&offset_}, to(Value(glm::dvec3(4.0, 8.0, -4.0)), 1.0));
  animation_.start({&count_}, to(10, 1.0));
  animation_.advance(0.26);
  EXPECT_DOUBLE_EQ(offset_.get().y, 2.08);
  EXPECT_EQ(count_.get(), 3);
}

TEST_F(PropertyAnimationTest, AddsUpThousandsOfSmallSteps) {
  animation_.start({&opacity_}, to(1.0, 1000.0 / 60.0));
  for (int i = 0; i < 500; ++i) {
    animation_.advance(1.0 / 60.0);
  }
  EXPECT_NEAR(opacity_.get(), 0.5, 1e-12);
}

TEST_F(PropertyAnimationTest, ANewMovementBeginsAtThePresentValue) {
  animation_.start({&opacity_}, to(1.0, 1.0, "old()"));
  animation_.advance(0.5);
  animation_.start({&opacity_}, to(0.0, 1.0, "new()"));
  animation_.advance(0.5);
  EXPECT_DOUBLE_EQ(opacity_.get(), 0.25);
  animation_.advance(1.0);
  EXPECT_EQ(scripts_, std::vector<std::string>{"new()"});
}

TEST_F(PropertyAnimationTest, RunsThePostScriptOnceForAllProperties) {
  animation_.start({&opacity_, &count_}, to(1.0, 1.0, "done()"));
  animation_.advance(0.9);
  EXPECT_TRUE(scripts_.empty());
  animation_.advance(0.2);
  EXPECT_EQ(scripts_, std::vector<std::string>{"done()"});
}

TEST_F(PropertyAnimationTest, BouncesUntilItIsStopped) {
  PropertyAnimation::Movement movement = to(1.0, 1.0);
  movement.bouncing = true;
  animation_.start({&opacity_}, movement);
  for (const double expected : {0.75, 0.5, 0.25, 1.0}) {
    animation_.advance(0.75);
    EXPECT_NEAR(opacity_.get(), expected, 1e-12);
  }
  EXPECT_TRUE(animation_.stopBouncing("Opacity"));
  EXPECT_FALSE(animation_.stopBouncing("Opacity"));
  EXPECT_TRUE(animation_.isIdle());
}

TEST_F(PropertyAnimationTest, StaysInRangeWhileAnEasingSwings) {
  animation_.start({&opacity_}, {1.0, 1.0, *easingFromName("ElasticEaseOut")});
  for (int i = 0; i < 110; ++i) {
    animation_.advance(0.01);
    EXPECT_LE(opacity_.get(), 1.0);
  }
  EXPECT_EQ(opacity_.get(), 1.0);
}

TEST_F(PropertyAnimationTest, ForgetsPropertiesThatAreGone) {
  std::optional<FloatProperty> passing(std::in_place, Property::Description{"Passing"}, 0.0);
  root_.addProperty(*passing);
  animation_.start({&*passing, &opacity_}, to(1.0, 1.0));
  passing.reset();
  animation_.advance(0.5);
  EXPECT_DOUBLE_EQ(opacity_.get(), 0.5);
}

TEST_F(PropertyAnimationTest, ACallbackMayStartAnotherMovement) {
  opacity_.onChange([this] {
    if (opacity_.get() == 1.0) {
      animation_.start({&count_, &opacity_}, to(0.0, 1.0));
    }
  });
  animation_.start({&opacity_}, to(1.0, 1.0));
  animation_.advance(1.0);
  EXPECT_TRUE(animation_.isMoving(opacity_));
  animation_.advance(0.5);
  EXPECT_DOUBLE_EQ(opacity_.get(), 0.5);
}

}  // namespace
}  // namespace meridian::scripting
