#include "host/graphics/gl_objects.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace meridian::graphics {

namespace {

GLuint newTexture(GLenum target) {
  GLuint id = 0;
  glCreateTextures(target, 1, &id);
  return id;
}

void setPlainSampling(GLuint texture) {
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(texture, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

std::string_view statusName(GLenum status) {
  using Entry = std::pair<GLenum, std::string_view>;
  static constexpr std::array<Entry, 7> names{
      {{GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT, "an attachment cannot be drawn to"},
       {GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT, "it has no attachment"},
       {GL_FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER, "a draw buffer has no attachment"},
       {GL_FRAMEBUFFER_INCOMPLETE_READ_BUFFER, "the read buffer has no attachment"},
       {GL_FRAMEBUFFER_UNSUPPORTED, "the driver does not support these formats together"},
       {GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE, "its attachments differ in samples"},
       {GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS, "its attachments differ in layers"}}};
  for (const auto& [value, name] : names) {
    if (value == status) {
      return name;
    }
  }
  return "the driver gives no reason";
}

}  // namespace

Buffer::Buffer(GLsizeiptr bytes, const void* data, GLbitfield flags) {
  GLuint made = 0;
  glCreateBuffers(1, &made);
  glNamedBufferStorage(made, bytes, data, flags);
  static_cast<Object&>(*this) = Object(made);
}

void Buffer::write(GLintptr offset, GLsizeiptr bytes, const void* data) const {
  glNamedBufferSubData(id(), offset, bytes, data);
}

Texture Texture::image2D(GLenum format, int width, int height, int levels) {
  Texture texture(newTexture(GL_TEXTURE_2D));
  glTextureStorage2D(texture.id(), levels, format, width, height);
  setPlainSampling(texture.id());
  return texture;
}

Texture Texture::array2D(GLenum format, int width, int height, int layers, int levels) {
  Texture texture(newTexture(GL_TEXTURE_2D_ARRAY));
  glTextureStorage3D(texture.id(), levels, format, width, height, layers);
  setPlainSampling(texture.id());
  return texture;
}

Texture Texture::view(const Texture& of, GLenum target, GLenum format, int firstLevel, int levels) {
  GLint layers = 1;
  glGetTextureParameteriv(of.id(), GL_TEXTURE_VIEW_NUM_LAYERS, &layers);
  // A view needs a name without a shape, which glCreateTextures would give it.
  GLuint id = 0;
  glGenTextures(1, &id);
  Texture texture(id);
  glTextureView(id, target, of.id(), format, static_cast<GLuint>(firstLevel), static_cast<GLuint>(levels), 0,
                static_cast<GLuint>(layers));
  setPlainSampling(id);
  return texture;
}

Texture Texture::multisample2D(GLenum format, int width, int height, int samples) {
  Texture texture(newTexture(GL_TEXTURE_2D_MULTISAMPLE));
  glTextureStorage2DMultisample(texture.id(), samples, format, width, height, GL_TRUE);
  return texture;
}

VertexArray VertexArray::create() {
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  return VertexArray(id);
}

Framebuffer Framebuffer::create() {
  GLuint id = 0;
  glCreateFramebuffers(1, &id);
  return Framebuffer(id);
}

void Framebuffer::attach(GLenum attachment, const Texture& texture, int level) const {
  glNamedFramebufferTexture(id(), attachment, texture.id(), level);
}

void Framebuffer::attachLayer(GLenum attachment, const Texture& texture, int layer, int level) const {
  glNamedFramebufferTextureLayer(id(), attachment, texture.id(), level, layer);
}

Result<void> Framebuffer::check(std::string_view purpose) const {
  const GLenum status = glCheckNamedFramebufferStatus(id(), GL_FRAMEBUFFER);
  if (status == GL_FRAMEBUFFER_COMPLETE) {
    return {};
  }
  return failure(fmt::format("the framebuffer for {} is incomplete: {}", purpose, statusName(status)), "OpenGL");
}

Sampler Sampler::create(GLenum minify, GLenum magnify, GLenum wrap) {
  GLuint id = 0;
  glCreateSamplers(1, &id);
  glSamplerParameteri(id, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minify));
  glSamplerParameteri(id, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magnify));
  glSamplerParameteri(id, GL_TEXTURE_WRAP_S, static_cast<GLint>(wrap));
  glSamplerParameteri(id, GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap));
  return Sampler(id);
}

Query Query::create(GLenum target) {
  GLuint id = 0;
  glCreateQueries(target, 1, &id);
  return Query(id);
}

std::optional<std::uint64_t> Query::result() const {
  GLint available = GL_FALSE;
  glGetQueryObjectiv(id(), GL_QUERY_RESULT_AVAILABLE, &available);
  if (available == GL_FALSE) {
    return std::nullopt;
  }
  GLuint64 value = 0;
  glGetQueryObjectui64v(id(), GL_QUERY_RESULT, &value);
  return value;
}

Fence Fence::insert() {
  return Fence(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0));
}

Fence& Fence::operator=(Fence&& other) noexcept {
  if (this != &other) {
    reset();
    sync_ = std::exchange(other.sync_, nullptr);
  }
  return *this;
}

bool Fence::passed() const {
  return wait(std::chrono::nanoseconds(0));
}

bool Fence::wait(std::chrono::nanoseconds limit) const {
  if (sync_ == nullptr) {
    return true;
  }
  const GLenum status =
      glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, static_cast<GLuint64>(std::max<long>(limit.count(), 0)));
  return status == GL_ALREADY_SIGNALED || status == GL_CONDITION_SATISFIED;
}

void Fence::reset() {
  if (sync_ != nullptr) {
    glDeleteSync(std::exchange(sync_, nullptr));
  }
}

}  // namespace meridian::graphics
