#include "globebrowsing/layers/blend.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace meridian::globebrowsing {

namespace {

glm::dvec3 rgbOf(const glm::dvec4& colour) {
  return {colour.x, colour.y, colour.z};
}

/// Straight alpha "over"; where nothing is, the colour is 0.
glm::dvec4 over(const glm::dvec4& below, const glm::dvec3& rgb, double alpha) {
  const double sum = below.w + alpha * (1.0 - below.w);
  return sum <= 0.0 ? glm::dvec4(0.0) : glm::dvec4(glm::mix(rgbOf(below) * below.w, rgb, alpha) / sum, sum);
}

glm::dvec3 blendOpaque(BlendMode mode, const glm::dvec3& below, const glm::dvec3& layer) {
  switch (mode) {
    case BlendMode::Normal:
      return layer;
    case BlendMode::Multiply:
    case BlendMode::MultiplyMix:
      return below * layer;
    case BlendMode::Add:
      return below + layer;
    case BlendMode::Subtract:
      return below - layer;
    case BlendMode::Color: {
      const glm::dvec3 hsv = hsvFromRgb(below);
      return rgbFromHsv({hsv.x, hsv.y, (layer.x + layer.y + layer.z) / 3.0});
    }
  }
  return layer;
}

}  // namespace

double applySettings(double value, const LayerSettings& settings) {
  if (value == 0.0) {
    return settings.offset;
  }
  const double power = settings.gamma == 1.0 ? value : std::copysign(std::pow(std::abs(value), settings.gamma), value);
  return power * settings.multiplier + settings.offset;
}

glm::dvec4 applySettings(const glm::dvec4& colour, const LayerSettings& settings) {
  return {applySettings(colour.x, settings), applySettings(colour.y, settings), applySettings(colour.z, settings),
          colour.w};
}

glm::dvec4 chromaKey(const glm::dvec4& colour, const glm::dvec3& key, double tolerance) {
  return glm::distance(rgbOf(colour), key) <= tolerance ? glm::dvec4(0.0) : colour;
}

glm::dvec4 blend(BlendMode mode, const glm::dvec4& below, const glm::dvec4& layer) {
  const glm::dvec3 opaque = blendOpaque(mode, rgbOf(below), rgbOf(layer));
  if (mode == BlendMode::MultiplyMix) {
    return over(below, opaque, below.w * layer.w);
  }
  return over(below, glm::mix(rgbOf(layer), opaque, below.w), layer.w);
}

glm::dvec3 hsvFromRgb(const glm::dvec3& rgb) {
  const double value = std::max({rgb.x, rgb.y, rgb.z});
  const double chroma = value - std::min({rgb.x, rgb.y, rgb.z});
  if (chroma <= 0.0) {
    return {0.0, 0.0, value};
  }
  double sixths = 0.0;
  if (value == rgb.x) {
    sixths = (rgb.y - rgb.z) / chroma + (rgb.y < rgb.z ? 6.0 : 0.0);
  } else if (value == rgb.y) {
    sixths = (rgb.z - rgb.x) / chroma + 2.0;
  } else {
    sixths = (rgb.x - rgb.y) / chroma + 4.0;
  }
  return {sixths / 6.0, value > 0.0 ? chroma / value : 0.0, value};
}

glm::dvec3 rgbFromHsv(const glm::dvec3& hsv) {
  const auto channel = [&](double shift) {
    const double distance = std::abs(glm::fract(hsv.x + shift) * 6.0 - 3.0) - 1.0;
    return hsv.z * (1.0 - hsv.y * (1.0 - std::clamp(distance, 0.0, 1.0)));
  };
  return {channel(0.0), channel(2.0 / 3.0), channel(1.0 / 3.0)};
}

}  // namespace meridian::globebrowsing
