#pragma once

#include <memory>
#include <string>

#include <glm/vec2.hpp>

#include "host/api/error.h"

struct GLFWwindow;

namespace meridian::graphics {

struct ContextOptions {
  /// Ask for a debug context and send KHR_debug messages to the log. On by default in builds with assertions.
#ifdef NDEBUG
  bool debug = false;
#else
  bool debug = true;
#endif
};

/// An OpenGL 4.5 core context. Contexts of one share group must be made and destroyed on the thread that made the
/// first (GLFW asks for it); each may then be current on any one thread.
class Context {
 public:
  Context() = default;
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  virtual ~Context() = default;

  /// Makes it current on the calling thread. Errors: it is current elsewhere, or the driver refuses.
  [[nodiscard]] virtual Result<void> makeCurrent() = 0;
  /// Makes no context current on the calling thread, which must be the one this is current on.
  virtual void release() = 0;
  /// A second context that shares buffers, textures and programs with this one and has nothing to show: for the
  /// warm-up thread. It leaves the current context as it was. It must die before this one.
  [[nodiscard]] virtual Result<std::unique_ptr<Context>> createShared() = 0;
};

/// Without a window and without a display server: EGL on Mesa's surfaceless platform, else on the first EGL device,
/// else with a pixel buffer on the default display. Draw into a RenderTarget: framebuffer 0 is not there.
class OffscreenContext final : public Context {
 public:
  /// Does not make it current. Errors: no EGL display, no OpenGL 4.5 (with the version found).
  [[nodiscard]] static Result<std::unique_ptr<OffscreenContext>> create(const ContextOptions& options = {});
  /// Destroys it; it may still be current on the calling thread.
  ~OffscreenContext() override;

  [[nodiscard]] Result<void> makeCurrent() override;
  void release() override;
  [[nodiscard]] Result<std::unique_ptr<Context>> createShared() override;

  /// "surfaceless", "device" or "default display".
  [[nodiscard]] const std::string& platform() const;

 private:
  struct Implementation;
  explicit OffscreenContext(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

struct WindowOptions {
  glm::ivec2 size{1280, 720};  ///< screen coordinates
  std::string title = "Meridian";
  bool verticalSync = true;
  bool visible = true;
  /// Through EGL instead of GLX; presents ten times slower on llvmpipe.
  bool egl = false;
  ContextOptions context{};
};

/// A resizable window and its context. Framebuffer 0 has colour only: depth is the RenderTarget's.
class WindowContext final : public Context {
 public:
  /// Does not make it current. Errors: no display server, no OpenGL 4.5 (with the version found).
  [[nodiscard]] static Result<std::unique_ptr<WindowContext>> create(const WindowOptions& options = {});
  ~WindowContext() override;

  [[nodiscard]] Result<void> makeCurrent() override;
  void release() override;
  [[nodiscard]] Result<std::unique_ptr<Context>> createShared() override;

  /// For input and panels, which set their callbacks and user pointer on it.
  [[nodiscard]] GLFWwindow* window() const { return window_; }
  /// Pixels; zero while the window is minimised.
  [[nodiscard]] glm::ivec2 framebufferSize() const;
  [[nodiscard]] bool shouldClose() const;
  /// Both need it to be current.
  void swapBuffers();
  void setVerticalSync(bool on);
  /// Delivers input events of all windows.
  static void pollEvents();

 private:
  WindowContext(GLFWwindow* window, WindowOptions options);
  GLFWwindow* window_;
  WindowOptions options_;
};

}  // namespace meridian::graphics
