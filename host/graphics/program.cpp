#include "host/graphics/program.h"

#include <algorithm>

#include <fmt/format.h>

#include "host/api/log.h"

namespace meridian::graphics {

namespace {

struct ShaderDeleter {
  GLuint id = 0;
  ~ShaderDeleter() { glDeleteShader(id); }
};

/// The first message of a log, without line end.
std::string firstMessage(const std::string& log) {
  return log.empty() ? "the compiler gives no reason" : log.substr(0, log.find('\n'));
}

Result<void> compileShader(GLuint shader, const ShaderSource& source, std::string_view stage) {
  const char* text = source.text.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) {
    return {};
  }
  GLint length = 0;
  glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
  std::string raw(static_cast<std::size_t>(std::max(length, 1)), '\0');
  glGetShaderInfoLog(shader, length, &length, raw.data());
  raw.resize(static_cast<std::size_t>(length));
  const std::string readable = source.readableLog(raw);
  log::debug("compiler's log:\n{}", readable);
  std::string where = source.firstPlace(raw);
  std::string message = firstMessage(readable);
  if (message.starts_with(where + ": ")) {
    message.erase(0, where.size() + 2);
  }
  return failure(fmt::format("the {} shader does not compile: {}", stage, message), std::move(where));
}

Result<void> linkProgram(GLuint program, const ProgramDescription& description) {
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) {
    return {};
  }
  GLint length = 0;
  glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
  std::string raw(static_cast<std::size_t>(std::max(length, 1)), '\0');
  glGetProgramInfoLog(program, length, &length, raw.data());
  raw.resize(static_cast<std::size_t>(length));
  return failure(fmt::format("the program does not link: {}", firstMessage(raw)),
                 fmt::format("{} with {}", description.vertex.firstPlace({}), description.fragment.firstPlace({})));
}

}  // namespace

Result<GLuint> compileProgram(const ProgramDescription& description) {
  const ShaderDeleter vertex{glCreateShader(GL_VERTEX_SHADER)};
  const ShaderDeleter fragment{glCreateShader(GL_FRAGMENT_SHADER)};
  if (auto done = compileShader(vertex.id, description.vertex, "vertex"); !done) {
    return tl::make_unexpected(std::move(done.error()));
  }
  if (auto done = compileShader(fragment.id, description.fragment, "fragment"); !done) {
    return tl::make_unexpected(std::move(done.error()));
  }
  const GLuint program = glCreateProgram();
  glAttachShader(program, vertex.id);
  glAttachShader(program, fragment.id);
  auto linked = linkProgram(program, description);
  glDetachShader(program, vertex.id);
  glDetachShader(program, fragment.id);
  if (!linked) {
    glDeleteProgram(program);
    return tl::make_unexpected(std::move(linked.error()));
  }
  return program;
}

}  // namespace meridian::graphics
