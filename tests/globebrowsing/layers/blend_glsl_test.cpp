#include <random>

#include <glm/glm.hpp>
#include <gtest/gtest.h>

#include "globebrowsing/layers/blend.h"

/// The shaders' text, compiled as C++ against GLM, which follows GLSL's names and meanings.
namespace meridian::globebrowsing::glsl {
namespace {

using namespace glm;  // NOLINT(google-build-using-namespace)

// As glslLayerConstants() makes them; LayerGlsl.ConstantsAreTheEnumsNumbers checks that.
const int blendModeMultiply = 1;
const int blendModeMultiplyMix = 2;
const int blendModeAdd = 3;
const int blendModeSubtract = 4;
const int blendModeColor = 5;
const int adjustmentChromaKey = 1;

struct Layer {
  vec3 colour{1.0F};
  float opacity = 1.0F;
  vec3 chromaKeyColour{0.0F};
  float chromaKeyTolerance = 0.0F;
  float gamma = 1.0F;
  float multiplier = 1.0F;
  float offset = 0.0F;
};

#include "layers/blend.glsl"
#include "layers/compose_layer.glsl"

}  // namespace
}  // namespace meridian::globebrowsing::glsl

namespace meridian::globebrowsing {
namespace {

TEST(BlendGlsl, ComputesWhatTheReferenceComputes) {
  std::mt19937 random(2016);
  std::uniform_real_distribution<float> unit(0.0F, 1.0F);
  const auto colour = [&] { return glm::vec4(unit(random), unit(random), unit(random), unit(random)); };
  for (int n = 0; n < 20000; ++n) {
    const glm::vec4 below = colour();
    const glm::vec4 sampled = n % 11 == 0 ? glm::vec4(0.0F) : colour();
    glsl::Layer layer;
    layer.opacity = unit(random);
    layer.chromaKeyColour = glm::vec3(0.5F);
    layer.chromaKeyTolerance = 0.3F;
    layer.gamma = n % 3 == 0 ? 1.0F : 5.0F * unit(random);
    layer.multiplier = 2.0F * unit(random);
    layer.offset = 0.5F * unit(random);
    const int mode = n % 6;
    const int adjustment = n % 2;
    const glm::vec3 rgb(sampled.x, sampled.y, sampled.z);
    if (std::abs(glm::distance(rgb, layer.chromaKeyColour) - layer.chromaKeyTolerance) < 1e-5F) {
      continue;  // float and double may decide otherwise
    }

    glm::dvec4 expected(sampled);
    if (adjustment == static_cast<int>(Adjustment::ChromaKey)) {
      expected = chromaKey(expected, glm::dvec3(layer.chromaKeyColour), static_cast<double>(layer.chromaKeyTolerance));
    }
    expected = applySettings(expected, {static_cast<double>(layer.gamma), static_cast<double>(layer.multiplier),
                                        static_cast<double>(layer.offset)});
    expected.w *= static_cast<double>(layer.opacity);
    expected = blend(static_cast<BlendMode>(mode), glm::dvec4(below), expected);

    const bool unchanged = layer.gamma == 1.0F && layer.multiplier == 1.0F && layer.offset == 0.0F;
    const glm::vec4 found = glsl::composeLayer(layer, mode, adjustment, unchanged, sampled, below);
    for (int i = 0; i < 4; ++i) {
      ASSERT_NEAR(static_cast<double>(found[i]), expected[i], 1e-4)
          << name(static_cast<BlendMode>(mode)) << ", component " << i << ", case " << n;
    }
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
