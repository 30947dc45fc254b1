#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include <epoxy/gl.h>

#include "host/api/error.h"

namespace meridian::graphics {

/// Owns one OpenGL name and deletes it; move-only, empty when default-constructed. Must die while a context of its
/// share group is current, vertex arrays, framebuffers and queries while their own context is: those are not shared.
template <void (*Delete)(GLuint)>
class Object {
 public:
  Object() = default;
  explicit Object(GLuint id) : id_(id) {}
  Object(Object&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    if (this != &other) {
      reset();
      id_ = std::exchange(other.id_, 0);
    }
    return *this;
  }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  ~Object() { reset(); }

  [[nodiscard]] GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }
  void reset() {
    if (id_ != 0) {
      Delete(std::exchange(id_, 0));
    }
  }

 private:
  GLuint id_ = 0;
};

namespace detail {
inline void deleteBuffer(GLuint id) {
  glDeleteBuffers(1, &id);
}
inline void deleteTexture(GLuint id) {
  glDeleteTextures(1, &id);
}
inline void deleteVertexArray(GLuint id) {
  glDeleteVertexArrays(1, &id);
}
inline void deleteFramebuffer(GLuint id) {
  glDeleteFramebuffers(1, &id);
}
inline void deleteSampler(GLuint id) {
  glDeleteSamplers(1, &id);
}
inline void deleteQuery(GLuint id) {
  glDeleteQueries(1, &id);
}
}  // namespace detail

/// A buffer of fixed size (glNamedBufferStorage).
class Buffer : public Object<detail::deleteBuffer> {
 public:
  Buffer() = default;
  /// `data` may be null; `flags` as for glNamedBufferStorage, 0 for contents that never change.
  Buffer(GLsizeiptr bytes, const void* data, GLbitfield flags);
  /// Replaces bytes; the buffer needs GL_DYNAMIC_STORAGE_BIT.
  void write(GLintptr offset, GLsizeiptr bytes, const void* data) const;
};

/// A texture of fixed shape. Filters and wrapping come from samplers or glTextureParameter; a fresh texture is
/// clamped to its edge and filtered GL_LINEAR without levels, so that it is complete.
class Texture : public Object<detail::deleteTexture> {
 public:
  Texture() = default;
  [[nodiscard]] static Texture image2D(GLenum format, int width, int height, int levels = 1);
  [[nodiscard]] static Texture array2D(GLenum format, int width, int height, int layers, int levels = 1);
  /// Some levels, with all their layers, of a texture, which stays alive in the driver as long as its views do.
  [[nodiscard]] static Texture view(const Texture& of, GLenum target, GLenum format, int firstLevel, int levels);
  [[nodiscard]] static Texture multisample2D(GLenum format, int width, int height, int samples);

 private:
  explicit Texture(GLuint id) : Object(id) {}
};

class VertexArray : public Object<detail::deleteVertexArray> {
 public:
  VertexArray() = default;
  [[nodiscard]] static VertexArray create();

 private:
  explicit VertexArray(GLuint id) : Object(id) {}
};

class Framebuffer : public Object<detail::deleteFramebuffer> {
 public:
  Framebuffer() = default;
  [[nodiscard]] static Framebuffer create();
  void attach(GLenum attachment, const Texture& texture, int level = 0) const;
  void attachLayer(GLenum attachment, const Texture& texture, int layer, int level = 0) const;
  /// An error that names `purpose` and the reason when it cannot be drawn to.
  [[nodiscard]] Result<void> check(std::string_view purpose) const;

 private:
  explicit Framebuffer(GLuint id) : Object(id) {}
};

class Sampler : public Object<detail::deleteSampler> {
 public:
  Sampler() = default;
  [[nodiscard]] static Sampler create(GLenum minify, GLenum magnify, GLenum wrap = GL_CLAMP_TO_EDGE);

 private:
  explicit Sampler(GLuint id) : Object(id) {}
};

class Query : public Object<detail::deleteQuery> {
 public:
  Query() = default;
  [[nodiscard]] static Query create(GLenum target);
  /// Nothing while the result is not there; never waits.
  [[nodiscard]] std::optional<std::uint64_t> result() const;

 private:
  explicit Query(GLuint id) : Object(id) {}
};

/// A point in the stream of commands that can be asked whether it has been passed.
class Fence {
 public:
  Fence() = default;
  /// After all commands given so far on this context.
  [[nodiscard]] static Fence insert();
  Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
  Fence& operator=(Fence&& other) noexcept;
  Fence(const Fence&) = delete;
  Fence& operator=(const Fence&) = delete;
  ~Fence() { reset(); }

  explicit operator bool() const { return sync_ != nullptr; }
  /// True for an empty fence. Flushes, so that a loop of asking ends.
  [[nodiscard]] bool passed() const;
  /// Waits at most that long; whether it was passed.
  bool wait(std::chrono::nanoseconds limit) const;
  void reset();

 private:
  explicit Fence(GLsync sync) : sync_(sync) {}
  GLsync sync_ = nullptr;
};

}  // namespace meridian::graphics
