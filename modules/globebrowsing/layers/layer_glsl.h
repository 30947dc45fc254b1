#pragma once

#include <string>
#include <string_view>

#include "globebrowsing/layers/layer_fields.h"

namespace meridian::globebrowsing {

/// GLSL text made from the C++ description of a layer; no OpenGL is needed to make it.

/// "struct NAME { ... };"
[[nodiscard]] std::string glslStruct(const LayerFields& fields, std::string_view name);

/// A uniform block in std140 with `count` (at least 1) of those structs: its members are at i * fields.stride().
[[nodiscard]] std::string glslLayerBlock(const LayerFields& fields, std::string_view structName,
                                         std::string_view blockName, std::string_view arrayName, int binding,
                                         int count);

/// "const int blendNormal = 0;" ... for every blend mode, adjustment (adjustmentChromaKey) and sampling
/// (samplingSolidColor): what the fields blendMode, adjustment and sampling hold.
[[nodiscard]] std::string glslLayerConstants();

}  // namespace meridian::globebrowsing
