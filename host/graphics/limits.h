#pragma once

#include <cstdint>
#include <string>

namespace meridian::graphics {

/// What the driver offers.
struct Limits {
  std::string vendor;
  std::string renderer;
  std::string version;
  bool software = false;  ///< drawn by the CPU (llvmpipe, softpipe, SWR)
  int textureSize = 0;    ///< texels along a side
  int textureLayers = 0;  ///< of an array texture
  int fragmentTextureUnits = 0;
  int vertexTextureUnits = 0;
  int combinedTextureUnits = 0;
  int samples = 1;  ///< a pixel, of a RenderTarget
  std::int64_t uniformBlockBytes = 0;
  int uniformBlockAlignment = 0;
  std::int64_t storageBlockBytes = 0;
  int storageBlockAlignment = 0;
  float anisotropy = 1.0F;  ///< 1: none
};

/// Of the current context.
[[nodiscard]] Limits readLimits();

}  // namespace meridian::graphics
