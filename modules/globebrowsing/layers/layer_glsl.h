#pragma once

#include <string>
#include <string_view>

#include "globebrowsing/layers/layer_fields.h"

namespace meridian::globebrowsing {

// GLSL text made from the C++ description of a layer; no OpenGL is needed to make it. What the functions of
// shaders/layers/ expect before them: glslLayerConstants() for blend.glsl, and glslStruct(layerFields(), "Layer") for
// compose_layer.glsl.

/// "struct NAME { ... };"
[[nodiscard]] std::string glslStruct(const LayerFields& fields, std::string_view name);

/// A uniform block in std140 that is one array of layers: layer i begins at i * fields.stride().
struct GlslLayerBlock {
  std::string_view structName;  ///< as given to glslStruct
  std::string_view name;
  std::string_view arrayName;
  int binding = 0;
  int count = 1;  ///< at least 1
};
[[nodiscard]] std::string glslLayerBlock(const GlslLayerBlock& block);

/// "const int blendModeNormal = 0;" ... for every blend mode, adjustment (adjustmentChromaKey) and sampling
/// (samplingSolidColor): what the fields blendMode, adjustment and sampling hold.
[[nodiscard]] std::string glslLayerConstants();

}  // namespace meridian::globebrowsing
