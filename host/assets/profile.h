#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/vec3.hpp>

#include "host/api/error.h"

namespace meridian::assets {

/// What OpenSpace's users start from: a JSON file that lists assets and says what is done once they are loaded. All
/// texts as they stand in the file.
struct Profile {
  struct GoToGeo {
    std::string anchor;
    double latitude = 0.0;           ///< degrees
    double longitude = 0.0;          ///< degrees
    std::optional<double> altitude;  ///< metres
  };
  struct GoToNode {
    std::string anchor;
    std::optional<double> height;  ///< metres over its bounding sphere
  };
  struct SetNavigationState {
    std::string anchor;
    std::string aim;
    std::string frame;
    glm::dvec3 position{0.0};  ///< metres
    std::optional<glm::dvec3> up;
    double yaw = 0.0;    ///< radians
    double pitch = 0.0;  ///< radians
  };
  struct StartTime {
    bool relative = false;  ///< to now: "[-]N" and a unit s, m, h, d, M or y; else a UTC date
    std::string value;
    bool paused = false;
  };
  struct Setting {
    bool single = false;  ///< names one property, no pattern
    std::string name;
    std::string value;  ///< a Lua literal
  };
  struct ProfileAction {
    std::string identifier;
    std::string name;
    std::string documentation;
    std::string guiPath;
    bool isLocal = false;
    std::string script;
  };
  struct KeyBinding {
    std::string key;
    std::string action;
  };
  struct ModuleInstruction {
    std::string name;
    std::string loaded;     ///< the script to run when the program has the module
    std::string notLoaded;  ///< and when it has not
  };

  std::string name;  ///< of meta; empty without
  /// Paths as in asset.require from ${ASSETS}, those of addons at the end.
  std::vector<std::string> assets;
  std::variant<std::monostate, GoToGeo, GoToNode, SetNavigationState> camera;
  std::optional<StartTime> time;
  std::vector<double> deltaTimes;  ///< simulation seconds a second
  std::vector<std::string> markedNodes;
  std::vector<Setting> properties;
  std::vector<ProfileAction> actions;
  std::vector<KeyBinding> keyBindings;
  std::vector<ModuleInstruction> modules;
  std::vector<std::string> additionalScripts;
};

/// Reads versions 1.0 to 1.x, with the addons that it names: files `NAME.addon` beside it or in a folder above. Every
/// key that is unknown or of a wrong type is an error with file and key; then there is no profile.
[[nodiscard]] tl::expected<Profile, std::vector<Error>> readProfile(const std::filesystem::path& file);

/// Whether it is called "NAME.profile".
[[nodiscard]] bool isProfile(const std::filesystem::path& file);

}  // namespace meridian::assets
