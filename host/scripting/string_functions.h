#pragma once

struct lua_State;

namespace meridian::scripting {

/// Replaces string.find, match, gmatch and gsub by functions that mean the same and whose matching counts against the
/// script's instructions (lua_pattern.h). A pattern that is malformed is an error before any matching.
void openStringFunctions(lua_State* lua);

}  // namespace meridian::scripting
