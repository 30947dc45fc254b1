#include "host/graphics/limits.h"

#include <algorithm>

#include <epoxy/gl.h>

namespace meridian::graphics {

namespace {

std::string text(GLenum name) {
  const auto* value = reinterpret_cast<const char*>(glGetString(name));
  return value != nullptr ? value : "";
}

int integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

std::int64_t longInteger(GLenum name) {
  GLint64 value = 0;
  glGetInteger64v(name, &value);
  return value;
}

}  // namespace

Limits readLimits() {
  Limits limits;
  limits.vendor = text(GL_VENDOR);
  limits.renderer = text(GL_RENDERER);
  limits.version = text(GL_VERSION);
  for (const char* name : {"llvmpipe", "softpipe", "SWR"}) {
    limits.software = limits.software || limits.renderer.find(name) != std::string::npos;
  }
  limits.textureSize = integer(GL_MAX_TEXTURE_SIZE);
  limits.textureLayers = integer(GL_MAX_ARRAY_TEXTURE_LAYERS);
  limits.fragmentTextureUnits = integer(GL_MAX_TEXTURE_IMAGE_UNITS);
  limits.vertexTextureUnits = integer(GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS);
  limits.combinedTextureUnits = integer(GL_MAX_COMBINED_TEXTURE_IMAGE_UNITS);
  limits.samples = std::min(integer(GL_MAX_COLOR_TEXTURE_SAMPLES), integer(GL_MAX_DEPTH_TEXTURE_SAMPLES));
  limits.uniformBlockBytes = longInteger(GL_MAX_UNIFORM_BLOCK_SIZE);
  limits.uniformBlockAlignment = integer(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT);
  limits.storageBlockBytes = longInteger(GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
  limits.storageBlockAlignment = integer(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT);
  if (epoxy_has_gl_extension("GL_ARB_texture_filter_anisotropic") ||
      epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic")) {
    glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY, &limits.anisotropy);
  }
  return limits;
}

}  // namespace meridian::graphics
