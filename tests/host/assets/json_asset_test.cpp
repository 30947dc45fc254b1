#include "host/assets/json_asset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/assets/json_value.h"
#include "host/scripting/script_engine.h"

namespace meridian::assets {
namespace {

using testing::HasSubstr;

std::string errorOf(std::string_view text) {
  const auto lua = luaFromJsonAsset(text, "a.jasset");
  return lua ? "no error" : lua.error().message();
}

TEST(JsonAsset, MeansTheLuaThatItBecomes) {
  const auto lua = luaFromJsonAsset(R"({
    "version": "1.0",
    "metadata": { "name": "A \"quoted\" name", "asset_version": "2.0", "author": "x" },
    "dependencies": [ "base", "../other/thing", "${ASSETS}/third" ],
    "scenegraphnodes": [
      { "type": "SceneGraphNode", "Identifier": "One", "GUI": { "Hidden": true } },
      { "Identifier": "Two", "Transform": { "Scale": { "Type": "StaticScale", "Scale": 2.5 } } }
    ] })",
                                    "a.jasset");
  ASSERT_TRUE(lua) << lua.error().message();
  scripting::ScriptEngine engine;
  const auto done = engine.run(R"(
    log = {}
    asset = {
      require = function(path) log[#log + 1] = path end,
      export = function(node) log[#log + 1] = 'export ' .. node.Identifier end,
      onInitialize = function(f) begin = f end,
      onDeinitialize = function(f) finish = f end }
    openspace = {
      addSceneGraphNode = function(node) log[#log + 1] = '+' .. node.Identifier end,
      removeSceneGraphNode = function(node) log[#log + 1] = '-' .. node.Identifier end }
  )" + *lua + " begin() finish()",
                               "test");
  ASSERT_TRUE(done) << done.error().message();
  const auto log = engine.evaluate("table.concat(log, ' ') .. ' ' .. asset.meta.Name .. asset.meta.Version", "test");
  ASSERT_TRUE(log);
  EXPECT_EQ(
      log->at(0),
      Value("./base ../other/thing ${ASSETS}/third export One export Two +One +Two -Two -One A \"quoted\" name2.0"));
}

TEST(JsonAsset, SaysWhatIsWrong) {
  EXPECT_THAT(errorOf("{\n \"dependencies\": [\n }"), HasSubstr("a.jasset:3"));
  EXPECT_THAT(errorOf("[]"), HasSubstr("no error")) << "an empty list cannot be told from an empty object";
  EXPECT_THAT(errorOf("[1]"), HasSubstr("object"));
  EXPECT_THAT(errorOf(R"({"dependencies": "base"})"), HasSubstr("dependencies"));
  EXPECT_THAT(errorOf(R"({"dependencies": [5]})"), HasSubstr("expected the path"));
  EXPECT_THAT(errorOf(R"({"scenegraphnodes": [{"Identifier": "A"}, {}]})"), HasSubstr("scenegraphnodes[2]"));
  EXPECT_THAT(errorOf(""), HasSubstr("no JSON"));
}

TEST(JsonValue, KeepsKindsAndRefusesDepth) {
  const auto value = valueFromJson(R"({"a": [1, "x", true, null], "b": {}})", "t");
  ASSERT_TRUE(value);
  EXPECT_EQ(value->find("a")->table()->list.at(1), Value("x"));
  EXPECT_EQ(value->find("a")->table()->list.at(2), Value(true));
  EXPECT_TRUE(value->find("a")->table()->list.at(3).isNil());
  EXPECT_FALSE(valueFromJson(std::string(100'000, '['), "t"));
  EXPECT_FALSE(valueFromJson(std::string(100, '[') + std::string(100, ']'), "t"));
}

}  // namespace
}  // namespace meridian::assets
