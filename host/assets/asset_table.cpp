#include "host/assets/asset_table.h"

#include <array>
#include <cstdint>

#include <fmt/format.h>
#include <lua.hpp>

#include "host/assets/asset_graph.h"
#include "host/scripting/lua_value.h"

namespace meridian::assets {

namespace fs = std::filesystem;

namespace {

/// One call of a function of `asset`: arguments on the stack, results pushed, their number returned.
struct Call {
  lua_State* lua;
  AssetGraph& graph;
  Asset& asset;

  [[nodiscard]] Result<std::string> text(int index, std::string_view name) const {
    if (lua_type(lua, index) != LUA_TSTRING) {
      return failure(fmt::format("argument {} ({}) must be a string", index, name));
    }
    std::size_t length = 0;
    const char* characters = lua_tolstring(lua, index, &length);
    return std::string(characters, length);
  }
  [[nodiscard]] int give(const std::string& text) const {
    lua_pushlstring(lua, text.data(), text.size());
    return 1;
  }
};

using Function = Result<int> (*)(const Call&);

Result<int> require(const Call& call) {
  const Result<std::string> path = call.text(1, "path");
  if (!path) {
    return tl::make_unexpected(path.error());
  }
  const bool enabled = lua_isnoneornil(call.lua, 2) || lua_toboolean(call.lua, 2) != 0;
  return call.graph.require(call.asset, *path, enabled).map([&](const Asset* required) {
    lua_rawgeti(call.lua, LUA_REGISTRYINDEX, required->exports);
    return 1;
  });
}

Result<int> exists(const Call& call) {
  return call.text(1, "path")
      .and_then([&](const std::string& path) { return call.graph.resolve(path, &call.asset); })
      .map([&](const fs::path& file) {
        std::error_code ignored;
        lua_pushboolean(call.lua, fs::is_regular_file(file, ignored) ? 1 : 0);
        return 1;
      });
}

/// A word of a synchronisation that becomes a folder's name, so it must not lead elsewhere.
Result<std::string> folderName(const Value& table, std::string_view key) {
  const Value* found = table.find(key);
  const std::string text = found == nullptr             ? std::string()
                           : found->string() != nullptr ? *found->string()
                           : found->number()            ? fmt::format("{}", *found->number())
                                                        : std::string();
  if (text.empty() || text == "." || text == ".." || text.find_first_of(std::string_view("/\\\0", 3)) != text.npos) {
    return failure(fmt::format("{} must be a name without slashes", key), std::string(key));
  }
  return text;
}

/// Where a synchronisation would put its files. We fetch nothing: absent data is for the one who opens it to report.
Result<std::string> synchronisedFolder(const Call& call, const Value& table) {
  const fs::path* sync = call.graph.tokens().find("SYNC");
  const Value* type = table.find("Type");
  if (sync == nullptr || type == nullptr || type->string() == nullptr) {
    return failure("a synchronisation needs a Type", "Type", "use HttpSynchronization or UrlSynchronization");
  }
  const Result<std::string> identifier = folderName(table, "Identifier");
  if (!identifier) {
    return tl::make_unexpected(identifier.error());
  }
  if (*type->string() == "UrlSynchronization") {
    return (*sync / "url" / *identifier).string() + '/';
  }
  if (*type->string() == "HttpSynchronization") {
    return folderName(table, "Version").map([&](const std::string& version) {
      return (*sync / "http" / *identifier / version).string() + '/';
    });
  }
  return failure(fmt::format("unknown synchronisation \"{}\"", *type->string()), "Type",
                 "use HttpSynchronization or UrlSynchronization");
}

Result<int> resource(const Call& call) {
  const fs::path folder = call.asset.file.parent_path();
  if (lua_isnoneornil(call.lua, 1)) {
    return call.give(folder.string());
  }
  if (lua_istable(call.lua, 1)) {
    return scripting::toValue(call.lua, 1)
        .and_then([&](const Value& table) { return synchronisedFolder(call, table); })
        .map([&](const std::string& text) { return call.give(text); });
  }
  return call.text(1, "path")
      .and_then([&](const std::string& path) { return call.graph.tokens().expand(path); })
      .map([&](const fs::path& path) {
        return call.give((path.is_absolute() ? path : (folder / path).lexically_normal()).string());
      });
}

/// export(table with Identifier) or export(key, value).
Result<int> exportValue(const Call& call) {
  lua_State* lua = call.lua;
  const bool single = lua_gettop(lua) == 1;
  if (single && !lua_istable(lua, 1)) {
    return failure("export takes a table with an Identifier, or a key and a value");
  }
  if (single) {
    lua_pushliteral(lua, "Identifier");
    lua_rawget(lua, 1);
    lua_insert(lua, 1);
  }
  if (lua_type(lua, 1) != LUA_TSTRING || lua_gettop(lua) != 2) {
    return failure(single ? "the exported table has no Identifier" : "export takes a key (a string) and a value");
  }
  lua_rawgeti(lua, LUA_REGISTRYINDEX, call.asset.exports);
  lua_insert(lua, 1);
  lua_rawset(lua, 1);
  return 0;
}

Result<int> keepFunction(const Call& call, std::vector<int>& references) {
  if (!lua_isfunction(call.lua, 1)) {
    return failure(fmt::format("argument 1 must be a function, found {}", luaL_typename(call.lua, 1)));
  }
  lua_settop(call.lua, 1);
  references.push_back(luaL_ref(call.lua, LUA_REGISTRYINDEX));
  return 0;
}

Result<int> onInitialize(const Call& call) {
  if (call.asset.state != Asset::State::Loading) {
    return failure("onInitialize comes too late: the asset is loaded already");
  }
  return keepFunction(call, call.asset.onInitialize);
}

Result<int> onDeinitialize(const Call& call) {
  return keepFunction(call, call.asset.onDeinitialize);
}

/// Lua code may have kept a function of `asset` for longer than the graph kept its asset.
Result<int> callIfThere(lua_State* lua, AssetGraph& graph, Function body) {
  Asset* const asset = graph.find(static_cast<std::uint64_t>(lua_tointeger(lua, lua_upvalueindex(2))));
  if (asset == nullptr) {
    return failure(
        fmt::format("the asset {} that this function belongs to was removed", lua_tostring(lua, lua_upvalueindex(3))),
        {}, "ask `asset` again where the asset is loaded");
  }
  return body({lua, graph, *asset});
}

template <Function Body>
int bound(lua_State* lua) {
  auto& graph = *static_cast<AssetGraph*>(lua_touserdata(lua, lua_upvalueindex(1)));
  const Result<int> results = callIfThere(lua, graph, Body);
  if (results) {
    return *results;
  }
  Error error = results.error();
  const std::string place = scripting::callerPlace(lua);
  error.where = error.where.empty() ? place : place + ": " + error.where;
  graph.engine().pushError(lua, std::move(error));
  return lua_error(lua);
}

int unknownMember(lua_State* lua) {
  if (const char* name = lua_tostring(lua, 2); name != nullptr && std::string_view(name) != "meta") {
    return luaL_error(lua, "asset.%s does not exist, or its asset was removed", name);
  }
  lua_pushnil(lua);
  return 1;
}

void setText(lua_State* lua, const char* key, const std::string& text) {
  lua_pushlstring(lua, text.data(), text.size());
  lua_setfield(lua, -2, key);
}

}  // namespace

void makeAssetTable(lua_State* lua, AssetGraph& graph, Asset& asset, bool enabled) {
  static constexpr std::array<luaL_Reg, 8> functions{{{"require", bound<require>},
                                                      {"exists", bound<exists>},
                                                      {"resource", bound<resource>},
                                                      {"localResource", bound<resource>},
                                                      {"syncedResource", bound<resource>},
                                                      {"export", bound<exportValue>},
                                                      {"onInitialize", bound<onInitialize>},
                                                      {"onDeinitialize", bound<onDeinitialize>}}};
  const std::string file = asset.file.string();
  lua_newtable(lua);
  for (const luaL_Reg& function : functions) {
    lua_pushlightuserdata(lua, &graph);
    lua_pushinteger(lua, static_cast<lua_Integer>(asset.id));
    lua_pushlstring(lua, file.data(), file.size());
    lua_pushcclosure(lua, function.func, 3);
    lua_setfield(lua, -2, function.name);
  }
  setText(lua, "directory", asset.file.parent_path().string());
  setText(lua, "filePath", file);
  lua_pushboolean(lua, enabled ? 1 : 0);
  lua_setfield(lua, -2, "enabled");
  lua_createtable(lua, 0, 1);
  lua_pushcfunction(lua, unknownMember);
  lua_setfield(lua, -2, "__index");
  lua_setmetatable(lua, -2);
  asset.table = luaL_ref(lua, LUA_REGISTRYINDEX);
  lua_newtable(lua);
  asset.exports = luaL_ref(lua, LUA_REGISTRYINDEX);
}

void setGlobals(lua_State* lua, const Asset& asset) {
  lua_createtable(lua, 0, 1);
  lua_rawgeti(lua, LUA_REGISTRYINDEX, asset.table);
  lua_setfield(lua, -2, "asset");
  lua_createtable(lua, 0, 2);
  lua_pushglobaltable(lua);
  lua_pushvalue(lua, -1);
  lua_setfield(lua, -3, "__index");
  lua_setfield(lua, -2, "__newindex");
  lua_setmetatable(lua, -2);
  lua_setupvalue(lua, -2, 1);
}

}  // namespace meridian::assets
