#include "globebrowsing/layers/layer_opacities.h"

#include <array>
#include <random>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include "globebrowsing/layers/layer_manager.h"

namespace meridian::globebrowsing {
namespace {

using Kind = OpacityDifference::Kind;

TEST(LayerOpacities, TellWhichOpacityDiffers) {
  const LayerOpacities all{{1, 1.0F}, {2, 0.5F}, {3, 1.0F}};
  EXPECT_EQ(difference(all, all).kind, Kind::None);
  const OpacityDifference one = difference(all, LayerOpacities{{1, 1.0F}, {2, 0.25F}, {3, 1.0F}});
  EXPECT_EQ(one.kind, Kind::OneOpacity);
  EXPECT_EQ(one.version, 2U);
  EXPECT_EQ(one.first, 0.5F);
  EXPECT_EQ(one.second, 0.25F);
  EXPECT_EQ(difference(all, LayerOpacities{{1, 0.9F}, {2, 0.25F}, {3, 1.0F}}).kind, Kind::Other);
}

TEST(LayerOpacities, ALayerThatIsNotThereIsInvisible) {
  const LayerOpacities all{{1, 1.0F}, {2, 0.5F}, {3, 1.0F}};
  for (const LayerOpacities& without : {LayerOpacities{{1, 1.0F}, {3, 1.0F}}, {{1, 1.0F}, {2, 0.0F}, {3, 1.0F}}}) {
    const OpacityDifference gone = difference(all, without);
    EXPECT_EQ(gone.kind, Kind::OneOpacity);
    EXPECT_EQ(gone.version, 2U);
    EXPECT_EQ(gone.first, 0.5F);
    EXPECT_EQ(gone.second, 0.0F);
    const OpacityDifference came = difference(without, all);
    EXPECT_EQ(came.kind, Kind::OneOpacity);
    EXPECT_EQ(came.second, 0.5F);
  }
  EXPECT_EQ(difference(LayerOpacities{{1, 0.0F}}, LayerOpacities{{7, 0.0F}, {8, 0.0F}}).kind, Kind::None);
  EXPECT_EQ(difference(LayerOpacities{}, LayerOpacities{{7, 1.0F}}).kind, Kind::OneOpacity);
  EXPECT_EQ(opacityOf(all, 2), 0.5F);
  EXPECT_EQ(opacityOf(all, 9), 0.0F);
}

TEST(LayerOpacities, AnotherOrderOrAnotherLayerIsMore) {
  EXPECT_EQ(difference(LayerOpacities{{1, 1.0F}, {2, 1.0F}}, LayerOpacities{{2, 1.0F}, {1, 1.0F}}).kind, Kind::Other);
  EXPECT_EQ(difference(LayerOpacities{{1, 1.0F}}, LayerOpacities{{2, 1.0F}}).kind, Kind::Other);
  EXPECT_EQ(difference(LayerOpacities{{1, 1.0F}, {2, 1.0F}, {3, 1.0F}}, LayerOpacities{{3, 1.0F}}).kind, Kind::Other);
}

TEST(LayerOpacities, WeightsGoFromOneEndToTheOther) {
  EXPECT_FLOAT_EQ(mixingWeight(0.2F, 1.0F, 0.6F), 0.5F);
  EXPECT_FLOAT_EQ(mixingWeight(0.8F, 0.0F, 0.2F), 0.75F);
  EXPECT_EQ(mixingWeight(0.8F, 0.0F, 0.0F), 1.0F);
  EXPECT_GT(mixingWeight(0.2F, 0.5F, 0.7F), 1.0F);
  EXPECT_LT(mixingWeight(0.2F, 0.5F, 0.1F), 0.0F);
  EXPECT_EQ(mixingWeight(0.5F, 0.5F, 0.7F), 0.0F);
}

/// What mixesExactly claims, against the blending itself: composites of random colours at three opacities.
TEST(LayerOpacities, ClaimsExactnessWhereBlendingIsLinear) {
  std::mt19937 engine(7);
  const auto random = [&] { return std::uniform_real_distribution<double>()(engine); };
  using Colour = glm::dvec4;
  const auto store = [](const Colour& colour) { return glm::clamp(colour, 0.0, 1.0); };
  const auto times = [](const Colour& colour) { return Colour(glm::dvec3(colour) * colour.w, colour.w); };
  for (const auto& [group, background] :
       {std::pair("ColorLayers", Colour(0.3, 0.3, 0.3, 1.0)), std::pair("Overlays", Colour(0.0))}) {
    for (int lower = 0; lower < 6; ++lower) {
      for (int upper = 0; upper < 6; ++upper) {
        LayerManager manager;
        std::vector<Layer*> layers;
        for (const auto& [name, mode] : {std::pair("a", 0), std::pair("b", lower), std::pair("c", upper)}) {
          const auto added = manager.addLayer(
              group, {Table{{}, {{"Identifier", name}, {"Type", "SolidColor"}, {"Color", Value(glm::dvec3(1.0))}}},
                      "test", "", ""});
          ASSERT_TRUE(added) << added.error().message();
          (*added)->blendMode.put(mode);
          layers.push_back(*added);
        }
        double worst = 0.0;
        for (int n = 0; n < 300; ++n) {
          const std::array<Colour, 3> colours{Colour(random(), random(), random(), random()),
                                              Colour(random(), random(), random(), random()),
                                              Colour(random(), random(), random(), random())};
          const auto composed = [&](double opacity) {
            Colour result = background;
            for (std::size_t i = 0; i < layers.size(); ++i) {
              Colour own = colours[i];
              own.w *= i == 1 ? opacity : 1.0;
              result = blend(layers[i]->blend(), result, own);
            }
            return times(store(result));
          };
          const Colour mixed = glm::mix(composed(0.0), composed(0.8), 0.5);
          const Colour expected = composed(0.4);
          for (int i = 0; i < 4; ++i) {
            worst = std::max(worst, std::abs(mixed[i] - expected[i]));
          }
        }
        const bool isColorOnColor = lower == upper && lower == static_cast<int>(BlendMode::Color);
        EXPECT_EQ(mixesExactly(layers, 1), worst < 1e-9 && !isColorOnColor)
            << group << ": " << blendModeNames()[static_cast<std::size_t>(lower)] << " below "
            << blendModeNames()[static_cast<std::size_t>(upper)] << ": " << worst;
      }
    }
  }
}

TEST(LayerOpacities, ClaimsNothingOfColoursBeyondTheRange) {
  LayerManager manager;
  const auto added = manager.addLayer(
      "ColorLayers",
      {Table{{}, {{"Identifier", "a"}, {"Type", "SolidColor"}, {"Color", Value(glm::dvec3(1.0))}}}, "test", "", ""});
  ASSERT_TRUE(added);
  const std::vector<Layer*> layers{*added};
  EXPECT_TRUE(mixesExactly(layers, 0));
  layers[0]->gamma.put(2.0);
  EXPECT_TRUE(mixesExactly(layers, 0));
  layers[0]->multiplier.put(1.5);
  EXPECT_FALSE(mixesExactly(layers, 0));
  layers[0]->multiplier.put(0.5);
  layers[0]->offset.put(0.4);
  EXPECT_TRUE(mixesExactly(layers, 0));
  layers[0]->offset.put(-0.4);
  EXPECT_FALSE(mixesExactly(layers, 0));
}

}  // namespace
}  // namespace meridian::globebrowsing
