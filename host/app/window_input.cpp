#include "host/app/window_input.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace meridian::app {
namespace {

constexpr int noButton = -1;

WindowInput& inputOf(GLFWwindow* window) {
  return *static_cast<WindowInput*>(glfwGetWindowUserPointer(window));
}

/// The names of keys that are not their own character.
constexpr std::array<std::pair<int, std::string_view>, 41> namedKeys{{{GLFW_KEY_SPACE, "SPACE"},
                                                                      {GLFW_KEY_ESCAPE, "ESCAPE"},
                                                                      {GLFW_KEY_ENTER, "ENTER"},
                                                                      {GLFW_KEY_TAB, "TAB"},
                                                                      {GLFW_KEY_BACKSPACE, "BACKSPACE"},
                                                                      {GLFW_KEY_INSERT, "INSERT"},
                                                                      {GLFW_KEY_DELETE, "DELETE"},
                                                                      {GLFW_KEY_RIGHT, "RIGHT"},
                                                                      {GLFW_KEY_LEFT, "LEFT"},
                                                                      {GLFW_KEY_DOWN, "DOWN"},
                                                                      {GLFW_KEY_UP, "UP"},
                                                                      {GLFW_KEY_PAGE_UP, "PAGE_UP"},
                                                                      {GLFW_KEY_PAGE_DOWN, "PAGE_DOWN"},
                                                                      {GLFW_KEY_HOME, "HOME"},
                                                                      {GLFW_KEY_END, "END"},
                                                                      {GLFW_KEY_CAPS_LOCK, "CAPS_LOCK"},
                                                                      {GLFW_KEY_SCROLL_LOCK, "SCROLL_LOCK"},
                                                                      {GLFW_KEY_NUM_LOCK, "NUM_LOCK"},
                                                                      {GLFW_KEY_PRINT_SCREEN, "PRINT_SCREEN"},
                                                                      {GLFW_KEY_PAUSE, "PAUSE"},
                                                                      {GLFW_KEY_APOSTROPHE, "APOSTROPHE"},
                                                                      {GLFW_KEY_COMMA, "COMMA"},
                                                                      {GLFW_KEY_MINUS, "MINUS"},
                                                                      {GLFW_KEY_PERIOD, "PERIOD"},
                                                                      {GLFW_KEY_SLASH, "SLASH"},
                                                                      {GLFW_KEY_SEMICOLON, "SEMICOLON"},
                                                                      {GLFW_KEY_EQUAL, "EQUAL"},
                                                                      {GLFW_KEY_LEFT_BRACKET, "LEFT_BRACKET"},
                                                                      {GLFW_KEY_BACKSLASH, "BACKSLASH"},
                                                                      {GLFW_KEY_RIGHT_BRACKET, "RIGHT_BRACKET"},
                                                                      {GLFW_KEY_GRAVE_ACCENT, "GRAVE_ACCENT"},
                                                                      {GLFW_KEY_KP_DECIMAL, "KP_DECIMAL"},
                                                                      {GLFW_KEY_KP_DIVIDE, "KP_DIVIDE"},
                                                                      {GLFW_KEY_KP_MULTIPLY, "KP_MULTIPLY"},
                                                                      {GLFW_KEY_KP_SUBTRACT, "KP_SUBTRACT"},
                                                                      {GLFW_KEY_KP_ADD, "KP_ADD"},
                                                                      {GLFW_KEY_KP_ENTER, "KP_ENTER"},
                                                                      {GLFW_KEY_KP_EQUAL, "KP_EQUAL"},
                                                                      {GLFW_KEY_MENU, "MENU"},
                                                                      {GLFW_KEY_WORLD_1, "WORLD_1"},
                                                                      {GLFW_KEY_WORLD_2, "WORLD_2"}}};

}  // namespace

std::string keyName(int key, int modifiers) {
  std::string name;
  const auto named =
      std::find_if(namedKeys.begin(), namedKeys.end(), [key](const auto& each) { return each.first == key; });
  if (named != namedKeys.end()) {
    name = named->second;
  } else if ((key >= GLFW_KEY_A && key <= GLFW_KEY_Z) || (key >= GLFW_KEY_0 && key <= GLFW_KEY_9)) {
    name = static_cast<char>(key);
  } else if (key >= GLFW_KEY_F1 && key <= GLFW_KEY_F25) {
    name = "F" + std::to_string(key - GLFW_KEY_F1 + 1);
  } else if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) {
    name = "KP_" + std::to_string(key - GLFW_KEY_KP_0);
  } else {
    return name;
  }
  const std::array<std::pair<int, std::string_view>, 4> held{
      {{GLFW_MOD_CONTROL, "Ctrl+"}, {GLFW_MOD_SHIFT, "Shift+"}, {GLFW_MOD_ALT, "Alt+"}, {GLFW_MOD_SUPER, "Super+"}}};
  std::string whole;
  for (const auto& [bit, word] : held) {
    whole += (modifiers & bit) != 0 ? word : "";
  }
  return whole + name;
}

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
  if (const std::string name = keyName(key, modifiers); !name.empty() && commands_.pressKey(name)) {
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
