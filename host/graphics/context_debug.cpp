#include "host/graphics/context_debug.h"

#include <string_view>

#include <epoxy/gl.h>

#include "host/api/log.h"

namespace meridian::graphics {

namespace {

void APIENTRY logMessage(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length, const GLchar* message,
                         const void* /*user*/) {
  const std::string_view text =
      length >= 0 ? std::string_view(message, static_cast<std::size_t>(length)) : std::string_view(message);
  // Mesa reports every variant it compiles, and compilers' errors reach people as an Error already.
  const bool chatter =
      source == GL_DEBUG_SOURCE_SHADER_COMPILER || type == GL_DEBUG_TYPE_PERFORMANCE || type == GL_DEBUG_TYPE_OTHER;
  if (!chatter && (type == GL_DEBUG_TYPE_ERROR || severity == GL_DEBUG_SEVERITY_HIGH)) {
    log::error("OpenGL {}: {}", id, text);
  } else if (!chatter && severity == GL_DEBUG_SEVERITY_MEDIUM) {
    log::warning("OpenGL {}: {}", id, text);
  } else {
    log::debug("OpenGL {}: {}", id, text);
  }
}

}  // namespace

void logDebugMessages() {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);  // so that a breakpoint in the callback shows who called
  glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DEBUG_SEVERITY_NOTIFICATION, 0, nullptr, GL_FALSE);
  glDebugMessageCallback(logMessage, nullptr);
}

}  // namespace meridian::graphics
