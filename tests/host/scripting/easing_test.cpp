#include "host/scripting/easing.h"

#include <cmath>
#include <map>
#include <string>

#include <gtest/gtest.h>

namespace meridian::scripting {
namespace {

TEST(Easing, BeginsAtZeroAndEndsAtOne) {
  EXPECT_EQ(easings().size(), 28u);
  for (const NamedEasing& easing : easings()) {
    EXPECT_NEAR(easing.function(0.0), 0.0, 1e-12) << easing.name;
    EXPECT_NEAR(easing.function(1.0), 1.0, 1e-12) << easing.name;
  }
}

TEST(Easing, HasTheTextbookValueHalfWay) {
  const double s = std::sqrt(0.5);
  const std::map<std::string, double> half{{"Linear", 0.5},
                                           {"QuadraticEaseIn", 0.25},
                                           {"QuadraticEaseOut", 0.75},
                                           {"CubicEaseIn", 0.125},
                                           {"CubicEaseOut", 0.875},
                                           {"QuarticEaseIn", 0.0625},
                                           {"QuarticEaseOut", 0.9375},
                                           {"QuinticEaseIn", 0.03125},
                                           {"QuinticEaseOut", 0.96875},
                                           {"SineEaseIn", 1.0 - s},
                                           {"SineEaseOut", s},
                                           {"CircularEaseIn", 1.0 - std::sqrt(0.75)},
                                           {"CircularEaseOut", std::sqrt(0.75)},
                                           {"ExponentialEaseIn", 0.03125},
                                           {"ExponentialEaseOut", 0.96875},
                                           {"ElasticEaseIn", -s / 32.0},
                                           {"ElasticEaseOut", 1.0 + s / 32.0},
                                           {"BounceEaseIn", 1.0 - 0.765625},
                                           {"BounceEaseOut", 0.765625}};
  for (const NamedEasing& easing : easings()) {
    const auto expected = half.find(std::string(easing.name));
    EXPECT_NEAR(easing.function(0.5), expected != half.end() ? expected->second : 0.5, 1e-12) << easing.name;
  }
}

TEST(Easing, GrowsMonotonicallyAndIsContinuous) {
  for (const NamedEasing& easing : easings()) {
    const bool swings = easing.name.find("Elastic") == 0 || easing.name.find("Bounce") == 0;
    for (int i = 0; i < 1000; ++i) {
      const double before = easing.function(i / 1000.0);
      const double after = easing.function((i + 1) / 1000.0);
      EXPECT_LT(std::abs(after - before), 0.05) << easing.name << " at " << i;
      if (!swings) {
        EXPECT_GE(after, before) << easing.name << " at " << i;
      }
    }
  }
}

TEST(Easing, EaseInIsShallowFirstAndEaseOutLast) {
  for (const char* family : {"Quadratic", "Cubic", "Quartic", "Quintic", "Sine", "Circular", "Exponential"}) {
    EXPECT_LT((*easingFromName(std::string(family) + "EaseIn"))(0.25), 0.25) << family;
    EXPECT_GT((*easingFromName(std::string(family) + "EaseOut"))(0.25), 0.25) << family;
    EXPECT_LT((*easingFromName(std::string(family) + "EaseInOut"))(0.25), 0.25) << family;
    EXPECT_GT((*easingFromName(std::string(family) + "EaseInOut"))(0.75), 0.75) << family;
  }
}

TEST(Easing, UnknownNamesAreNone) {
  EXPECT_FALSE(easingFromName("Quadratic"));
  EXPECT_FALSE(easingFromName(""));
}

}  // namespace
}  // namespace meridian::scripting
