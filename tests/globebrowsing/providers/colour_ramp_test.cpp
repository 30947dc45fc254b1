#include "globebrowsing/providers/colour_ramp.h"

#include <string>

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

glm::dvec4 bytes(double red, double green, double blue, double alpha = 255.0) {
  return glm::dvec4(red, green, blue, alpha) / 255.0;
}

TEST(ColourRamp, ReadsWhatGdaldemReads) {
  const auto ramp = readColourRamp(
      "# metres and colours\n"
      "nv 0 0 0 0\n"
      "INTERPOLATION:INTERPOLATED\r\n"
      "3500 white\n"
      "2500,235:220\t175\n"
      "  50%   190 185 135 128\n"
      "-700 240 250 150;0 BLACK",
      {0.0, 2000.0});
  ASSERT_TRUE(ramp) << ramp.error().message();
  ASSERT_EQ(ramp->stops.size(), 5U);
  EXPECT_EQ(ramp->stops[0].value, -700.0);
  EXPECT_EQ(ramp->stops[0].colour, bytes(240, 250, 150));
  EXPECT_EQ(ramp->stops[1].value, 0.0);
  EXPECT_EQ(ramp->stops[1].colour, bytes(0, 0, 0));
  EXPECT_EQ(ramp->stops[2].value, 1000.0);
  EXPECT_EQ(ramp->stops[2].colour, bytes(190, 185, 135, 128));
  EXPECT_EQ(ramp->stops[3].colour, bytes(235, 220, 175));
  EXPECT_EQ(ramp->stops[4].value, 3500.0);
  EXPECT_EQ(ramp->stops[4].colour, bytes(255, 255, 255));
}

TEST(ColourRamp, OfTwoStopsWithOneValueTheFirstEndsWhatIsBelow) {
  const auto ramp = readColourRamp("0 blue; 0 green; 10 white", {0.0, 1.0});
  ASSERT_TRUE(ramp);
  EXPECT_EQ(ramp->stops[0].colour, bytes(0, 0, 255));
  EXPECT_EQ(ramp->stops[1].colour, bytes(0, 255, 0));
}

TEST(ColourRamp, SaysWhichLineIsWrong) {
  for (const std::string line : {"100 navy", "high red", "5 1 2", "5 1 2 256", "5 -1 2 3", "1e999 1 2 3", "nan 1 2 3",
                                 "5 1 2 3 4 5", "% red", "7"}) {
    const auto ramp = readColourRamp("0 black\n" + line, {0.0, 1.0});
    ASSERT_FALSE(ramp) << line;
    EXPECT_NE(ramp.error().what.find(line), std::string::npos) << ramp.error().message();
  }
  EXPECT_FALSE(readColourRamp("", {0.0, 1.0}));
  EXPECT_FALSE(readColourRamp("# nothing\nnv 1 2 3", {0.0, 1.0}));
  std::string many;
  for (std::size_t i = 0; i <= ColourRamp::mostStops; ++i) {
    many += std::to_string(i) + " red\n";
  }
  EXPECT_FALSE(readColourRamp(many, {0.0, 1.0}));
}

}  // namespace
}  // namespace meridian::globebrowsing
