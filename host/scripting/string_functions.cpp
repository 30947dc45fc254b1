#include "host/scripting/string_functions.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <string>
#include <string_view>

#include <lua.hpp>

#include "host/scripting/lua_pattern.h"
#include "host/scripting/sandbox.h"

namespace meridian::scripting {

namespace {

using Outcome = LuaPattern::Outcome;

std::string_view textAt(lua_State* lua, int index) {
  std::size_t length = 0;
  const char* text = luaL_checklstring(lua, index, &length);
  return {text, length};
}

LuaPattern patternOf(lua_State* lua, Result<LuaPattern> pattern) {
  if (!pattern) {
    luaL_error(lua, "%s", pattern.error().what.c_str());
  }
  return *std::move(pattern);
}

/// What `search` does, paid for by the script.
template <class Search>
Outcome paid(lua_State* lua, Search search) {
  const std::int64_t before = guardOf(lua).instructionsLeft;
  std::int64_t steps = before;
  const Outcome outcome = search(steps);
  charge(lua, outcome == Outcome::OutOfSteps ? std::numeric_limits<std::int64_t>::max() : before - steps);
  return outcome;
}

/// A place from 0 for Lua's from 1, where negative numbers count from the end.
std::size_t placeFromLua(lua_Integer place, std::size_t length) {
  if (place > 0) {
    return static_cast<std::size_t>(place - 1);
  }
  const auto fromEnd = place == 0 ? length : static_cast<std::size_t>(-(place + 1)) + 1;
  return fromEnd >= length ? 0 : length - fromEnd;
}

void pushText(lua_State* lua, std::string_view text) {
  lua_pushlstring(lua, text.data(), text.size());
}

void pushCapture(lua_State* lua, std::string_view text, const LuaPattern::Capture& capture) {
  if (capture.isPosition) {
    lua_pushinteger(lua, static_cast<lua_Integer>(capture.begin) + 1);
  } else {
    pushText(lua, text.substr(capture.begin, capture.length));
  }
}

/// All captures; without any the whole match, if `wholeIfNone`.
int pushCaptures(lua_State* lua, std::string_view text, const LuaPattern::Match& match, bool wholeIfNone) {
  if (match.count == 0 && wholeIfNone) {
    pushText(lua, text.substr(match.begin, match.end - match.begin));
    return 1;
  }
  luaL_checkstack(lua, static_cast<int>(match.count), "too many captures");
  for (std::size_t i = 0; i < match.count; ++i) {
    pushCapture(lua, text, match.captures[i]);
  }
  return static_cast<int>(match.count);
}

/// Text that is no pattern. A step is sixteen characters looked at.
Outcome findPlain(std::string_view text, std::string_view wanted, std::size_t place, std::int64_t& steps,
                  LuaPattern::Match& match) {
  const auto found = [&](std::size_t at) {
    match.begin = at;
    match.end = at + wanted.size();
    return Outcome::Matched;
  };
  if (wanted.empty()) {
    return found(place);
  }
  while (text.size() - place >= wanted.size()) {
    const std::size_t at = text.find(wanted.front(), place);
    if (at == std::string_view::npos || text.size() - at < wanted.size()) {
      return Outcome::None;
    }
    const std::string_view here = text.substr(at, wanted.size());
    const auto differs = std::mismatch(here.begin(), here.end(), wanted.begin()).first;
    if (differs == here.end()) {
      return found(at);
    }
    steps -= 1 + static_cast<std::int64_t>((at - place) + static_cast<std::size_t>(differs - here.begin())) / 16;
    if (steps < 0) {
      return Outcome::OutOfSteps;
    }
    place = at + 1;
  }
  return Outcome::None;
}

/// string.find (whose results begin with the places) and string.match.
int findOrMatch(lua_State* lua, bool find) {
  const std::string_view text = textAt(lua, 1);
  const std::string_view pattern = textAt(lua, 2);
  const std::size_t place = placeFromLua(luaL_optinteger(lua, 3, 1), text.size());
  const bool plain = find && (lua_toboolean(lua, 4) != 0 || pattern.find_first_of("^$*+?.([%-") == pattern.npos);
  if (place > text.size()) {
    lua_pushnil(lua);
    return 1;
  }
  LuaPattern::Match match;
  Outcome outcome = Outcome::None;
  if (plain) {
    outcome = paid(lua, [&](std::int64_t& steps) { return findPlain(text, pattern, place, steps, match); });
  } else {
    const LuaPattern compiled = patternOf(lua, LuaPattern::compile(pattern));
    outcome = paid(lua, [&](std::int64_t& steps) { return compiled.search(text, place, steps, match); });
  }
  if (outcome != Outcome::Matched) {
    lua_pushnil(lua);
    return 1;
  }
  if (!find) {
    return pushCaptures(lua, text, match, true);
  }
  lua_pushinteger(lua, static_cast<lua_Integer>(match.begin) + 1);
  lua_pushinteger(lua, static_cast<lua_Integer>(match.end));
  return 2 + pushCaptures(lua, text, match, false);
}

int find(lua_State* lua) {
  return findOrMatch(lua, true);
}

int match(lua_State* lua) {
  return findOrMatch(lua, false);
}

/// Upvalues: text, pattern, the place to go on from, and where the last match ended (no empty match there).
int nextMatch(lua_State* lua) {
  const std::string_view text = textAt(lua, lua_upvalueindex(1));
  const LuaPattern pattern = patternOf(lua, LuaPattern::compileUnanchored(textAt(lua, lua_upvalueindex(2))));
  auto place = static_cast<std::size_t>(lua_tointeger(lua, lua_upvalueindex(3)));
  const lua_Integer last = lua_tointeger(lua, lua_upvalueindex(4));
  LuaPattern::Match match;
  const Outcome outcome = paid(lua, [&](std::int64_t& steps) {
    for (; place <= text.size(); ++place) {
      const Outcome one = pattern.matchAt(text, place, steps, match);
      if (one == Outcome::OutOfSteps || (one == Outcome::Matched && static_cast<lua_Integer>(match.end) != last)) {
        return one;
      }
    }
    return Outcome::None;
  });
  if (outcome != Outcome::Matched) {
    return 0;
  }
  for (const int upvalue : {3, 4}) {
    lua_pushinteger(lua, static_cast<lua_Integer>(match.end));
    lua_replace(lua, lua_upvalueindex(upvalue));
  }
  return pushCaptures(lua, text, match, true);
}

int gmatch(lua_State* lua) {
  const std::string_view text = textAt(lua, 1);
  (void)patternOf(lua, LuaPattern::compileUnanchored(textAt(lua, 2)));
  const std::size_t place = std::min(placeFromLua(luaL_optinteger(lua, 3, 1), text.size()), text.size() + 1);
  lua_settop(lua, 2);
  lua_pushinteger(lua, static_cast<lua_Integer>(place));
  lua_pushinteger(lua, -1);
  lua_pushcclosure(lua, nextMatch, 4);
  return 1;
}

/// The replacement's text with %0 ... %9 and %% replaced.
void appendReplacement(lua_State* lua, std::string_view text, const LuaPattern::Match& match, std::string& out) {
  const std::string_view replacement = textAt(lua, 3);
  for (std::size_t i = 0; i < replacement.size(); ++i) {
    if (replacement[i] != '%') {
      out += replacement[i];
      continue;
    }
    const char c = ++i < replacement.size() ? replacement[i] : '\0';
    if (c == '%') {
      out += c;
      continue;
    }
    if (std::isdigit(static_cast<unsigned char>(c)) == 0) {
      luaL_error(lua, "invalid use of '%%' in replacement string");
    }
    const auto number = static_cast<std::size_t>(c - '0');
    if (number == 0 || (number == 1 && match.count == 0)) {
      out += text.substr(match.begin, match.end - match.begin);
    } else if (number > match.count) {
      luaL_error(lua, "invalid capture index %%%d in replacement string", static_cast<int>(number));
    } else {
      pushCapture(lua, text, match.captures[number - 1]);
      out += textAt(lua, -1);
      lua_pop(lua, 1);
    }
  }
}

/// What stands in for a match: by text, table or function.
void replace(lua_State* lua, std::string_view text, const LuaPattern::Match& match, std::string& out) {
  switch (lua_type(lua, 3)) {
    case LUA_TFUNCTION: {
      lua_pushvalue(lua, 3);
      lua_call(lua, pushCaptures(lua, text, match, true), 1);
      break;
    }
    case LUA_TTABLE: {
      const int pushed = pushCaptures(lua, text, match, true);
      lua_pop(lua, pushed - 1);
      lua_gettable(lua, 3);
      break;
    }
    default:
      appendReplacement(lua, text, match, out);
      return;
  }
  if (lua_toboolean(lua, -1) == 0) {
    out += text.substr(match.begin, match.end - match.begin);
  } else if (lua_isstring(lua, -1) == 0) {
    luaL_error(lua, "invalid replacement value (a %s)", luaL_typename(lua, -1));
  } else {
    out += textAt(lua, -1);
  }
  lua_pop(lua, 1);
}

int gsub(lua_State* lua) {
  const std::string_view text = textAt(lua, 1);
  const int type = lua_type(lua, 3);
  if (type != LUA_TNUMBER && type != LUA_TSTRING && type != LUA_TTABLE && type != LUA_TFUNCTION) {
    return luaL_argerror(lua, 3, "string, function or table expected");
  }
  const LuaPattern pattern = patternOf(lua, LuaPattern::compile(textAt(lua, 2)));
  const lua_Integer most = luaL_optinteger(lua, 4, std::numeric_limits<lua_Integer>::max());
  std::string out;
  std::size_t place = 0;
  std::size_t last = std::string_view::npos;
  lua_Integer count = 0;
  while (count < most) {
    LuaPattern::Match match;
    const Outcome outcome = paid(lua, [&](std::int64_t& steps) { return pattern.matchAt(text, place, steps, match); });
    if (outcome == Outcome::Matched && match.end != last) {
      ++count;
      replace(lua, text, match, out);
      // `out` lies outside Lua's memory, whose limit it has to keep all the same.
      if (out.size() > guardOf(lua).memoryLimit) {
        return luaL_error(lua, "the resulting string is too large");
      }
      place = last = match.end;
    } else if (place < text.size()) {
      out += text[place++];
    } else {
      break;
    }
    if (pattern.isAnchored()) {
      break;
    }
  }
  out += text.substr(std::min(place, text.size()));
  pushText(lua, out);
  lua_pushinteger(lua, count);
  return 2;
}

}  // namespace

void openStringFunctions(lua_State* lua) {
  static constexpr std::array<luaL_Reg, 4> functions{
      {{"find", find}, {"match", match}, {"gmatch", gmatch}, {"gsub", gsub}}};
  lua_getglobal(lua, LUA_STRLIBNAME);
  for (const luaL_Reg& function : functions) {
    lua_pushcfunction(lua, function.func);
    lua_setfield(lua, -2, function.name);
  }
  lua_pop(lua, 1);
}

}  // namespace meridian::scripting
