#include "host/scripting/sandbox.h"

#include <array>

#include <lua.hpp>

#include "host/api/log.h"
#include "host/scripting/string_functions.h"

namespace meridian::scripting {

namespace {

constexpr int hookInterval = 1000;

[[noreturn]] void raiseExhausted(lua_State* lua, int level) {
  const std::string text = placeFrom(lua, level) + ": the script ran for too long and was stopped";
  lua_pushlstring(lua, text.data(), text.size());
  lua_error(lua);
  __builtin_unreachable();
}

/// After the limit every instruction raises again, so that no pcall can hold the error.
void countHook(lua_State* lua, lua_Debug* /*event*/) {
  Guard& guard = guardOf(lua);
  if (!guard.exhausted) {
    const int interval = lua_gethookcount(lua);
    guard.instructionsLeft -= interval;
    if (guard.instructionsLeft > 0) {
      if (interval != hookInterval) {
        lua_sethook(lua, countHook, LUA_MASKCOUNT, hookInterval);
      }
      return;
    }
    guard.exhausted = true;
  }
  lua_sethook(lua, countHook, LUA_MASKCOUNT, 1);
  raiseExhausted(lua, 0);
}

int safePrint(lua_State* lua) {
  std::string line;
  const int count = lua_gettop(lua);
  for (int i = 1; i <= count; ++i) {
    std::size_t length = 0;
    const char* text = luaL_tolstring(lua, i, &length);
    line.append(i > 1 ? "\t" : "").append(text, length);
    lua_pop(lua, 1);
  }
  log::info("{}", line);
  return 0;
}

int callOriginal(lua_State* lua) {
  const int count = lua_gettop(lua);
  lua_pushvalue(lua, lua_upvalueindex(1));
  lua_insert(lua, 1);
  lua_call(lua, count, LUA_MULTRET);
  return lua_gettop(lua);
}

int safeLoad(lua_State* lua) {
  luaL_checkany(lua, 1);
  const int count = lua_gettop(lua);
  lua_settop(lua, count < 3 ? 3 : count);
  lua_pushliteral(lua, "t");
  lua_replace(lua, 3);
  return callOriginal(lua);
}

/// Finalizers run without hooks: an endless one could never be stopped.
int safeSetmetatable(lua_State* lua) {
  if (lua_istable(lua, 2)) {
    lua_pushliteral(lua, "__gc");
    if (lua_rawget(lua, 2) != LUA_TNIL) {
      return luaL_error(lua, "__gc is not available in scripts");
    }
    lua_pop(lua, 1);
  }
  return callOriginal(lua);
}

/// The table functions loop in C, where no hook counts: a length that lies would keep them there for ever.
int safeTableFunction(lua_State* lua) {
  if (luaL_getmetafield(lua, 1, "__len") != LUA_TNIL) {
    return luaL_error(lua, "table functions take no tables with __len");
  }
  return callOriginal(lua);
}

int safeMove(lua_State* lua) {
  const lua_Integer first = luaL_checkinteger(lua, 2);
  const lua_Integer last = luaL_checkinteger(lua, 3);
  if (last >= first) {
    const auto length = static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first);
    charge(lua, static_cast<std::int64_t>(length >> 1) + 1);
  }
  return callOriginal(lua);
}

/// Lua's own xpcall calls the handler inside the hook that raises, where no hook counts; this one calls it afterwards.
constexpr const char* safeXpcall = R"(
local pcall, pack, unpack = pcall, table.pack, table.unpack
function xpcall(body, handler, ...)
  local results = pack(pcall(body, ...))
  if results[1] then
    return unpack(results, 1, results.n)
  end
  return false, handler(results[2])
end
)";

void wrap(lua_State* lua, const char* library, const char* name, lua_CFunction replacement) {
  lua_getglobal(lua, library);
  lua_getfield(lua, -1, name);
  lua_pushcclosure(lua, replacement, 1);
  lua_setfield(lua, -2, name);
  lua_pop(lua, 1);
}

/// Logs a read of a global that nobody set, once per name: mostly a typing error, but old scripts test for globals so.
int unknownGlobal(lua_State* lua) {
  if (lua_type(lua, 2) == LUA_TSTRING) {
    lua_pushvalue(lua, 2);
    if (lua_rawget(lua, lua_upvalueindex(1)) == LUA_TNIL) {
      lua_pushvalue(lua, 2);
      lua_pushboolean(lua, 1);
      lua_rawset(lua, lua_upvalueindex(1));
      log::warning("{}: the global \"{}\" was never set", placeFrom(lua, 1), lua_tostring(lua, 2));
    }
  }
  lua_pushnil(lua);
  return 1;
}

}  // namespace

Guard& guardOf(lua_State* lua) {
  return **static_cast<Guard**>(lua_getextraspace(lua));
}

void charge(lua_State* lua, std::int64_t instructions) {
  Guard& guard = guardOf(lua);
  if (instructions < guard.instructionsLeft) {
    guard.instructionsLeft -= instructions;
    return;
  }
  guard.exhausted = true;
  lua_sethook(lua, countHook, LUA_MASKCOUNT, 1);
  raiseExhausted(lua, 1);
}

void installHook(lua_State* lua) {
  lua_sethook(lua, countHook, LUA_MASKCOUNT, hookInterval);
}

std::string placeFrom(lua_State* lua, int level) {
  lua_Debug frame{};
  for (; lua_getstack(lua, level, &frame) != 0; ++level) {
    lua_getinfo(lua, "Sl", &frame);
    // Our own Lua code is named with '='.
    if (frame.currentline > 0 && frame.source[0] != '=') {
      return std::string(frame.source[0] == '@' ? frame.source + 1 : frame.short_src) + ':' +
             std::to_string(frame.currentline);
    }
  }
  return {};
}

void openSandbox(lua_State* lua) {
  static constexpr std::array<luaL_Reg, 6> libraries{{{LUA_GNAME, luaopen_base},
                                                      {LUA_TABLIBNAME, luaopen_table},
                                                      {LUA_STRLIBNAME, luaopen_string},
                                                      {LUA_MATHLIBNAME, luaopen_math},
                                                      {LUA_UTF8LIBNAME, luaopen_utf8},
                                                      {LUA_COLIBNAME, luaopen_coroutine}}};
  for (const luaL_Reg& library : libraries) {
    luaL_requiref(lua, library.name, library.func, 1);
    lua_pop(lua, 1);
  }
  for (const char* name : {"dofile", "loadfile", "collectgarbage"}) {
    lua_pushnil(lua);
    lua_setglobal(lua, name);
  }
  lua_getglobal(lua, LUA_STRLIBNAME);
  lua_pushnil(lua);
  lua_setfield(lua, -2, "dump");
  lua_pop(lua, 1);
  openStringFunctions(lua);
  lua_pushcfunction(lua, safePrint);
  lua_setglobal(lua, "print");

  wrap(lua, LUA_GNAME, "load", safeLoad);
  wrap(lua, LUA_GNAME, "setmetatable", safeSetmetatable);
  for (const char* name : {"insert", "remove", "sort", "concat"}) {
    wrap(lua, LUA_TABLIBNAME, name, safeTableFunction);
  }
  wrap(lua, LUA_TABLIBNAME, "move", safeMove);
  luaL_loadbuffer(lua, safeXpcall, std::char_traits<char>::length(safeXpcall), "=xpcall");
  lua_call(lua, 0, 0);

  // Lua keeps the opened libraries in its registry, out of reach of scripts.
  lua_pushglobaltable(lua);
  lua_createtable(lua, 0, 1);
  lua_newtable(lua);
  lua_pushcclosure(lua, unknownGlobal, 1);
  lua_setfield(lua, -2, "__index");
  lua_setmetatable(lua, -2);
  lua_pop(lua, 1);
}

}  // namespace meridian::scripting
