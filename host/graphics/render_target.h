#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "host/api/error.h"
#include "host/graphics/gl_objects.h"

namespace meridian::graphics {

/// What frames are drawn into: RGBA8 colour and DEPTH_COMPONENT32F depth, reversed (docs/architecture.md, Depth).
/// Neither GLFW nor surfaceless EGL gives a float depth buffer.
class RenderTarget {
 public:
  struct Shape {
    glm::ivec2 size{1};  ///< pixels; less than 1 counts as 1, more than the driver's limit is an error
    int samples = 1;     ///< 1: no antialiasing; else 2, 4 ..., rounded to what the driver has
  };

  [[nodiscard]] static Result<RenderTarget> create(const Shape& shape);

  /// Does nothing when the shape is the same already. On an error it keeps what it was.
  [[nodiscard]] Result<void> reshape(const Shape& shape);
  [[nodiscard]] glm::ivec2 size() const { return shape_.size; }
  /// What the driver gave.
  [[nodiscard]] int samples() const { return samples_; }

  /// Binds it for drawing, with its viewport, and sets the clip control and depth state of applyDefaultState.
  void bind() const;
  /// Colour to `colour`, depth to 0 (infinitely far). Heeds colour and depth masks and the scissor, as OpenGL does.
  void clear(const glm::vec4& colour) const;

  /// Copies the colours to a framebuffer (0: the window) of that size, resolving samples; scales when sizes differ.
  void blit(GLuint framebuffer, glm::ivec2 framebufferSize) const;
  /// The framebuffer to draw into.
  [[nodiscard]] GLuint framebuffer() const { return framebuffer_.id(); }

  /// RGBA, 8 bits each, rows from top to bottom. Waits for drawing to end. `pixels` holds 4 * width * height bytes.
  void readPixels(std::span<std::uint8_t> pixels) const;
  [[nodiscard]] std::vector<std::uint8_t> readPixels() const;

 private:
  RenderTarget() = default;
  /// A framebuffer with one sample a pixel that holds the colours.
  [[nodiscard]] GLuint resolved() const;

  Shape shape_;
  int samples_ = 1;
  Texture colour_;
  Texture depth_;
  Framebuffer framebuffer_;
  Texture resolvedColour_;  ///< empty without antialiasing; likewise the next
  Framebuffer resolvedFramebuffer_;
};

}  // namespace meridian::graphics
