#include "host/scripting/foreign_scripts.h"

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "host/api/log.h"

namespace meridian::scripting {

namespace {

constexpr std::size_t anyNumber = 32;

/// Some functions of one library that give back the same.
struct ForeignFunctions {
  std::string_view library;
  std::string_view what;   ///< for people: what there is none of
  std::string_view names;  ///< parted by blanks
  Value result = {};       ///< nil: no value
};

const std::vector<ForeignFunctions>& foreignFunctions() {
  static const std::vector<ForeignFunctions> all{
      {"", "screen-space renderables", "addScreenSpaceRenderable removeScreenSpaceRenderable"},
      {"", "missions", "loadMission unloadMission setCurrentMission"},
      {"", "scheduled scripts", "scheduleScript"},
      {"", "shadow casters", "registerShadowcaster removeShadowcaster"},
      {"", "downloads by scripts", "downloadFile"},
      {"", "screenshots by scripts", "takeScreenshot setScreenshotFolder resetScreenshotNumber"},
      {"", "lists of interesting times", "addInterestingTime markInterestingTimes"},
      {"", "an order of its own in the panels", "setGuiOrder"},
      {"", "ways to quit by scripts", "toggleShutdown"},
      {"", "custom properties", "addCustomProperty removeCustomProperty appendToListProperty addToPropertyValue"},
      {"", "script files run by scripts", "runFile"},
      {"dashboard", "dashboards",
       "addDashboardItem addDashboardItemToScreenSpace removeDashboardItem removeDashboardItemFromScreenSpace "
       "clearDashboardItems"},
      {"dashboard", "dashboards", "dashboardItems", Table{}},
      {"sessionRecording", "pictures of a playback by scripts, --output writes them",
       "enableTakeScreenShotDuringPlayback disableTakeScreenShotDuringPlayback"},
      {"keyframeRecording", "recordings of keyframes",
       "newSequence addCameraKeyframe addScriptKeyframe removeKeyframe updateKeyframe moveKeyframe saveSequence "
       "loadSequence play pause"},
      {"keyframeRecording", "recordings of keyframes", "keyframes", Table{}},
      {"scriptScheduler", "scheduled scripts",
       "loadFile loadScheduledScript setModeApplicationTime setModeRecordedTime "
       "setModeSimulationTime clear"},
      {"scriptScheduler", "scheduled scripts", "scheduledScripts", Table{}},
      {"event", "events", "registerEventAction unregisterEventAction enableEvent disableEvent"},
      {"event", "events", "registeredEvents", Table{}},
      {"navigation", "idle motion", "triggerIdleMotion orbitAnchor"},
      {"navigation", "files of camera poses", "saveNavigationState loadNavigationState"},
      {"navigation", "joysticks",
       "bindJoystickAxis bindJoystickAxisProperty bindJoystickButton clearJoystickButton setAxisDeadZone "
       "unbindJoystick"},
      {"navigation", "joysticks", "joystickAxis joystickButton listAllJoysticks", Table{}},
      {"navigation", "joysticks", "axisDeadzone", 0.0},
      {"audio", "sound",
       "playAudio playAudio3d stopAudio setVolume setGlobalVolume set3dListenerPosition set3dSourcePosition "
       "setLooping pauseAudio resumeAudio pauseAll resumeAll playAllFromStart stopAll setSpeakerPosition"},
      {"audio", "sound", "isPlaying isPaused isLooping", false},
      {"sonification", "sound", "addPlanets"},
      {"telemetry", "telemetry", "addNodes"},
      {"skybrowser", "sky browsers",
       "setHoverIndicator addDisplayCopy removeDisplayCopy createTargetBrowserPair removeTargetBrowserPair "
       "setSelectedBrowser selectImage sendOutIdsToBrowsers"},
      {"statemachine", "state machines",
       "createStateMachine destroyStateMachine goToState setInitialState saveToDotFile printCurrentStateInfo"},
      {"statemachine", "state machines", "canGoToState", false},
      {"systemCapabilities", "other systems", "os fullOperatingSystem", "Linux"},
      {"exoplanets", "exoplanets", "addExoplanetSystem removeExoplanetSystem"},
      {"exoplanets", "exoplanets", "listOfExoplanets systemList", Table{}},
      {"spice", "SPICE kernels, positions come from series", "unloadKernel position rotationMatrix convertTLEtoSPK"},
      {"spice", "SPICE kernels, positions come from series", "loadKernel", 0.0},
      {"spice", "SPICE kernels, positions come from series", "kernels spiceBodies", Table{}},
  };
  return all;
}

/// Says it once, whichever of the library's parts is missing.
ScriptFunction foreign(const ForeignFunctions& group, std::string name) {
  auto told = std::make_shared<bool>(false);
  const std::string whole = "openspace." + std::string(group.library) + (group.library.empty() ? "" : ".") + name;
  return {std::move(name),
          "...",
          "Accepted without effect.",
          0,
          anyNumber,
          [told, whole, what = std::string(group.what), result = group.result](std::span<const Value>) -> ScriptResult {
            if (!std::exchange(*told, true)) {
              log::info("{} has no effect: there are no {}", whole, what);
            }
            return result.isNil() ? std::vector<Value>() : std::vector<Value>{result};
          }};
}

}  // namespace

std::vector<ScriptLibrary> foreignLibraries() {
  std::vector<ScriptLibrary> libraries;
  for (const ForeignFunctions& group : foreignFunctions()) {
    ScriptLibrary& library = libraries.emplace_back();
    library.name = group.library;
    std::string_view names = group.names;
    while (!names.empty()) {
      const std::size_t end = std::min(names.find(' '), names.size());
      library.functions.push_back(foreign(group, std::string(names.substr(0, end))));
      names.remove_prefix(std::min(end + 1, names.size()));
    }
  }
  return libraries;
}

}  // namespace meridian::scripting
