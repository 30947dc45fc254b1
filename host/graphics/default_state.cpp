#include "host/graphics/default_state.h"

#include <array>
#include <string_view>

#include <epoxy/gl.h>
#include <fmt/format.h>

namespace meridian::graphics {

namespace {

struct Capability {
  GLenum name;
  bool on;
  std::string_view words;
};

constexpr std::array<Capability, 11> capabilities{{{GL_DEPTH_TEST, true, "depth test"},
                                                   {GL_DEPTH_CLAMP, false, "depth clamp"},
                                                   {GL_BLEND, false, "blending"},
                                                   {GL_CULL_FACE, false, "face culling"},
                                                   {GL_POLYGON_OFFSET_FILL, false, "polygon offset"},
                                                   {GL_SCISSOR_TEST, false, "scissor test"},
                                                   {GL_STENCIL_TEST, false, "stencil test"},
                                                   {GL_FRAMEBUFFER_SRGB, false, "sRGB writes"},
                                                   {GL_PRIMITIVE_RESTART, false, "primitive restart"},
                                                   {GL_RASTERIZER_DISCARD, false, "rasterizer discard"},
                                                   {GL_MULTISAMPLE, true, "multisampling"}}};

struct Setting {
  GLenum name;
  GLint value;
  std::string_view words;
};

constexpr std::array<Setting, 19> settings{{{GL_CLIP_ORIGIN, GL_LOWER_LEFT, "clip origin"},
                                            {GL_CLIP_DEPTH_MODE, GL_ZERO_TO_ONE, "clip depth mode"},
                                            {GL_DEPTH_FUNC, GL_GREATER, "depth function"},
                                            {GL_DEPTH_WRITEMASK, GL_TRUE, "depth writes"},
                                            {GL_BLEND_SRC_RGB, GL_ONE, "blend source"},
                                            {GL_BLEND_SRC_ALPHA, GL_ONE, "blend source of alpha"},
                                            {GL_BLEND_DST_RGB, GL_ZERO, "blend destination"},
                                            {GL_BLEND_DST_ALPHA, GL_ZERO, "blend destination of alpha"},
                                            {GL_BLEND_EQUATION_RGB, GL_FUNC_ADD, "blend equation"},
                                            {GL_BLEND_EQUATION_ALPHA, GL_FUNC_ADD, "blend equation of alpha"},
                                            {GL_FRONT_FACE, GL_CCW, "front face"},
                                            {GL_CURRENT_PROGRAM, 0, "program"},
                                            {GL_VERTEX_ARRAY_BINDING, 0, "vertex array"},
                                            {GL_ACTIVE_TEXTURE, GL_TEXTURE0, "active texture unit"},
                                            {GL_PACK_ALIGNMENT, 1, "pack alignment"},
                                            {GL_UNPACK_ALIGNMENT, 1, "unpack alignment"},
                                            {GL_PIXEL_PACK_BUFFER_BINDING, 0, "pixel pack buffer"},
                                            {GL_PIXEL_UNPACK_BUFFER_BINDING, 0, "pixel unpack buffer"},
                                            {GL_UNPACK_ROW_LENGTH, 0, "unpack row length"}}};

}  // namespace

void applyDefaultState() {
  for (const Capability& capability : capabilities) {
    if (capability.on) {
      glEnable(capability.name);
    } else {
      glDisable(capability.name);
    }
  }
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glClearDepth(0.0);
  glBlendFunc(GL_ONE, GL_ZERO);
  glBlendEquation(GL_FUNC_ADD);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glFrontFace(GL_CCW);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glUseProgram(0);
  glBindVertexArray(0);
  glActiveTexture(GL_TEXTURE0);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

std::string deviationsFromDefaultState() {
  std::string found;
  const auto add = [&found](std::string text) { found += (found.empty() ? "" : ", ") + std::move(text); };
  for (const Capability& capability : capabilities) {
    if ((glIsEnabled(capability.name) == GL_TRUE) != capability.on) {
      add(fmt::format("{} is {}", capability.words, capability.on ? "off" : "on"));
    }
  }
  for (const Setting& setting : settings) {
    GLint value = 0;
    glGetIntegerv(setting.name, &value);
    if (value != setting.value) {
      add(fmt::format("{} is 0x{:x}, not 0x{:x}", setting.words, value, setting.value));
    }
  }
  std::array<GLboolean, 4> mask{};
  glGetBooleanv(GL_COLOR_WRITEMASK, mask.data());
  if (mask != std::array<GLboolean, 4>{GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE}) {
    add("a colour channel is not written");
  }
  std::array<GLint, 2> mode{};
  glGetIntegerv(GL_POLYGON_MODE, mode.data());
  if (mode[0] != GL_FILL) {
    add("polygons are not filled");
  }
  GLdouble clearDepth = 0.0;
  glGetDoublev(GL_DEPTH_CLEAR_VALUE, &clearDepth);
  if (clearDepth != 0.0) {
    add(fmt::format("clear depth is {}", clearDepth));
  }
  return found;
}

}  // namespace meridian::graphics
