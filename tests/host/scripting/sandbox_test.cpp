#include <gtest/gtest.h>

#include "host/scripting/script_engine.h"

namespace meridian::scripting {
namespace {

ScriptLimits small() {
  return {std::size_t{32} << 20, 3'000'000};
}

class ForbiddenName : public testing::TestWithParam<const char*> {};

TEST_P(ForbiddenName, IsNotThere) {
  ScriptEngine engine(small());
  const auto value = engine.evaluate(GetParam(), "test");
  ASSERT_TRUE(value) << value.error().message();
  EXPECT_TRUE(value->at(0).isNil());
}

INSTANTIATE_TEST_SUITE_P(Sandbox, ForbiddenName,
                         testing::Values("os", "io", "package", "debug", "require", "dofile", "loadfile",
                                         "collectgarbage", "loadstring", "string.dump", "_G.os", "_G.io",
                                         "getmetatable('').__index.dump"));

struct Endless {
  const char* name;
  const char* text;
};

class EndlessScript : public testing::TestWithParam<Endless> {};

TEST_P(EndlessScript, IsStoppedWithItsPlace) {
  ScriptEngine engine(small());
  const Result<void> result = engine.run(GetParam().text, "loop.lua");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().where.rfind("loop.lua", 0), 0u) << result.error().message();
  // The engine lives on, with fresh limits.
  const Result<void> after = engine.run("for i = 1, 1000 do local x = i end", "after");
  EXPECT_TRUE(after) << after.error().message();
}

INSTANTIATE_TEST_SUITE_P(
    Sandbox, EndlessScript,
    testing::Values(Endless{"while", "while true do end"},
                    Endless{"pcallLoop", "while true do pcall(function() while true do end end) end"},
                    Endless{"nestedPcall", "local function f() pcall(f) while true do end end f()"},
                    Endless{"xpcallHandler",
                            "xpcall(function() while true do end end, function() while true do end end) "
                            "while true do end"},
                    Endless{"coroutine",
                            "while true do local c = coroutine.wrap(function() while true do end end) "
                            "pcall(c) end"},
                    Endless{"manyCoroutines", "while true do coroutine.wrap(function() end)() end"},
                    Endless{"metamethod",
                            "local t = setmetatable({}, {__index = function(t, k) while true do end end}) "
                            "while true do pcall(function() return t.x end) end"},
                    Endless{"close",
                            "do local x <close> = setmetatable({}, {__close = function() while true do end end}) "
                            "end"},
                    Endless{"gsub", "string.gsub(('x'):rep(10), 'x', function() while true do end end)"},
                    Endless{"sort", "table.sort({3, 2, 1}, function(a, b) while true do end end)"},
                    Endless{"lyingLength",
                            "table.insert(setmetatable({}, {__len = function() return 1 << 60 end}), 1, 1)"},
                    Endless{"move", "table.move({}, 1, 1 << 60, 2)"},
                    Endless{"finalizer", "setmetatable({}, {__gc = function() while true do end end})"},
                    Endless{"recursion", "local function f() return 1 + f() end f()"},
                    Endless{"recursionThroughC", "local function f() string.gsub('x', 'x', f) end f()"},
                    Endless{"deepTable", "local s = ('{'):rep(100000) assert(load('return ' .. s))"},
                    Endless{"repBomb", "local s = string.rep('x', 1 << 40)"},
                    Endless{"concatBomb", "local s = 'x' while true do s = s .. s end"},
                    Endless{"tableBomb", "local t = {} for i = 1, 1e9 do t[i] = {} end"}),
    [](const auto& each) { return each.param.name; });

TEST(Sandbox, NamesTheLineOfAnEndlessLoop) {
  ScriptEngine engine(small());
  const Result<void> result = engine.run("local x = 1\nlocal y = 2\nwhile true do x = x + y end", "flight.lua");
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().where, "flight.lua:3");
  EXPECT_NE(result.error().what.find("too long"), std::string::npos);
}

TEST(Sandbox, RefusesBytecode) {
  ScriptEngine engine(small());
  EXPECT_FALSE(engine.run(std::string("\x1bLua\x54\x00", 6), "binary"));
  const auto value = engine.evaluate("load('\\27Lua\\84', 'x', 'b')", "test");
  ASSERT_TRUE(value) << value.error().message();
  EXPECT_TRUE(value->at(0).isNil());
  ASSERT_EQ(value->size(), 2u);
  EXPECT_NE(value->at(1).string()->find("binary"), std::string::npos);
}

TEST(Sandbox, LoadsTextWithAndWithoutAnEnvironment) {
  ScriptEngine engine(small());
  EXPECT_EQ(engine.evaluate("load('return 1 + 1')()", "test")->at(0), Value(2));
  EXPECT_EQ(engine.evaluate("load('return x', 'name', 'bt', {x = 7})()", "test")->at(0), Value(7));
  ASSERT_TRUE(engine.run("local e = {} load('Name = \"CTX\"', 'info', 't', e)() assert(e.Name == 'CTX')", "test"));
}

TEST(Sandbox, FreesTheMemoryOfAScriptThatAskedForTooMuch) {
  ScriptEngine engine(small());
  const Result<void> result = engine.run("local t = {} for i = 1, 1e9 do t[i] = ('x'):rep(1 << 20) .. i end", "greedy");
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().what.find("32 MiB"), std::string::npos) << result.error().message();
  EXPECT_LT(engine.memoryInUse(), std::size_t{2} << 20);
}

TEST(Sandbox, KeepsTheTableFunctionsWorking) {
  ScriptEngine engine(small());
  const Result<void> result = engine.run(
      "local t = {3, 1} table.insert(t, 2) table.insert(t, 1, 9) table.sort(t) assert(table.concat(t, ',') == "
      "'1,2,3,9')"
      "assert(table.remove(t) == 9) table.move(t, 1, 3, 2) assert(#t == 4)"
      "assert(getmetatable(setmetatable({}, {__index = t})).__index == t)",
      "test");
  EXPECT_TRUE(result) << result.error().message();
}

}  // namespace
}  // namespace meridian::scripting
