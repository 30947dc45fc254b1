#include "globebrowsing/layers/compose_heights.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

constexpr float none = std::numeric_limits<float>::quiet_NaN();
constexpr TileLayout threeByThree{3, 1, Registration::NodeRegistered};

HeightPixels filled(float metres) {
  HeightPixels pixels;
  pixels.size = threeByThree.size();
  pixels.metres.assign(25, metres);
  pixels.any = true;
  return pixels;
}

TEST(ComposeHeights, NothingAtAllIsTheEllipsoid) {
  const HeightPixels empty;
  for (const ComposedHeights& composed :
       {composeHeights({}, threeByThree), composeHeights(std::vector<HeightPart>{{&empty}, {nullptr}}, threeByThree)}) {
    EXPECT_THAT(composed.metres, testing::Each(0.0F));
    EXPECT_EQ(composed.metres.size(), 25U);
    EXPECT_EQ(composed.minimum, 0.0F);
    EXPECT_EQ(composed.maximum, 0.0F);
  }
}

TEST(ComposeHeights, MixesSettingsAndOpacityFromTheLowestUp) {
  const HeightPixels low = filled(100.0F);
  const HeightPixels high = filled(-9.0F);
  struct Case {
    std::vector<HeightPart> parts;
    float expected;
  };
  for (const Case& c :
       {Case{{{&low}}, 100.0F}, Case{{{&low, {}, 0.25}}, 25.0F}, Case{{{&low}, {&high}}, -9.0F},
        Case{{{&high}, {&low}}, 100.0F}, Case{{{&low}, {&high, {2.0, 10.0, 10.0}, 1.0}}, -800.0F},
        Case{{{&low}, {&high, {0.5, 2.0, 6.0}, 0.5}}, 50.0F}, Case{{{&low}, {&high, {}, 0.0}}, 100.0F}}) {
    EXPECT_THAT(composeHeights(c.parts, threeByThree).metres, testing::Each(testing::FloatEq(c.expected)));
  }
}

TEST(ComposeHeights, WhatIsNoNumberShowsWhatIsBelow) {
  const HeightPixels low = filled(100.0F);
  HeightPixels high = filled(200.0F);
  high.metres[12] = none;
  high.metres[13] = std::numeric_limits<float>::infinity();
  const ComposedHeights composed =
      composeHeights(std::vector<HeightPart>{{&low}, {&high, {0.0, 1.0, 5.0}}}, threeByThree);
  EXPECT_EQ(composed.metres[12], 100.0F);
  EXPECT_EQ(composed.metres[11], 6.0F);
  EXPECT_TRUE(std::all_of(composed.metres.begin(), composed.metres.end(), [](float m) { return std::isfinite(m); }));
  const HeightPixels nothing = filled(none);
  EXPECT_THAT(composeHeights(std::vector<HeightPart>{{&nothing}}, threeByThree).metres, testing::Each(0.0F));
}

TEST(ComposeHeights, SettingsDoNotRaiseBeyondTheLimits) {
  const HeightPixels low = filled(100.0F);
  const HeightLimits limits{-5000.0, 7000.0};
  EXPECT_THAT(composeHeights(std::vector<HeightPart>{{&low, {1.0, 1e30, 0.0}}}, threeByThree, limits).metres,
              testing::Each(7000.0F));
  EXPECT_THAT(composeHeights(std::vector<HeightPart>{{&low, {1.0, -1e30, 0.0}}}, threeByThree, limits).metres,
              testing::Each(-5000.0F));
}

TEST(ComposeHeights, AnAncestorsHeightsAreEnlarged) {
  HeightPixels slope = filled(0.0F);
  for (std::size_t i = 0; i < slope.metres.size(); ++i) {
    slope.metres[i] =
        static_cast<float>(10 * (i % 5) + 100 * (i / 5));  // columns and rows from -1/2 to 3/2 of the tile
  }
  // The south-western quarter: half as many columns and rows further apart, from the middle of the left edge.
  const std::vector<HeightPart> parts{{&slope, {}, 1.0, {{0.0, 0.5}, {0.5, 0.5}}}};
  const ComposedHeights composed = composeHeights(parts, threeByThree);
  for (std::size_t row = 0; row < 5; ++row) {
    for (std::size_t column = 0; column < 5; ++column) {
      const double expected = 10.0 * (1.0 + 0.5 * (static_cast<double>(column) - 1.0)) +
                              100.0 * (2.0 + 0.5 * (static_cast<double>(row) - 1.0));
      EXPECT_FLOAT_EQ(composed.metres[row * 5 + column], static_cast<float>(expected)) << column << " " << row;
    }
  }
}

TEST(ComposeHeights, TheRangeIsOfTheInteriorOnly) {
  HeightPixels pixels = filled(5.0F);
  pixels.metres[0] = -1000.0F;  // in the apron
  pixels.metres[24] = 1000.0F;
  pixels.metres[6] = 2.0F;
  pixels.metres[18] = 9.0F;
  const ComposedHeights composed = composeHeights(std::vector<HeightPart>{{&pixels}}, threeByThree);
  EXPECT_EQ(composed.minimum, 2.0F);
  EXPECT_EQ(composed.maximum, 9.0F);
  EXPECT_EQ(composed.metres[0], -1000.0F);
}

TEST(ComposeHeights, StaysFiniteAtTheLimitsOfTheSettings) {
  const HeightPixels deep = filled(-1.0e30F);
  const ComposedHeights composed = composeHeights(std::vector<HeightPart>{{&deep, {5.0, 20.0, 10000.0}}}, threeByThree);
  EXPECT_TRUE(std::isfinite(composed.minimum));
}

}  // namespace
}  // namespace meridian::globebrowsing
