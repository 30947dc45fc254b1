#pragma once

#include <string>

namespace meridian::graphics {

/// Sets the state that every draw finds and must leave behind:
///   clip control lower left, zero to one; depth test on, GL_GREATER, depth writes on; no depth clamp
///   blending off (function GL_ONE, GL_ZERO, equation GL_FUNC_ADD); all colour channels written
///   face culling off, front faces counter-clockwise; polygons filled, no offset
///   scissor, stencil, sRGB writes, primitive restart off; multisampling on; clear depth 0
///   no program, no vertex array; active texture unit 0; pixels packed and unpacked with alignment 1, no pixel buffers
/// Bound textures, samplers and indexed buffers are nobody's: bind what you use. Framebuffer and viewport are the
/// frame's: whoever changes them puts them back.
void applyDefaultState();

/// In words, what differs from that state; empty when nothing does. Asks the driver: for tests and debugging.
[[nodiscard]] std::string deviationsFromDefaultState();

}  // namespace meridian::graphics
