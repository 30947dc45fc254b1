#pragma once

#include <cstdint>
#include <string>

struct lua_State;

namespace meridian::scripting {

/// What the safe functions of sandbox.cpp may ask of the engine; reached through the state's extra space.
struct Guard {
  std::int64_t instructionsLeft = 0;
  bool exhausted = false;
  std::size_t memoryUsed = 0;
  std::size_t memoryLimit = 0;
};

[[nodiscard]] Guard& guardOf(lua_State* lua);

/// Ends the running script with an error unless it may still spend so many instructions.
void charge(lua_State* lua, std::int64_t instructions);

/// Counts instructions from now on.
void installHook(lua_State* lua);

/// Opens Lua's harmless libraries and takes out or replaces what leads out of the sandbox.
void openSandbox(lua_State* lua);

/// "CHUNK:LINE" of the innermost Lua function from this level of the call stack upwards; empty without one.
[[nodiscard]] std::string placeFrom(lua_State* lua, int level);

}  // namespace meridian::scripting
