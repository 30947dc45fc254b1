#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include "host/api/log.h"
#include "host/graphics/context.h"
#include "host/graphics/context_debug.h"

namespace meridian::graphics {

namespace {

// GLFW is initialised while any window lives. Windows are made and destroyed on the main thread only.
int openWindows = 0;

std::string lastGlfwError() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "no reason given";
}

void releaseGlfw() {
  if (--openWindows == 0) {
    glfwTerminate();
  }
}

void setHints(const WindowOptions& options, int major, int minor) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CLIENT_API, GLFW_OPENGL_API);
  glfwWindowHint(GLFW_CONTEXT_CREATION_API, options.egl ? GLFW_EGL_CONTEXT_API : GLFW_NATIVE_CONTEXT_API);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, major);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, minor);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, options.context.debug ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_VISIBLE, options.visible ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_RESIZABLE, GLFW_TRUE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
}

/// What the display can do instead of 4.5, in words.
std::string versionFound(const WindowOptions& options) {
  setHints(options, 3, 2);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  GLFWwindow* probe = glfwCreateWindow(16, 16, "", nullptr, nullptr);
  if (probe == nullptr) {
    return "not even OpenGL 3.2 core";
  }
  glfwMakeContextCurrent(probe);
  std::string found = fmt::format("{} ({})", reinterpret_cast<const char*>(glGetString(GL_VERSION)),
                                  reinterpret_cast<const char*>(glGetString(GL_RENDERER)));
  glfwMakeContextCurrent(nullptr);
  glfwDestroyWindow(probe);
  return found;
}

}  // namespace

WindowContext::WindowContext(GLFWwindow* window, WindowOptions options)
    : window_(window), options_(std::move(options)) {}

Result<std::unique_ptr<WindowContext>> WindowContext::create(const WindowOptions& options) {
  if (glfwInit() == GLFW_FALSE) {
    return failure(fmt::format("no window can be opened ({})", lastGlfwError()), "GLFW",
                   "set DISPLAY, or draw off screen, for example with --headless --output picture.png");
  }
  ++openWindows;
  setHints(options, 4, 5);
  GLFWwindow* window = glfwCreateWindow(options.size.x, options.size.y, options.title.c_str(), nullptr, nullptr);
  if (window == nullptr) {
    const std::string reason = lastGlfwError();
    const std::string found = versionFound(options);
    releaseGlfw();
    return failure(fmt::format("OpenGL 4.5 core is needed ({}), found {}", reason, found), "GLFW",
                   "install a driver with OpenGL 4.5 (Debian: libgl1-mesa-dri), or try LIBGL_ALWAYS_SOFTWARE=1");
  }
  return std::unique_ptr<WindowContext>(new WindowContext(window, options));
}

WindowContext::~WindowContext() {
  glfwDestroyWindow(window_);
  releaseGlfw();
}

Result<void> WindowContext::makeCurrent() {
  glfwGetError(nullptr);
  glfwMakeContextCurrent(window_);
  if (glfwGetCurrentContext() != window_) {
    return failure(fmt::format("the context cannot be made current ({})", lastGlfwError()), "GLFW");
  }
  if (options_.context.debug) {
    logDebugMessages();
  }
  if (options_.visible) {
    setVerticalSync(options_.verticalSync);
  }
  return {};
}

void WindowContext::release() {
  glfwMakeContextCurrent(nullptr);
}

Result<std::unique_ptr<Context>> WindowContext::createShared() {
  WindowOptions options = options_;
  options.visible = false;
  options.size = glm::ivec2(16);
  setHints(options, 4, 5);
  GLFWwindow* window = glfwCreateWindow(options.size.x, options.size.y, "", nullptr, window_);
  if (window == nullptr) {
    return failure(fmt::format("no second context ({})", lastGlfwError()), "GLFW");
  }
  ++openWindows;
  return std::unique_ptr<Context>(new WindowContext(window, std::move(options)));
}

glm::ivec2 WindowContext::framebufferSize() const {
  glm::ivec2 size{0};
  glfwGetFramebufferSize(window_, &size.x, &size.y);
  return size;
}

bool WindowContext::shouldClose() const {
  return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void WindowContext::swapBuffers() {
  glfwSwapBuffers(window_);
}

void WindowContext::setVerticalSync(bool on) {
  options_.verticalSync = on;
  glfwSwapInterval(on ? 1 : 0);
}

void WindowContext::pollEvents() {
  glfwPollEvents();
}

}  // namespace meridian::graphics
