#include "host/scripting/script_engine.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace meridian::scripting
