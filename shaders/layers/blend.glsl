// What a layer's colours go through: adjustment, settings, blend. The formulas and their reasons are in
// modules/globebrowsing/layers/blend.h; a test compiles this file as C++ and compares it with them, so it keeps to what
// GLSL and GLM have in common: suffixed literals, constructors for conversions, no swizzles, no inout.
// Needs glslLayerConstants() before it.

vec3 rgbOf(vec4 colour) { return vec3(colour.x, colour.y, colour.z); }

float applySettings(float value, float gamma, float multiplier, float offset) {
  if (value == 0.0f) {
    return offset;  // pow(0, 0) is undefined
  }
  float power = gamma == 1.0f ? value : sign(value) * pow(abs(value), gamma);
  return power * multiplier + offset;
}

vec4 applySettings(vec4 colour, float gamma, float multiplier, float offset) {
  return vec4(applySettings(colour.x, gamma, multiplier, offset), applySettings(colour.y, gamma, multiplier, offset),
              applySettings(colour.z, gamma, multiplier, offset), colour.w);
}

vec4 chromaKey(vec4 colour, vec3 key, float tolerance) {
  return distance(rgbOf(colour), key) <= tolerance ? vec4(0.0f) : colour;
}

vec3 hsvFromRgb(vec3 rgb) {
  float value = max(max(rgb.x, rgb.y), rgb.z);
  float chroma = value - min(min(rgb.x, rgb.y), rgb.z);
  if (chroma <= 0.0f) {
    return vec3(0.0f, 0.0f, value);
  }
  float sixths = (rgb.x - rgb.y) / chroma + 4.0f;
  if (value == rgb.x) {
    sixths = (rgb.y - rgb.z) / chroma + (rgb.y < rgb.z ? 6.0f : 0.0f);
  } else if (value == rgb.y) {
    sixths = (rgb.z - rgb.x) / chroma + 2.0f;
  }
  return vec3(sixths / 6.0f, value > 0.0f ? chroma / value : 0.0f, value);
}

vec3 rgbFromHsv(vec3 hsv) {
  vec3 turn = fract(vec3(hsv.x) + vec3(0.0f, 2.0f / 3.0f, 1.0f / 3.0f));
  vec3 distances = abs(turn * 6.0f - vec3(3.0f)) - vec3(1.0f);
  return hsv.z * (vec3(1.0f) - hsv.y * (vec3(1.0f) - clamp(distances, vec3(0.0f), vec3(1.0f))));
}

vec4 over(vec4 below, vec3 rgb, float alpha) {
  float sum = below.w + alpha * (1.0f - below.w);
  return sum <= 0.0f ? vec4(0.0f) : vec4(mix(rgbOf(below) * below.w, rgb, alpha) / sum, sum);
}

vec3 blendOpaque(int mode, vec3 below, vec3 layer) {
  if (mode == blendModeMultiply || mode == blendModeMultiplyMix) {
    return below * layer;
  }
  if (mode == blendModeAdd) {
    return below + layer;
  }
  if (mode == blendModeSubtract) {
    return below - layer;
  }
  if (mode == blendModeColor) {
    vec3 hsv = hsvFromRgb(below);
    return rgbFromHsv(vec3(hsv.x, hsv.y, (layer.x + layer.y + layer.z) / 3.0f));
  }
  return layer;
}

vec4 blend(int mode, vec4 below, vec4 layer) {
  vec3 opaque = blendOpaque(mode, rgbOf(below), rgbOf(layer));
  if (mode == blendModeMultiplyMix) {
    return over(below, opaque, below.w * layer.w);
  }
  return over(below, mix(rgbOf(layer), opaque, below.w), layer.w);
}
