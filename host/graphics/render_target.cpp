#include "host/graphics/render_target.h"

#include <algorithm>
#include <array>
#include <cassert>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/gtc/type_ptr.hpp>

namespace meridian::graphics {

namespace {

bool ranOutOfMemory() {
  bool found = false;
  for (GLenum error = glGetError(); error != GL_NO_ERROR; error = glGetError()) {
    found = found || error == GL_OUT_OF_MEMORY;
  }
  return found;
}

int integer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

Texture attachment(GLenum format, const RenderTarget::Shape& shape, int samples) {
  return samples > 1 ? Texture::multisample2D(format, shape.size.x, shape.size.y, samples)
                     : Texture::image2D(format, shape.size.x, shape.size.y);
}

}  // namespace

Result<RenderTarget> RenderTarget::create(const Shape& shape) {
  RenderTarget target;
  target.shape_ = shape;
  target.shape_.size = glm::max(shape.size, glm::ivec2(1));
  const glm::ivec2 size = target.shape_.size;
  if (const int limit = integer(GL_MAX_TEXTURE_SIZE); std::max(size.x, size.y) > limit) {
    return failure(fmt::format("a picture of {} x {} pixels is more than the driver's {}", size.x, size.y, limit),
                   "OpenGL", "ask for a smaller picture");
  }
  const int limit = std::min(integer(GL_MAX_COLOR_TEXTURE_SAMPLES), integer(GL_MAX_DEPTH_TEXTURE_SAMPLES));
  const int samples = std::clamp(shape.samples, 1, std::max(limit, 1));

  ranOutOfMemory();
  target.colour_ = attachment(GL_RGBA8, target.shape_, samples);
  target.depth_ = attachment(GL_DEPTH_COMPONENT32F, target.shape_, samples);
  target.framebuffer_ = Framebuffer::create();
  target.framebuffer_.attach(GL_COLOR_ATTACHMENT0, target.colour_);
  target.framebuffer_.attach(GL_DEPTH_ATTACHMENT, target.depth_);
  if (samples > 1) {
    GLint given = 1;
    glGetTextureLevelParameteriv(target.colour_.id(), 0, GL_TEXTURE_SAMPLES, &given);
    target.samples_ = std::max(given, 1);
    target.resolvedColour_ = Texture::image2D(GL_RGBA8, size.x, size.y);
    target.resolvedFramebuffer_ = Framebuffer::create();
    target.resolvedFramebuffer_.attach(GL_COLOR_ATTACHMENT0, target.resolvedColour_);
  }
  if (ranOutOfMemory()) {
    return failure(fmt::format("no memory for a picture of {} x {} pixels with {} samples", size.x, size.y, samples),
                   "OpenGL", "ask for a smaller picture or fewer samples");
  }
  if (auto complete = target.framebuffer_.check("frames"); !complete) {
    return tl::make_unexpected(std::move(complete.error()));
  }
  return target;
}

Result<void> RenderTarget::reshape(const Shape& shape) {
  if (glm::max(shape.size, glm::ivec2(1)) == shape_.size && shape.samples == shape_.samples) {
    return {};
  }
  auto made = create(shape);
  if (!made) {
    return tl::make_unexpected(std::move(made.error()));
  }
  *this = std::move(*made);
  return {};
}

void RenderTarget::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, shape_.size.x, shape_.size.y);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glDepthFunc(GL_GREATER);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
}

void RenderTarget::clear(const glm::vec4& colour) const {
  const GLfloat infinitelyFar = 0.0F;
  glClearNamedFramebufferfv(framebuffer_.id(), GL_COLOR, 0, glm::value_ptr(colour));
  glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &infinitelyFar);
}

GLuint RenderTarget::resolved() const {
  if (!resolvedFramebuffer_) {
    return framebuffer_.id();
  }
  glBlitNamedFramebuffer(framebuffer_.id(), resolvedFramebuffer_.id(), 0, 0, shape_.size.x, shape_.size.y, 0, 0,
                         shape_.size.x, shape_.size.y, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  return resolvedFramebuffer_.id();
}

void RenderTarget::blit(GLuint framebuffer, glm::ivec2 framebufferSize) const {
  if (framebufferSize.x < 1 || framebufferSize.y < 1) {
    return;  // a minimised window
  }
  const bool same = framebufferSize == shape_.size;
  // Samples are resolved on the way only where sizes agree.
  const GLuint source = same ? framebuffer_.id() : resolved();
  glBlitNamedFramebuffer(source, framebuffer, 0, 0, shape_.size.x, shape_.size.y, 0, 0, framebufferSize.x,
                         framebufferSize.y, GL_COLOR_BUFFER_BIT, same ? GL_NEAREST : GL_LINEAR);
}

void RenderTarget::readPixels(std::span<std::uint8_t> pixels) const {
  const auto stride = static_cast<std::size_t>(shape_.size.x) * 4;
  const auto rows = static_cast<std::size_t>(shape_.size.y);
  assert(pixels.size() == stride * rows);
  const GLuint source = resolved();
  const int before = integer(GL_READ_FRAMEBUFFER_BINDING);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, source);
  glReadPixels(0, 0, shape_.size.x, shape_.size.y, GL_RGBA, GL_UNSIGNED_BYTE, pixels.data());
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(before));
  for (std::size_t top = 0, bottom = rows - 1; top < bottom; ++top, --bottom) {
    std::swap_ranges(pixels.begin() + static_cast<std::ptrdiff_t>(top * stride),
                     pixels.begin() + static_cast<std::ptrdiff_t>((top + 1) * stride),
                     pixels.begin() + static_cast<std::ptrdiff_t>(bottom * stride));
  }
}

std::vector<std::uint8_t> RenderTarget::readPixels() const {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(shape_.size.x) * static_cast<std::size_t>(shape_.size.y) *
                                   4);
  readPixels(pixels);
  return pixels;
}

}  // namespace meridian::graphics
