#pragma once

#include <functional>
#include <string>

#include <glm/vec2.hpp>

#include "host/navigation/orbit_navigator.h"

struct GLFWwindow;

namespace meridian::app {

/// Turns a window's mouse and keys into motions of the camera and into commands: left drag orbits, right drag and wheel
/// zoom, middle drag tilts (with Shift: rolls); keys call what is bound to them, else F1, Space and Escape the
/// commands. Takes the window's user pointer and its callbacks; whoever sets others afterwards must call these too.
/// Render thread only.
class WindowInput {
 public:
  struct Commands {
    std::function<void()> togglePanels;
    std::function<void()> togglePause;
    std::function<void()> quit;
    /// Calls what a profile or a script bound to a key, as "Ctrl+Shift+H"; whether there was anything.
    std::function<bool(const std::string& key)> pressKey;
    /// Whether a panel takes what the mouse (the keyboard) does now.
    std::function<bool()> panelHasMouse;
    std::function<bool()> panelHasKeyboard;
  };

  WindowInput(GLFWwindow* window, navigation::OrbitNavigator& navigator, Commands commands);
  ~WindowInput();
  WindowInput(const WindowInput&) = delete;
  WindowInput& operator=(const WindowInput&) = delete;

  // What the window's callbacks call; the numbers are GLFW's.
  void mouseButton(int button, bool pressed);
  void mouseMove(const glm::dvec2& position, double windowHeight);
  void mouseWheel(double notches);
  void key(int key, bool pressed, int modifiers);

 private:
  GLFWwindow* window_;
  navigation::OrbitNavigator& navigator_;
  Commands commands_;
  int draggingButton_ = -1;  ///< none
  bool shift_ = false;
  glm::dvec2 lastPosition_{0.0};
};

/// A key of GLFW's with its modifiers as bindings write it: "Ctrl+Shift+H", "F5", "KP_0"; empty for keys without name.
[[nodiscard]] std::string keyName(int key, int modifiers);

}  // namespace meridian::app
