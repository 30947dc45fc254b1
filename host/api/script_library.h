#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "host/api/error.h"
#include "host/api/value.h"

namespace meridian {

/// What a script function returns: none, one or several values. An Error becomes a Lua error with the caller's place.
using ScriptResult = Result<std::vector<Value>>;

/// Hears that a script registered something under a name of its kind ("action sun"), and how to take that back, which
/// does nothing once it is gone: what an asset registered before it failed must not be in the way when it is reloaded.
using NoteRegistration = std::function<void(std::string name, std::function<void()> takeBack)>;

/// One function of the `openspace` table. Arguments that the script leaves out are not in the span.
struct ScriptFunction {
  std::string name;
  std::string arguments;  ///< for people and error messages: "globe, group, table"
  std::string description;
  std::size_t minimumArguments = 0;
  std::size_t maximumArguments = 0;
  std::function<ScriptResult(std::span<const Value>)> call;
  /// Whether a call with these arguments has to wait for what is on its way. The script then stands still while frames
  /// go on, and this is asked again in each. Empty: never. Where a script cannot stand still (in an expression that is
  /// evaluated, in a function that C code calls, in a coroutine of its own) `call` comes at once all the same.
  std::function<bool(std::span<const Value>)> mustWait{};
};

/// `openspace.NAME.*`; an empty name means `openspace.*` itself.
struct ScriptLibrary {
  std::string name;
  std::vector<ScriptFunction> functions;
};

}  // namespace meridian
