#include "host/ui/scene_panel.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "host/navigation/geodetic_pose.h"

namespace meridian::ui {
namespace {

constexpr double astronomicalUnit = 149'597'870'700.0;
constexpr double degreesPerRadian = 180.0 / std::numbers::pi;

}  // namespace

std::string lengthText(double metres) {
  const double size = std::abs(metres);
  if (size < 1.0) {
    return fmt::format("{:.1f} cm", 100.0 * metres);
  }
  if (size < 1e4) {
    return fmt::format("{:.1f} m", metres);
  }
  if (size < 0.01 * astronomicalUnit) {
    return fmt::format("{:.1f} km", metres / 1000.0);
  }
  return fmt::format("{:.3f} au", metres / astronomicalUnit);
}

void ScenePanel::build(PanelBuilder& builder) {
  buildTime(builder);
  buildAnchors(builder);
}

void ScenePanel::buildTime(PanelBuilder& builder) {
  scripting::Clock& clock = subjects_.clock;
  builder.text(fmt::format("{} UTC", clock.time().utc()));
  builder.text(clock.isPaused() ? "paused" : fmt::format("{:g} seconds a second", clock.rate()));
  if (builder.button(clock.isPaused() ? "Run" : "Pause")) {
    clock.setPause(!clock.isPaused());
  }
  if (builder.button("Slower")) {
    clock.setDeltaTime(clock.previousDeltaTimeStep());
  }
  if (builder.button("Faster")) {
    clock.setDeltaTime(clock.nextDeltaTimeStep());
  }
  if (builder.button("Now")) {
    clock.setTime(Time::now());
  }
}

void ScenePanel::buildAnchors(PanelBuilder& builder) {
  navigation::Camera& camera = subjects_.camera;
  const scene::SceneNode& anchor = camera.anchor();
  builder.text(fmt::format("{}: height {}", anchor.guiName(), lengthText(subjects_.navigator.height())));
  if (const Ground* ground = anchor.ground()) {
    const navigation::GeodeticPose pose = navigation::geodeticFromPose(*ground, camera.pose());
    builder.text(fmt::format("latitude {:.5f}, longitude {:.5f}", pose.position.latitude * degreesPerRadian,
                             pose.position.longitude * degreesPerRadian));
  }
  builder.property(camera.verticalFieldOfViewDegrees);
  if (!builder.beginSection("Go to")) {
    return;
  }
  for (const auto& node : camera.scene().nodes()) {
    if (node->boundingSphere() > 0.0 && !node->isGuiHidden() &&
        builder.button(node->guiName() + "##" + node->identifier())) {
      subjects_.goTo(node->identifier());
    }
  }
  builder.endSection();
}

}  // namespace meridian::ui
