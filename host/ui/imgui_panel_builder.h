#pragma once

#include <string_view>

#include "host/api/panel.h"

namespace meridian::ui {

/// The widgets of a panel by Dear ImGui, into the window that is begun. Needs a current ImGui context between NewFrame
/// and EndFrame; knows nothing of windows or OpenGL.
class ImGuiPanelBuilder final : public PanelBuilder {
 public:
  void text(std::string_view text) override;
  void warning(std::string_view text) override;
  /// Check box, slider (with a range) or dragged number (without), choice, button or text field, as fits the property;
  /// its description appears under the pointer. A read-only property is shown as text. A value that the property
  /// refuses goes to the log, and the widget shows the old one again.
  void property(Property& property) override;
  [[nodiscard]] bool button(std::string_view label) override;
  [[nodiscard]] bool beginSection(std::string_view title) override;
  void endSection() override;
};

}  // namespace meridian::ui
