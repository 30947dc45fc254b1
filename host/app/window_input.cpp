#include "host/app/window_input.h"

#include <algorithm>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace meridian::app {
namespace {

constexpr int noButton = -1;

WindowInput& inputOf(GLFWwindow* window) {
  return *static_cast<WindowInput*>(glfwGetWindowUserPointer(window));
}

}  // namespace

WindowInput::WindowInput(GLFWwindow* window, navigation::OrbitNavigator& navigator, Commands commands)
    : window_(window), navigator_(navigator), commands_(std::move(commands)) {
  if (window == nullptr) {
    return;
  }
  glfwSetWindowUserPointer(window, this);
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int /*modifiers*/) {
    inputOf(w).mouseButton(button, action == GLFW_PRESS);
  });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
    int width = 0;
    int height = 0;
    glfwGetWindowSize(w, &width, &height);
    inputOf(w).mouseMove({x, y}, height);
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double /*x*/, double y) { inputOf(w).mouseWheel(y); });
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int /*scancode*/, int action, int modifiers) {
    if (action != GLFW_REPEAT) {
      inputOf(w).key(key, action == GLFW_PRESS, modifiers);
    }
  });
}

WindowInput::~WindowInput() {
  if (window_ != nullptr) {
    glfwSetMouseButtonCallback(window_, nullptr);
    glfwSetCursorPosCallback(window_, nullptr);
    glfwSetScrollCallback(window_, nullptr);
    glfwSetKeyCallback(window_, nullptr);
    glfwSetWindowUserPointer(window_, nullptr);
  }
}

void WindowInput::mouseButton(int button, bool pressed) {
  if (pressed) {
    if (draggingButton_ == noButton && !commands_.panelHasMouse()) {
      draggingButton_ = button;
      navigator_.stop();
    }
  } else if (button == draggingButton_) {
    draggingButton_ = noButton;
  }
}

void WindowInput::mouseMove(const glm::dvec2& position, double windowHeight) {
  const glm::dvec2 delta = (position - lastPosition_) / std::max(windowHeight, 1.0);
  lastPosition_ = position;
  using Motion = navigation::OrbitNavigator::Motion;
  switch (draggingButton_) {
    case GLFW_MOUSE_BUTTON_LEFT:
      navigator_.drag(Motion::Orbit, delta);
      break;
    case GLFW_MOUSE_BUTTON_RIGHT:
      navigator_.drag(Motion::Zoom, delta);
      break;
    case GLFW_MOUSE_BUTTON_MIDDLE:
      navigator_.drag(shift_ ? Motion::Roll : Motion::Tilt, delta);
      break;
    default:
      break;
  }
}

void WindowInput::mouseWheel(double notches) {
  if (!commands_.panelHasMouse()) {
    navigator_.scroll(notches);
  }
}

void WindowInput::key(int key, bool pressed, int modifiers) {
  shift_ = (modifiers & GLFW_MOD_SHIFT) != 0;
  if (!pressed || commands_.panelHasKeyboard()) {
    return;
  }
  switch (key) {
    case GLFW_KEY_F1:
      commands_.togglePanels();
      break;
    case GLFW_KEY_SPACE:
      commands_.togglePause();
      break;
    case GLFW_KEY_ESCAPE:
      commands_.quit();
      break;
    default:
      break;
  }
}

}  // namespace meridian::app
