#include "host/app/profile_start.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "host/api/log.h"
#include "host/app/start_view.h"
#include "host/navigation/geodetic_pose.h"
#include "host/navigation/navigation_state.h"
#include "host/scripting/property_scripts.h"
#include "host/scripting/time_scripts.h"

namespace meridian::app {
namespace {

using assets::Profile;

constexpr double degree = std::numbers::pi / 180.0;

class ProfileStart {
 public:
  ProfileStart(Application& application, const Profile& profile, const std::string& where)
      : application_(application), profile_(profile), where_(where) {}

  std::size_t run() {
    for (std::size_t i = 0; i < profile_.modules.size(); ++i) {
      const Profile::ModuleInstruction& module = profile_.modules[i];
      const bool loaded = application_.hasModule(module.name);
      runScript(loaded ? module.loaded : module.notLoaded,
                fmt::format("modules[{}].{}", i + 1, loaded ? "loadedInstruction" : "notLoadedInstruction"));
    }
    setTime();
    markNodes();
    addActions();
    setProperties();
    keep(placeCamera(), "camera");
    for (std::size_t i = 0; i < profile_.additionalScripts.size(); ++i) {
      runScript(profile_.additionalScripts[i], fmt::format("additional_scripts[{}]", i + 1));
    }
    return failures_;
  }

 private:
  void keep(const Result<void>& done, const std::string& key) {
    if (!done) {
      Error error = done.error();
      const std::string place = where_ + ": " + key;
      error.where = error.where.empty() ? place : place + ": " + error.where;
      log::error("{}", error.message());
      ++failures_;
    }
  }

  void runScript(const std::string& script, const std::string& key) {
    if (!script.empty()) {
      keep(application_.scripts().run(script, key), key);
    }
  }

  void setTime() {
    if (!profile_.deltaTimes.empty()) {
      application_.clock().setDeltaTimeSteps(profile_.deltaTimes);
    }
    if (!profile_.time) {
      return;
    }
    const Profile::StartTime& start = *profile_.time;
    const Result<Time> time =
        start.relative ? scripting::advanced(Time::now(), start.value) : Time::fromUtc(start.value);
    if (time) {
      application_.clock().setTime(*time);
    } else {
      keep(tl::make_unexpected(time.error()), "time.value");
    }
    application_.clock().setPause(start.paused);
    application_.scene().evaluate(application_.clock().time());
  }

  void markNodes() {
    for (std::size_t i = 0; i < profile_.markedNodes.size(); ++i) {
      if (scene::SceneNode* node = application_.scene().node(profile_.markedNodes[i])) {
        node->addTag("GUI.Interesting");
      } else {
        log::info("{}: mark_nodes[{}]: there is no node '{}'", where_, i + 1, profile_.markedNodes[i]);
      }
    }
  }

  void addActions() {
    for (std::size_t i = 0; i < profile_.actions.size(); ++i) {
      const Profile::ProfileAction& action = profile_.actions[i];
      keep(application_.actions().add(
               {action.identifier, action.name, action.documentation, action.guiPath, action.script, action.isLocal}),
           fmt::format("actions[{}].identifier", i + 1));
    }
    for (std::size_t i = 0; i < profile_.keyBindings.size(); ++i) {
      const auto& [key, action] = profile_.keyBindings[i];
      keep(application_.keys().bind(key, action), fmt::format("keybindings[{}].key", i + 1));
      if (application_.actions().find(action) == nullptr) {
        keep(failure(fmt::format("there is no action \"{}\"", action)), fmt::format("keybindings[{}].action", i + 1));
      }
    }
  }

  void setProperties() {
    // Their values are Lua literals, read where there is nothing to call.
    scripting::ScriptEngine literals;
    for (std::size_t i = 0; i < profile_.properties.size(); ++i) {
      const Profile::Setting& setting = profile_.properties[i];
      const std::string key = fmt::format("properties[{}].", i + 1);
      const auto values = literals.evaluate(setting.value, "value");
      if (!values || values->size() != 1 || values->front().isNil()) {
        keep(failure(fmt::format("'{}' is no value of Lua", setting.value), {},
                     "write a number, true, false, a \"string\" in quotes, or a {table}"),
             key + "value");
        continue;
      }
      // Most name what this program does not draw, as assets' own settings do: told, but no error.
      const auto set =
          scripting::setProperties(application_.properties(), application_.animation(), setting.name, values->front());
      if (!set) {
        log::warning("{}: {}name: {}", where_, key, set.error().message());
      }
    }
  }

  Result<void> placeCamera() {
    application_.scene().evaluate(application_.clock().time());
    if (const auto* geo = std::get_if<Profile::GoToGeo>(&profile_.camera)) {
      return goToGeo(*geo);
    }
    if (const auto* node = std::get_if<Profile::GoToNode>(&profile_.camera)) {
      return goToNode(*node);
    }
    if (const auto* state = std::get_if<Profile::SetNavigationState>(&profile_.camera)) {
      return navigation::setNavigationState(
          application_.camera(), {state->anchor, state->aim, state->frame, state->position, state->up, state->yaw,
                                  state->pitch, std::nullopt});
    }
    return {};
  }

  Result<void> goToGeo(const Profile::GoToGeo& geo) {
    if (auto shown = showNode(application_.camera(), geo.anchor); !shown) {
      return shown;
    }
    const Ground* ground = application_.scene().node(geo.anchor)->ground();
    if (ground == nullptr) {
      return failure(fmt::format("the node '{}' is no globe", geo.anchor), "anchor",
                     "name a node with a RenderableGlobe");
    }
    // Without altitude: as far off as shows the whole globe.
    const double altitude = geo.altitude.value_or(ground->geodetic(application_.camera().pose().position).height);
    return application_.camera().setPose(
        geo.anchor,
        navigation::poseFromGeodetic(
            *ground, {{geo.latitude * degree, geo.longitude * degree, altitude}, 0.0, -0.5 * std::numbers::pi, 0.0}));
  }

  Result<void> goToNode(const Profile::GoToNode& target) {
    auto shown = showNode(application_.camera(), target.anchor);
    if (!shown || !target.height) {
      return shown;
    }
    navigation::Pose pose = application_.camera().pose();
    const double distance = application_.scene().node(target.anchor)->boundingSphere() + *target.height;
    if (!(distance > 0.0)) {
      return failure("the height leads to the node's centre", "height", "give a height above 0");
    }
    pose.position *= distance / glm::length(pose.position);
    return application_.camera().setPose(pose);
  }

  Application& application_;
  const Profile& profile_;
  const std::string& where_;
  std::size_t failures_ = 0;
};

}  // namespace

std::size_t startProfile(Application& application, const Profile& profile, const std::string& where) {
  return ProfileStart(application, profile, where).run();
}

std::string assetOfProfile(const std::string& path) {
  return path.starts_with('/') || path.starts_with("${") ? path : "${ASSETS}/" + path;
}

}  // namespace meridian::app
