// Lua's own string library is the judge: the same calls in a plain Lua state and in ours.
#include "host/scripting/lua_pattern.h"

#include <array>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <lua.hpp>

#include "host/scripting/script_engine.h"

namespace meridian::scripting {
namespace {

/// What a chunk returns, as text; "error" whatever the error.
class PlainLua {
 public:
  PlainLua() : lua_(luaL_newstate()) { luaL_openlibs(lua_); }
  ~PlainLua() { lua_close(lua_); }
  PlainLua(const PlainLua&) = delete;
  PlainLua& operator=(const PlainLua&) = delete;
  std::string answer(const std::string& chunk) {
    const bool failed = luaL_dostring(lua_, chunk.c_str()) != LUA_OK;
    std::size_t length = 0;
    const char* characters = lua_tolstring(lua_, -1, &length);
    const std::string text = failed ? "error" : std::string(characters, length);
    lua_settop(lua_, 0);
    return text;
  }

 private:
  lua_State* lua_;
};

std::string ourAnswer(ScriptEngine& engine, const std::string& chunk) {
  const auto values = engine.evaluate("(function() " + chunk + " end)()", "test");
  return values && !values->empty() && values->front().string() != nullptr ? *values->front().string() : "error";
}

/// A chunk that returns all results of a call as one text.
std::string shown(const std::string& call) {
  return "local r = table.pack(" + call +
         ") local t = {} for i = 1, r.n do t[i] = tostring(r[i]) end return table.concat(t, '|')";
}
std::string collected(const std::string& arguments) {
  return "local t = {} for a, b in string.gmatch(" + arguments +
         ") do t[#t + 1] = tostring(a) .. ':' .. tostring(b) end return table.concat(t, '|')";
}

std::vector<std::string> chunks() {
  std::vector<std::string> all;
  for (const char* call : {"string.find('hello world', 'o w')",
                           "string.find('hello', 'l+')",
                           "string.find('hello', '')",
                           "string.find('hello', '', 6)",
                           "string.find('hello', '', 7)",
                           "string.find('a.b', '.', 1, true)",
                           "string.find('a.b', '.b', -2, true)",
                           "string.find('hello', 'xyz', 1, true)",
                           "string.find('aaab', 'aab')",
                           "string.find('hello', '(l)(l)')",
                           "string.find('hello', '()ll()')",
                           "string.find('abc', '^b')",
                           "string.find('abc', '^a')",
                           "string.find('abc', 'c$')",
                           "string.find('a$c', 'a$c')",
                           "string.find('abc', 'b', -1)",
                           "string.find('abc', 'b', -100)",
                           "string.match('key = value', '(%w+)%s*=%s*(%w+)')",
                           "string.match('2026-11-25', '(%d+)-(%d+)-(%d+)')",
                           "string.match('  trim  ', '^%s*(.-)%s*$')",
                           "string.match('THE (quick) fox', '%((%a+)%)')",
                           "string.match('f(a(b)c)d', '%b()')",
                           "string.match('THE (quick) fox', '%f[%a]%a+%f[%A]', 5)",
                           "string.match('\"it\\'s\"', '([\"\\'])(.-)%1')",
                           "string.match('x]y', '[]]')",
                           "string.match('x]y', '[^]]+')",
                           "string.match('a-z', '[a-]+')",
                           "string.match('a-z', '[%a-]+')",
                           "string.match('abc', '[a-b]*')",
                           "string.match('aXb', '%u')",
                           "string.match('abc123', '%D*')",
                           "string.match('abc', '((a)(b)(c))')",
                           "string.match('abc', 'a?b?x?c?')",
                           "string.match('\\0a\\0', '%z?a')",
                           "string.match('abc', '.-')",
                           "string.match('abc', '.-$')",
                           "string.match('deadbeef!', '%x+')",
                           "string.match('a.b', 'a%.b')",
                           "string.match('abc', '()')",
                           "string.gsub('hello world', 'o', '0')",
                           "string.gsub('hello world', 'o', '0', 1)",
                           "string.gsub('hello world', '', '-')",
                           "string.gsub('hello', 'l*', 'x')",
                           "string.gsub('abc', '%w', '%0%0')",
                           "string.gsub('abc', '(%w)(%w)', '%2%1')",
                           "string.gsub('abc', '%w', '%%')",
                           "string.gsub('abc', '^a', 'x')",
                           "string.gsub('abc abc', '%w+', {abc = 'x'})",
                           "string.gsub('abc abd', '%w+', {abc = false})",
                           "string.gsub('abc', '()', '%1')",
                           "string.gsub('abc', '%w', function(c) return c:upper() end)",
                           "string.gsub('abc', '%w', function(c) end)",
                           "string.gsub('abc', '%w', function(c) return {} end)",
                           "string.gsub('abc', 'b', '%9')",
                           "string.gsub('abc', 'b', '%')",
                           "string.gsub('abc', 'b', true)",
                           "string.gsub('abc', 'b', 5)",
                           "string.gsub(' a  b ', '%s+', ' ')",
                           "string.gsub('abc', '.', {a = 1, b = true})",
                           "string.find('a', '[a')",
                           "string.find('a', '%')",
                           "string.find('a', '(a')",
                           "string.find('a', 'a)')",
                           "string.find('a', '%1')",
                           "string.find('a', '%f')",
                           "string.find('(a', '%b')",
                           "string.find('a', '(%1)')",
                           "string.find('a', '[a-')",
                           "string.rep('x', 3):find('x', 2)",
                           "('x,y,z'):gsub(',', ';')"}) {
    all.push_back(shown(call));
  }
  for (const char* arguments : {"'one two  three', '%a+'", "'k=v, a=b', '(%w+)=(%w+)'", "'abc', ''", "'abc', 'x*'",
                                "'aXbX', '()X'", "'^a^a', '^a'", "'abc', '.', 2", "'abc', '.', -1", "'abc', '.', 9"}) {
    all.push_back(collected(arguments));
  }
  return all;
}

TEST(LuaPattern, AnswersAsLuaDoes) {
  PlainLua plain;
  ScriptEngine engine;
  for (const std::string& chunk : chunks()) {
    EXPECT_EQ(ourAnswer(engine, chunk), plain.answer(chunk)) << chunk;
  }
}

/// Patterns put together at random from well-formed parts, over texts of few letters, so that most things match.
TEST(LuaPattern, AnswersAsLuaDoesToRandomPatterns) {
  std::mt19937 random(20261125);
  const auto pick = [&](auto&& list) { return std::string(*(std::begin(list) + random() % std::size(list))); };
  const std::array classes{"a", "b", ".", "%a", "%d", "[ab]", "[^a]", "[a-c1]", "%s", "%W", "%.", "[%d_]"};
  const std::array repeats{"", "", "", "*", "+", "-", "?"};
  const std::array letters{"a", "b", "c", "1", " ", "(", ")", "."};
  const std::array specials{"%b()", "%f[%a]", "()", "%1"};
  const std::array replacements{"'<%0>'", "'%1'", "{a = 'x', ab = 'y'}", "function(c) return c .. '!' end"};
  PlainLua plain;
  ScriptEngine engine;
  for (int round = 0; round < 4000; ++round) {
    std::string text;
    for (auto left = random() % 12; left > 0; --left) {
      text += pick(letters);
    }
    std::string pattern = random() % 5 == 0 ? "^" : "";
    bool hasCapture = false;
    for (auto left = 1 + random() % 4; left > 0; --left) {
      const auto kind = random() % 8;
      const std::string one = pick(classes) + pick(repeats);
      if (kind == 0) {
        const std::string special = pick(specials);
        hasCapture = hasCapture || special == "()";
        pattern += special == "%1" && !hasCapture ? one : special;
      } else if (kind < 3) {
        pattern += '(' + one + pick(classes) + pick(repeats) + ')';
        hasCapture = true;
      } else {
        pattern += one;
      }
    }
    pattern += random() % 5 == 0 ? "$" : "";
    const std::string arguments = "'" + text + "', '" + pattern + "'";
    for (const std::string& chunk :
         {shown("string.find(" + arguments + ")"), shown("string.match(" + arguments + ", 2)"), collected(arguments),
          shown("string.gsub(" + arguments + ", " + pick(replacements) + ")")}) {
      ASSERT_EQ(ourAnswer(engine, chunk), plain.answer(chunk)) << chunk;
    }
  }
}

TEST(LuaPattern, RefusesWhatItsDepthCannotHold) {
  std::string many;
  for (int i = 0; i < 300; ++i) {
    many += "a?";
  }
  EXPECT_FALSE(LuaPattern::compile(many));
  EXPECT_TRUE(LuaPattern::compile(std::string(10'000, 'a')));
}

TEST(LuaPattern, GivesUpWhenStepsRunOut) {
  const auto pattern = LuaPattern::compile("a*a*a*a*b");
  ASSERT_TRUE(pattern);
  LuaPattern::Match match;
  std::int64_t steps = 100'000;
  EXPECT_EQ(pattern->search(std::string(500, 'a'), 0, steps, match), LuaPattern::Outcome::OutOfSteps);
  EXPECT_LT(steps, 0);
}

class EndlessPattern : public testing::TestWithParam<const char*> {};

TEST_P(EndlessPattern, IsStopped) {
  ScriptEngine engine({std::size_t{64} << 20, 3'000'000});
  const Result<void> result = engine.run(GetParam(), "loop.lua");
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message().find("ran for too long"), std::string::npos) << result.error().message();
  EXPECT_TRUE(engine.run("local x = ('abc'):match('b')", "after"));
}

INSTANTIATE_TEST_SUITE_P(
    LuaPattern, EndlessPattern,
    testing::Values("local s = ('a'):rep(1e5) s:find('.-.-.-.-b')", "local s = ('a'):rep(1e5) s:match('a*a*a*a*b')",
                    "for _ in (('a'):rep(1e5)):gmatch('a*a*a*a*b') do end",
                    "local s = (('a'):rep(1e5)):gsub('a*a*a*a*b', '')", "local s = ('('):rep(1e6) s:find('%b()x')",
                    "local s = ('a'):rep(1e6) s:find(('a'):rep(5e5) .. 'b', 1, true)",
                    "pcall(function() local s = ('a'):rep(1e5) s:find('.-.-.-.-b') end) while true do end"));

}  // namespace
}  // namespace meridian::scripting
