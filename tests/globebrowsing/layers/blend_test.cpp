#include "globebrowsing/layers/blend.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

void expectNear(const glm::dvec4& found, const glm::dvec4& expected, const char* what) {
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(found[i], expected[i], 1e-12) << what << ", component " << i;
  }
}

TEST(Blend, SettingsKeepTheSignAndAddTheOffsetLast) {
  struct Case {
    double value, gamma, multiplier, offset, expected;
  };
  for (const Case& c :
       {Case{0.25, 0.5, 1.0, 0.0, 0.5}, Case{-4.0, 2.0, 1.0, 0.0, -16.0}, Case{3.0, 1.0, 2.0, -1.0, 5.0},
        Case{-2.0, 0.0, 3.0, 1.0, -2.0}, Case{0.0, 0.0, 20.0, 7.0, 7.0}, Case{0.3, 1.0, 1.0, 0.0, 0.3}}) {
    EXPECT_DOUBLE_EQ(applySettings(c.value, {c.gamma, c.multiplier, c.offset}), c.expected);
  }
  EXPECT_TRUE(std::isnan(applySettings(std::nan(""), {2.0, 1.0, 0.0})));
  EXPECT_EQ(applySettings(glm::dvec4(0.5, 0.25, 0.0, 0.7), {1.0, 2.0, 0.1}), glm::dvec4(1.1, 0.6, 0.1, 0.7));
}

TEST(Blend, ChromaKeyDropsWhatIsNear) {
  const glm::dvec4 dark(0.1, 0.0, 0.0, 1.0);
  EXPECT_EQ(chromaKey(dark, glm::dvec3(0.0), 0.1), glm::dvec4(0.0));
  EXPECT_EQ(chromaKey(dark, glm::dvec3(0.0), 0.09), dark);
}

struct BlendCase {
  BlendMode mode;
  glm::dvec4 below, layer, expected;
};

class BlendModes : public testing::TestWithParam<BlendCase> {};

TEST_P(BlendModes, GiveWhatTheFormatDescriptionSays) {
  const BlendCase& c = GetParam();
  expectNear(blend(c.mode, c.below, c.layer), c.expected, name(c.mode).data());
}

const glm::dvec4 orange(0.8, 0.4, 0.2, 1.0);
const glm::dvec4 grey(0.5, 0.5, 0.5, 1.0);

INSTANTIATE_TEST_SUITE_P(
    OpenSpacesFormulas, BlendModes,
    testing::Values(
        BlendCase{BlendMode::Normal, grey, orange, orange},
        BlendCase{BlendMode::Normal, grey, {0.8, 0.4, 0.2, 0.25}, {0.575, 0.475, 0.425, 1.0}},
        BlendCase{BlendMode::Normal, {1.0, 0.0, 0.0, 0.5}, {0.0, 1.0, 0.0, 0.5}, {1.0 / 3.0, 2.0 / 3.0, 0.0, 0.75}},
        BlendCase{BlendMode::Normal, glm::dvec4(0.0), glm::dvec4(0.0), glm::dvec4(0.0)},
        BlendCase{BlendMode::Multiply, grey, orange, {0.4, 0.2, 0.1, 1.0}},
        BlendCase{BlendMode::MultiplyMix, grey, orange, {0.4, 0.2, 0.1, 1.0}},
        BlendCase{BlendMode::MultiplyMix, grey, {0.8, 0.4, 0.2, 0.5}, {0.45, 0.35, 0.3, 1.0}},
        BlendCase{BlendMode::Add, grey, orange, {1.3, 0.9, 0.7, 1.0}},
        BlendCase{BlendMode::Subtract, grey, orange, {-0.3, 0.1, 0.3, 1.0}},
        // Brightness from the layer (mean 0.3), hue 20 degrees and saturation 0.75 from below.
        BlendCase{BlendMode::Color, orange, {0.6, 0.2, 0.1, 1.0}, {0.3, 0.15, 0.075, 1.0}},
        BlendCase{BlendMode::Color, grey, orange, {1.4 / 3.0, 1.4 / 3.0, 1.4 / 3.0, 1.0}}));

TEST(Blend, AnInvisibleLayerChangesNothingInAnyMode) {
  for (int mode = 0; mode < 6; ++mode) {
    for (const glm::dvec4& below : {orange, grey, glm::dvec4(0.2, 0.9, 0.4, 0.3)}) {
      expectNear(blend(static_cast<BlendMode>(mode), below, {0.9, 0.1, 0.3, 0.0}), below, "opacity 0");
      expectNear(blend(static_cast<BlendMode>(mode), below, glm::dvec4(0.0)), below, "no data");
    }
  }
}

TEST(Blend, AllModesButMultiplyMixShowThemselvesOverNothing) {
  for (const BlendMode mode :
       {BlendMode::Normal, BlendMode::Multiply, BlendMode::Add, BlendMode::Subtract, BlendMode::Color}) {
    expectNear(blend(mode, glm::dvec4(0.0), orange), orange, name(mode).data());
  }
}

TEST(Blend, HsvGoesThereAndBack) {
  const std::pair<glm::dvec3, glm::dvec3> table[] = {{{1.0, 0.0, 0.0}, {0.0, 1.0, 1.0}},
                                                     {{0.0, 1.0, 0.0}, {1.0 / 3.0, 1.0, 1.0}},
                                                     {{0.0, 0.0, 0.5}, {2.0 / 3.0, 1.0, 0.5}},
                                                     {{1.0, 0.0, 1.0}, {5.0 / 6.0, 1.0, 1.0}},
                                                     {{0.7, 0.7, 0.7}, {0.0, 0.0, 0.7}}};
  for (const auto& [rgb, hsv] : table) {
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(hsvFromRgb(rgb)[i], hsv[i], 1e-15);
    }
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int n = 0; n < 1000; ++n) {
    const glm::dvec3 rgb(unit(random), unit(random), unit(random));
    const glm::dvec3 back = rgbFromHsv(hsvFromRgb(rgb));
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(back[i], rgb[i], 1e-12);
    }
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
