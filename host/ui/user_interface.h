#pragma once

#include <memory>
#include <vector>

#include "host/api/error.h"
#include "host/api/panel.h"

struct GLFWwindow;

namespace meridian::ui {

/// Panels over the picture of one window, by Dear ImGui. Render thread only, with the window's context current.
class UserInterface {
 public:
  /// Chains itself behind the window's callbacks that are set by now. Errors: ImGui cannot draw with this context.
  [[nodiscard]] static Result<std::unique_ptr<UserInterface>> create(GLFWwindow* window);
  virtual ~UserInterface() = default;

  /// Where a panel starts: below those that were added to the same side before.
  enum class Side { Left, Right };
  virtual void add(std::unique_ptr<Panel> panel, Side side) = 0;
  /// Builds the panels and draws them into framebuffer 0; leaves the default GL state behind. Hidden: does nothing.
  virtual void draw() = 0;

  virtual void setVisible(bool visible) = 0;
  [[nodiscard]] virtual bool isVisible() const = 0;
  /// Whether the mouse is over a panel or drags one; whether keys go into a text field. Never when hidden.
  [[nodiscard]] virtual bool hasMouse() const = 0;
  [[nodiscard]] virtual bool hasKeyboard() const = 0;
};

}  // namespace meridian::ui
