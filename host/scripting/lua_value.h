#pragma once

#include <string>

#include "host/api/error.h"
#include "host/api/value.h"

struct lua_State;

namespace meridian::scripting {

/// Pushes a Value. Fields whose name is a whole number get that number as their key.
void pushValue(lua_State* lua, const Value& value);

/// The Lua value at a stack index as a Value. Errors, with the key's path in `what`: functions, userdata and threads;
/// tables inside themselves; tables deeper than 32 levels; more than a million entries; keys that are neither strings
/// nor numbers. The stack is left as it was.
[[nodiscard]] Result<Value> toValue(lua_State* lua, int index);

/// "CHUNK:LINE" of the Lua code that calls the C++ function that asks; empty when no Lua code does.
[[nodiscard]] std::string callerPlace(lua_State* lua);

}  // namespace meridian::scripting
