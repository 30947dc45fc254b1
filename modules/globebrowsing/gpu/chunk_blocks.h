#pragma once

#include <array>
#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace meridian::globebrowsing {

/// What shaders/surface/blocks.glsl declares, field by field, in std140.

/// One view of one globe; binding 0.
struct ViewBlock {
  glm::mat4 clipFromRelative{1.0F};  ///< from model axes with their origin at the eye
  glm::vec3 lightDirection{1.0F, 0.0F, 0.0F};
  float ambient = 0.0F;
  float opacity = 1.0F;
  float waterReflectance = 1.0F;
  std::array<float, 2> padding{};
};
static_assert(sizeof(ViewBlock) == 96);

/// One chunk in one view.
struct ChunkParameters {
  std::array<glm::vec4, 4> corners{};     ///< north-west, north-east, south-west, south-east, relative to the eye
  std::array<glm::vec4, 3> composites{};  ///< base, night, overlay: texture coordinate = xy + zw * unit square
  glm::vec4 normals{0.0F};                ///< of the normals' image: texture coordinate = xy + zw * unit square
  glm::vec4 layers{-1.0F};  ///< array layers of base, night and overlay composite and of the normals; below 0: none
  float skirt = 0.0F;
  float level = 0.0F;
  float normalScale = 0.0F;  ///< normal offset = (texel * 255 - 128) / 127 * this
  float flare = 0.0F;        ///< metres: how far a skirt's foot stands out
  float lift = 0.0F;         ///< metres: by how much all vertices are raised
  float otherLayer = 0.0F;   ///< array layer of the composite that the fading one is mixed with
  float otherWeight = 0.0F;  ///< how much of it, 0 to 1
  float padding = 0.0F;
};
static_assert(sizeof(ChunkParameters) == 176);

/// Those of one draw call; binding 1.
struct ChunkBlock {
  static constexpr std::size_t most = 64;
  std::array<ChunkParameters, most> chunks{};
};

}  // namespace meridian::globebrowsing
