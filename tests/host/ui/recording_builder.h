#pragma once

#include <set>
#include <string>
#include <vector>

#include "host/api/panel.h"

namespace meridian::ui {

/// Notes what a panel asks for, and presses the buttons it is told to.
class RecordingBuilder final : public PanelBuilder {
 public:
  void text(std::string_view text) override { texts.emplace_back(text); }
  void warning(std::string_view text) override { warnings.emplace_back(text); }
  void property(Property& property) override { properties.push_back(&property); }
  [[nodiscard]] bool button(std::string_view label) override {
    buttons.emplace_back(label.substr(0, label.find("##")));
    return pressed.contains(buttons.back());
  }
  [[nodiscard]] bool beginSection(std::string_view /*title*/) override { return true; }
  void endSection() override {}

  std::vector<std::string> texts;
  std::vector<std::string> warnings;
  std::vector<std::string> buttons;
  std::vector<Property*> properties;
  std::set<std::string> pressed;
};

}  // namespace meridian::ui
