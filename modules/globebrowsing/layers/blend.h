#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "globebrowsing/layers/layer_group.h"

namespace meridian::globebrowsing {

/// What a layer's colours go through, in this order: adjustment, settings, opacity, blend. Colours are red, green, blue
/// and alpha, not multiplied by alpha, 0..1 as a rule, and nothing is clamped. These are the reference for
/// shaders/layers/blend.glsl, which has the same functions by the same names.

/// Gamma, multiplier and offset of a layer.
struct LayerSettings {
  double gamma = 1.0;
  double multiplier = 1.0;
  double offset = 0.0;

  bool operator==(const LayerSettings&) const = default;
  [[nodiscard]] bool isIdentity() const { return *this == LayerSettings{}; }
};

/// sign(v) |v|^gamma multiplier + offset; 0 gives the offset, whatever the gamma.
[[nodiscard]] double applySettings(double value, const LayerSettings& settings);
/// On red, green and blue.
[[nodiscard]] glm::dvec4 applySettings(const glm::dvec4& colour, const LayerSettings& settings);

/// Nothing (all 0) where the colour is within `tolerance` (Euclidean, in 0..1 units) of the key.
[[nodiscard]] glm::dvec4 chromaKey(const glm::dvec4& colour, const glm::dvec3& key, double tolerance);

/// `layer` over `below`. With B the mode's formula on opaque colours, the layer's own colour becomes
/// mix(layer, B(below, layer), below's alpha) and is then laid over by its alpha (W3C Compositing 1, section 5), so
/// that in every mode an opacity of 0 changes nothing and the places without data show what is below.
///
///   Normal    layer
///   Multiply  below * layer
///   MultiplyMix  below * layer, laid over by the product of both alphas
///   Add       below + layer
///   Subtract  below - layer
///   Color     hue and saturation of below, value (HSV) the mean of the layer's red, green and blue
[[nodiscard]] glm::dvec4 blend(BlendMode mode, const glm::dvec4& below, const glm::dvec4& layer);

/// Hue, saturation and value, each 0..1 for colours in 0..1 (Smith 1978); grey has hue and saturation 0.
[[nodiscard]] glm::dvec3 hsvFromRgb(const glm::dvec3& rgb);
[[nodiscard]] glm::dvec3 rgbFromHsv(const glm::dvec3& hsv);

}  // namespace meridian::globebrowsing
