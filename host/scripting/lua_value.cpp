#include "host/scripting/lua_value.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <lua.hpp>

#include "host/scripting/sandbox.h"

namespace meridian::scripting {

namespace {

constexpr std::size_t deepest = 32;
constexpr std::size_t mostEntries = 1'000'000;

/// Reads one value with all that is in it; `path` is where in the outermost table we are.
class Reader {
 public:
  explicit Reader(lua_State* lua) : lua_(lua) {}

  Result<Value> read(int index, const std::string& path) {
    switch (lua_type(lua_, index)) {
      case LUA_TNIL:
      case LUA_TNONE:
        return Value();
      case LUA_TBOOLEAN:
        return Value(lua_toboolean(lua_, index) != 0);
      case LUA_TNUMBER:
        return Value(static_cast<double>(lua_tonumber(lua_, index)));
      case LUA_TSTRING: {
        std::size_t length = 0;
        const char* text = lua_tolstring(lua_, index, &length);
        return Value(std::string(text, length));
      }
      case LUA_TTABLE:
        return readTable(lua_absindex(lua_, index), path);
      default:
        return failure(fmt::format("{} cannot be a {}", path.empty() ? "the value" : path, luaL_typename(lua_, index)));
    }
  }

 private:
  Result<Value> readTable(int index, const std::string& path) {
    const void* self = lua_topointer(lua_, index);
    if (std::find(open_.begin(), open_.end(), self) != open_.end()) {
      return failure(fmt::format("{} is a table inside itself", path));
    }
    if (open_.size() >= deepest) {
      return failure(fmt::format("{} is nested deeper than {} tables", path, deepest));
    }
    if (lua_checkstack(lua_, 4) == 0) {
      return failure("the Lua stack is full");
    }
    open_.push_back(self);
    Table table;
    const int top = lua_gettop(lua_);
    Result<void> done = readList(index, path, table);
    if (done) {
      done = readFields(index, path, table);
    }
    lua_settop(lua_, top);
    open_.pop_back();
    if (!done) {
      return tl::make_unexpected(done.error());
    }
    return Value(std::move(table));
  }

  Result<void> readList(int index, const std::string& path, Table& table) {
    for (lua_Integer i = 1; lua_rawgeti(lua_, index, i) != LUA_TNIL; ++i) {
      Result<Value> item = readEntry(fmt::format("{}[{}]", path, i));
      if (!item) {
        return tl::make_unexpected(item.error());
      }
      table.list.push_back(std::move(*item));
      lua_pop(lua_, 1);
    }
    lua_pop(lua_, 1);
    return {};
  }

  Result<void> readFields(int index, const std::string& path, Table& table) {
    lua_pushnil(lua_);
    while (lua_next(lua_, index) != 0) {
      const int type = lua_type(lua_, -2);
      std::string key;
      if (type == LUA_TNUMBER) {
        const double number = lua_tonumber(lua_, -2);
        if (number >= 1.0 && number <= static_cast<double>(table.list.size()) && number == std::floor(number)) {
          lua_pop(lua_, 1);
          continue;
        }
        key = fmt::format("{}", number);
      } else if (type == LUA_TSTRING) {
        std::size_t length = 0;
        const char* text = lua_tolstring(lua_, -2, &length);
        key.assign(text, length);
      } else {
        return failure(fmt::format("{} has a {} as a key", path.empty() ? "the table" : path, lua_typename(lua_, type)),
                       {}, "use strings or numbers");
      }
      Result<Value> item = readEntry(path.empty() ? key : fmt::format("{}.{}", path, key));
      if (!item) {
        return tl::make_unexpected(item.error());
      }
      table.fields.insert_or_assign(std::move(key), std::move(*item));
      lua_pop(lua_, 1);
    }
    return {};
  }

  Result<Value> readEntry(const std::string& path) {
    if (++entries_ > mostEntries) {
      return failure(fmt::format("the table has more than {} entries", mostEntries));
    }
    return read(-1, path);
  }

  lua_State* lua_;
  std::vector<const void*> open_;
  std::size_t entries_ = 0;
};

/// The whole number that a field's name writes, as `fmt` would write it.
bool isWholeNumber(const std::string& name, lua_Integer& number) {
  if (name.empty() || name.size() > 18 || (name.front() == '0' && name.size() > 1)) {
    return false;
  }
  const std::size_t first = name.front() == '-' ? 1 : 0;
  if (first == name.size() || !std::all_of(name.begin() + static_cast<std::ptrdiff_t>(first), name.end(),
                                           [](char c) { return c >= '0' && c <= '9'; })) {
    return false;
  }
  number = std::stoll(name);
  return true;
}

}  // namespace

void pushValue(lua_State* lua, const Value& value) {
  luaL_checkstack(lua, 4, "a table is nested too deeply");
  if (const auto boolean = value.boolean()) {
    lua_pushboolean(lua, *boolean ? 1 : 0);
  } else if (const auto number = value.number()) {
    lua_pushnumber(lua, *number);
  } else if (const std::string* text = value.string()) {
    lua_pushlstring(lua, text->data(), text->size());
  } else if (const Table* table = value.table()) {
    lua_createtable(lua, static_cast<int>(table->list.size()), static_cast<int>(table->fields.size()));
    lua_Integer place = 0;
    for (const Value& item : table->list) {
      pushValue(lua, item);
      lua_rawseti(lua, -2, ++place);
    }
    for (const auto& [name, item] : table->fields) {
      lua_Integer key = 0;
      if (isWholeNumber(name, key)) {
        pushValue(lua, item);
        lua_rawseti(lua, -2, key);
      } else {
        lua_pushlstring(lua, name.data(), name.size());
        pushValue(lua, item);
        lua_rawset(lua, -3);
      }
    }
  } else {
    lua_pushnil(lua);
  }
}

Result<Value> toValue(lua_State* lua, int index) {
  return Reader(lua).read(index, {});
}

std::string callerPlace(lua_State* lua) {
  return placeFrom(lua, 1);
}

}  // namespace meridian::scripting
