#include "host/scripting/lua_data.h"

#include <string>

#include <lua.hpp>

#include "host/api/regular_file.h"
#include "host/scripting/lua_value.h"
#include "host/scripting/script_engine.h"

namespace meridian::scripting {

namespace {

constexpr ScriptLimits limits{std::size_t{64} << 20, 10'000'000};

}  // namespace

Result<Value> readLuaData(const std::filesystem::path& file) {
  const Result<std::string> text = readRegularFile(file, largestText, "the file", "check the path");
  if (!text) {
    return tl::make_unexpected(text.error());
  }
  ScriptEngine engine(limits);
  if (auto loaded = engine.load(*text, file.string()); !loaded) {
    return tl::make_unexpected(loaded.error());
  }
  // Its globals go into a table of their own, behind which lie those of the sandbox.
  lua_State* lua = engine.state();
  lua_newtable(lua);
  lua_createtable(lua, 0, 1);
  lua_pushglobaltable(lua);
  lua_setfield(lua, -2, "__index");
  lua_setmetatable(lua, -2);
  lua_pushvalue(lua, -1);
  lua_setupvalue(lua, -3, 1);
  lua_insert(lua, -2);
  if (auto done = engine.call(0, 1); !done) {
    return tl::make_unexpected(done.error());
  }
  const Result<Value> value = toValue(lua, lua_isnil(lua, -1) ? -2 : -1);
  return value ? value : failure(value.error().what, file.string());
}

}  // namespace meridian::scripting
