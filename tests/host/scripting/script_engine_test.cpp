#include "host/scripting/script_engine.h"

#include <set>

#include <gtest/gtest.h>
#include <lua.hpp>

namespace meridian::scripting {
namespace {

/// `openspace.test.echo` gives its arguments back, `fail` fails.
ScriptLibrary testLibrary() {
  return {"test",
          {{"echo", "...", "", 0, 8,
            [](std::span<const Value> a) -> ScriptResult { return std::vector<Value>(a.begin(), a.end()); }},
           {"two", "a, b?", "", 1, 2,
            [](std::span<const Value> a) -> ScriptResult { return std::vector<Value>{static_cast<double>(a.size())}; }},
           {"fail", "", "", 0, 0,
            [](std::span<const Value>) -> ScriptResult { return failure("no way", "Scene.Earth", "turn back"); }}}};
}

class ScriptEngineTest : public testing::Test {
 protected:
  ScriptEngineTest() { engine_.registerLibrary(testLibrary()); }
  Error errorOf(const std::string& text) {
    const Result<void> result = engine_.run(text, "a/rather/long/path/that/lua/itself/would/abridge/in/messages/x.lua");
    return result ? Error{"no error", ""} : result.error();
  }
  static constexpr const char* file_ = "a/rather/long/path/that/lua/itself/would/abridge/in/messages/x.lua";
  ScriptEngine engine_;
};

TEST_F(ScriptEngineTest, CarriesValuesBothWays) {
  for (const char* text : {"nil", "true", "1.5", "\"a\\0b\"", "{ 1, 2, { 3 } }", "{ 1, x = { y = \"z\" } }"}) {
    const auto plain = engine_.evaluate(text, "test");
    const auto echoed = engine_.evaluate(std::string("openspace.test.echo(") + text + ", 1)", "test");
    ASSERT_TRUE(plain && echoed) << text;
    EXPECT_EQ(plain->at(0), echoed->at(0)) << text;
  }
  EXPECT_EQ(engine_.evaluate("{ 1, 2, x = true }", "test")->at(0), Value(Table{{1, 2}, {{"x", true}}}));
  EXPECT_EQ(engine_.evaluate("openspace.test.echo({[7] = 'a'})[7]", "test")->at(0), Value("a"));
}

TEST_F(ScriptEngineTest, RefusesWhatNoValueHolds) {
  EXPECT_NE(errorOf("openspace.test.echo({a = {b = print}})").what.find("a.b"), std::string::npos);
  EXPECT_NE(errorOf("local t = {} t.t = t openspace.test.echo(t)").what.find("inside itself"), std::string::npos);
  EXPECT_NE(errorOf("local t = {} for i = 1, 100 do t = {t} end openspace.test.echo(t)").what.find("deeper"),
            std::string::npos);
  EXPECT_NE(errorOf("local t = {} for i = 1, 30 do t = {t, t} end openspace.test.echo(t)").what.find("entries"),
            std::string::npos);
  EXPECT_NE(errorOf("openspace.test.echo({[true] = 1})").what.find("key"), std::string::npos);
}

TEST_F(ScriptEngineTest, ChecksTheNumberOfArguments) {
  EXPECT_EQ(errorOf("\nopenspace.test.two()").what, "two takes 1 to 2 arguments (a, b?), got 0");
  EXPECT_EQ(errorOf("\nopenspace.test.two()").where, std::string(file_) + ":2");
  EXPECT_EQ(errorOf("openspace.test.two(1, 2, 3)").what, "two takes 1 to 2 arguments (a, b?), got 3");
  EXPECT_EQ(engine_.evaluate("openspace.test.two(1, nil, nil)", "test")->at(0), Value(1));
}

TEST_F(ScriptEngineTest, GivesAnErrorBackInItsParts) {
  const Error error = errorOf("\n\nopenspace.test.fail()");
  EXPECT_EQ(error.what, "no way");
  EXPECT_EQ(error.where, std::string(file_) + ":3: Scene.Earth");
  EXPECT_EQ(error.remedy, "turn back");
  EXPECT_EQ(engine_.evaluate("select(2, pcall(openspace.test.fail))", "test")->at(0).string()->find("Scene.Earth"), 8u);
}

TEST_F(ScriptEngineTest, NamesFileAndLineOfEveryKindOfError) {
  for (const char* text : {"\nlocal x = = 1", "\nlocal x = nil + 1", "\nerror('oh')", "\nnothing.at.all()",
                           "\nopenspace.spice.loadKernel('x')", "\nopenspace.noSuchFunction()", "\nerror({})"}) {
    EXPECT_EQ(errorOf(text).where, std::string(file_) + ":2") << text;
  }
  EXPECT_EQ(errorOf("error('oh')").what, "oh");
  EXPECT_EQ(errorOf("openspace.spice.loadKernel('x')").what, "openspace.spice does not exist");
}

TEST_F(ScriptEngineTest, QueuesAndTellsObservers) {
  std::vector<std::string> heard;
  engine_.onQueuedScript([&](std::string_view text) { heard.emplace_back(text); });
  engine_.queue("error('first')", "one");
  engine_.queue("second = 2", "two");
  const std::vector<Error> errors = engine_.runQueued();
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].where, "one:1");
  EXPECT_EQ(heard, (std::vector<std::string>{"error('first')", "second = 2"}));
  EXPECT_EQ(engine_.evaluate("second", "test")->at(0), Value(2));
  EXPECT_FALSE(engine_.hasQueued());
}

TEST_F(ScriptEngineTest, KnowsThePlaceOfTheCaller) {
  std::string place;
  engine_.registerLibrary({"", {{"where", "", "", 0, 0, [&](std::span<const Value>) -> ScriptResult {
                                   place = engine_.place();
                                   return {};
                                 }}}});
  ASSERT_TRUE(engine_.run("\n\n\nopenspace.where()", "there.lua"));
  EXPECT_EQ(place, "there.lua:4");
  EXPECT_EQ(engine_.place(), "");
}

TEST_F(ScriptEngineTest, ReplacesAFunctionOfTheSameName) {
  engine_.registerLibrary({"test", {{"two", "", "", 0, 0, [](std::span<const Value>) -> ScriptResult {
                                       return std::vector<Value>{"new"};
                                     }}}});
  EXPECT_EQ(engine_.evaluate("openspace.test.two()", "test")->at(0), Value("new"));
  EXPECT_EQ(engine_.evaluate("openspace.test.echo(1)", "test")->at(0), Value(1));
}

/// `openspace.late.value(name)` waits until the test gives it.
class WaitingScriptsTest : public ScriptEngineTest {
 protected:
  WaitingScriptsTest() {
    engine_.registerLibrary({"late",
                             {{"value", "name", "", 1, 1,
                               [this](std::span<const Value> a) -> ScriptResult {
                                 if (*a[0].string() == "bad") {
                                   return failure("it never came");
                                 }
                                 return std::vector<Value>{given_.count(*a[0].string()) != 0 ? "given" : "missing"};
                               },
                               [this](std::span<const Value> a) {
                                 ++questions_;
                                 return given_.count(*a[0].string()) == 0;
                               }}}});
  }
  Value global(const std::string& name) { return engine_.evaluate(name, "test")->at(0); }
  std::set<std::string> given_;
  int questions_ = 0;
};

TEST_F(WaitingScriptsTest, AScriptStandsStillUntilItNeedNotWait) {
  ASSERT_TRUE(engine_.run("local own = 3 before = 1 got = openspace.late.value('a') after = own", "x.lua"));
  EXPECT_EQ(global("before"), Value(1));
  EXPECT_EQ(global("after"), Value());
  EXPECT_TRUE(engine_.hasWaiting());
  EXPECT_TRUE(engine_.resumeWaiting().empty());
  EXPECT_EQ(global("after"), Value());
  given_ = {"a"};
  EXPECT_TRUE(engine_.resumeWaiting().empty());
  EXPECT_EQ(global("got"), Value("given"));
  EXPECT_EQ(global("after"), Value(3));
  EXPECT_FALSE(engine_.hasWaiting());
  EXPECT_EQ(questions_, 3);
}

TEST_F(WaitingScriptsTest, OthersGoOnMeanwhileAndAQueuedOneMayWaitAsWell) {
  engine_.queue("openspace.late.value('a') order = (order or '') .. 'a'", "a.lua");
  engine_.queue("order = (order or '') .. 'b'", "b.lua");
  EXPECT_TRUE(engine_.runQueued().empty());
  given_ = {"a"};
  EXPECT_TRUE(engine_.resumeWaiting().empty());
  EXPECT_EQ(global("order"), Value("ba"));
}

TEST_F(WaitingScriptsTest, ItMayWaitOftenAndInsidePcall) {
  ASSERT_TRUE(
      engine_.run("ok, got = pcall(function() return openspace.late.value('a') .. openspace.late.value('b') end)"
                  " done = xpcall(function() openspace.late.value('c') error('x') end, function() seen = 1 end)",
                  "x.lua"));
  for (const char* name : {"a", "b", "c"}) {
    EXPECT_TRUE(engine_.hasWaiting()) << name;
    given_.insert(name);
    EXPECT_TRUE(engine_.resumeWaiting().empty());
  }
  EXPECT_EQ(global("ok"), Value(true));
  EXPECT_EQ(global("got"), Value("givengiven"));
  EXPECT_EQ(global("done"), Value(false));
  EXPECT_EQ(global("seen"), Value(1));
  EXPECT_FALSE(engine_.hasWaiting());
}

TEST_F(WaitingScriptsTest, ErrorsAfterTheWaitHaveTheirPlace) {
  const auto errorAfter = [&](const std::string& text) {
    given_.clear();
    EXPECT_TRUE(engine_.run(text, file_));
    given_ = {"a", "bad"};
    const std::vector<Error> errors = engine_.resumeWaiting();
    return errors.size() == 1 ? errors[0] : Error{"no error", ""};
  };
  EXPECT_EQ(errorAfter("openspace.late.value('a')\nerror('oh')").what, "oh");
  EXPECT_EQ(errorAfter("openspace.late.value('a')\nerror('oh')").where, std::string(file_) + ":2");
  EXPECT_EQ(errorAfter("\n\nopenspace.late.value('bad')").what, "it never came");
  EXPECT_EQ(errorAfter("\n\nopenspace.late.value('bad')").where, std::string(file_) + ":3");
  EXPECT_NE(errorAfter("openspace.late.value('a')\nwhile true do end").what.find("too long"), std::string::npos);
  EXPECT_FALSE(engine_.hasWaiting());
  EXPECT_TRUE(engine_.run("again = 1", "x.lua"));
}

TEST_F(WaitingScriptsTest, WhereItCannotStandStillTheCallComesAtOnce) {
  EXPECT_EQ(global("openspace.late.value('a')"), Value("missing"));
  ASSERT_TRUE(
      engine_.run("table.sort({1, 2}, function(a, b) sorted = openspace.late.value('a') return a < b end)"
                  " own = coroutine.wrap(function() return openspace.late.value('a') end)()",
                  "x.lua"));
  EXPECT_EQ(global("sorted"), Value("missing"));
  EXPECT_EQ(global("own"), Value("missing"));
  EXPECT_FALSE(engine_.hasWaiting());
  engine_.neverWait();
  ASSERT_TRUE(engine_.run("got = openspace.late.value('a')", "x.lua"));
  EXPECT_EQ(global("got"), Value("missing"));
}

TEST_F(WaitingScriptsTest, NobodyElseCanStopOrResumeAScript) {
  EXPECT_NE(errorOf("\ncoroutine.yield(1)").what.find("outside a coroutine"), std::string::npos);
  EXPECT_EQ(errorOf("\ncoroutine.yield(1)").where, std::string(file_) + ":2");
  ASSERT_TRUE(engine_.run("stolen = coroutine.running() got = openspace.late.value('a')", "x.lua"));
  ASSERT_TRUE(engine_.run("coroutine.resume(stolen)", "y.lua"));
  EXPECT_EQ(global("got"), Value("missing"));
  given_ = {"a"};
  EXPECT_TRUE(engine_.resumeWaiting().empty());
  EXPECT_FALSE(engine_.hasWaiting());
  ASSERT_TRUE(engine_.run("stolen = coroutine.running() openspace.late.value('b') never = 1", "x.lua"));
  ASSERT_TRUE(engine_.run("coroutine.close(stolen)", "y.lua"));
  EXPECT_TRUE(engine_.resumeWaiting().empty());
  EXPECT_FALSE(engine_.hasWaiting());
  EXPECT_EQ(global("never"), Value());
}

TEST_F(WaitingScriptsTest, ManyOfThemLeaveNoMemoryBehind) {
  const auto wait = [&](int count) {
    for (int i = 0; i < count; ++i) {
      given_.clear();
      ASSERT_TRUE(engine_.run("openspace.late.value('a')", "x.lua"));
      given_ = {"a"};
      EXPECT_TRUE(engine_.resumeWaiting().empty());
    }
    lua_gc(engine_.state(), LUA_GCCOLLECT);
  };
  wait(100);
  const std::size_t before = engine_.memoryInUse();
  wait(1000);
  EXPECT_LT(engine_.memoryInUse(), before + 10000);
}

}  // namespace
}  // namespace meridian::scripting
