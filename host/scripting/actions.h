#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"
#include "host/api/script_library.h"
#include "host/api/value.h"
#include "host/scripting/script_engine.h"

namespace meridian::scripting {

/// A script with a name, that keys, profiles and other scripts call.
struct Action {
  std::string identifier;
  std::string name{};
  std::string documentation{};
  std::string guiPath{};
  std::string command{};
  bool isLocal = false;  ///< not for the other computers of a cluster; kept and given back, nothing more
};

/// The actions by identifier. Render thread only.
class Actions {
 public:
  /// The engine outlives it.
  explicit Actions(ScriptEngine& engine) : engine_(&engine) {}

  /// Errors: no identifier; one that is taken.
  Result<void> add(const Action& action);
  /// Errors: no such action.
  Result<void> remove(std::string_view identifier);
  [[nodiscard]] const Action* find(std::string_view identifier) const;
  /// Queues the action's script, for which `args` is a global. Errors: no such action.
  Result<void> trigger(std::string_view identifier, const Value& arguments = {});
  [[nodiscard]] const std::map<std::string, Action, std::less<>>& all() const { return actions_; }

 private:
  ScriptEngine* engine_;
  std::map<std::string, Action, std::less<>> actions_;
};

/// Which actions a key calls. Keys are written "SPACE", "F5", "a", "Ctrl+Shift+H", in any case and order of modifiers.
class KeyBindings {
 public:
  explicit KeyBindings(Actions& actions) : actions_(&actions) {}

  /// Errors: an empty key, a modifier other than Ctrl, Shift, Alt and Super.
  Result<void> bind(std::string_view key, std::string action);
  /// The reverse. Errors: as above.
  Result<void> unbind(std::string_view key, std::string_view action);
  /// Forgets what the key calls. Errors: as above.
  Result<void> clear(std::string_view key);
  void clearAll() { bindings_.clear(); }
  /// Calls what is bound to the key; whether there was anything. An action that is gone is logged.
  bool press(std::string_view key);
  [[nodiscard]] std::vector<std::string> actionsOf(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> keysOf(std::string_view action) const;

 private:
  Actions* actions_;
  std::multimap<std::string, std::string> bindings_;  ///< key, in its one spelling -> action
};

/// `openspace.action.*`: registerAction, removeAction, hasAction, action, actions, triggerAction. A second action of
/// the same name is an error, as is triggering what is not there. `note` hears of each that is registered.
[[nodiscard]] ScriptLibrary actionLibrary(Actions& actions, NoteRegistration note);
/// `openspace.*`: bindKey, clearKey, clearKeys, keyBindings, keyBindingsForAction. `note` hears of each that
/// was not bound before.
[[nodiscard]] ScriptLibrary keyLibrary(KeyBindings& keys, NoteRegistration note);

}  // namespace meridian::scripting
