#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>

#include "host/api/panel.h"
#include "host/navigation/camera.h"
#include "host/navigation/orbit_navigator.h"
#include "host/scripting/clock.h"

namespace meridian::ui {

/// Time and its speed, and what the camera is anchored at and how high over it.
class ScenePanel final : public Panel {
 public:
  /// What it shows and sets; all must outlive it.
  struct Subjects {
    scripting::Clock& clock;
    navigation::Camera& camera;
    navigation::OrbitNavigator& navigator;
    std::function<void(std::string_view node)> goTo;
  };
  explicit ScenePanel(Subjects subjects) : subjects_(std::move(subjects)) {}

  [[nodiscard]] std::string title() const override { return "Scene"; }
  void build(PanelBuilder& builder) override;

 private:
  void buildTime(PanelBuilder& builder);
  void buildAnchors(PanelBuilder& builder);

  Subjects subjects_;
};

/// "384.4 km": metres with a unit that fits.
[[nodiscard]] std::string lengthText(double metres);

}  // namespace meridian::ui
