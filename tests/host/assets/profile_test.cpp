#include "host/assets/profile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/assets/validate.h"
#include "temporary_folder.h"

namespace meridian::assets {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ProfileTest : public testing::Test {
 protected:
  /// All errors of a profile with that text beside its version.
  std::string errorsOf(const std::string& rest) {
    const auto file = folder_.write("p.profile", R"({ "version": { "major": 1, "minor": 5 })" + rest + "}");
    const auto profile = readProfile(file);
    std::string text;
    for (const Error& error : profile ? std::vector<Error>() : profile.error()) {
      text += error.message() + '\n';
    }
    return text;
  }
  TemporaryFolder folder_;
};

TEST_F(ProfileTest, ReadsEveryKey) {
  folder_.write("profiles/addons/more.addon", R"({ "version": { "major": 1, "minor": 0 }, "identifier": "more",
    "name": "More", "description": "", "assets": [ "scene/more" ] })");
  const auto file = folder_.write("profiles/trips/p.profile", R"json({
    "version": { "major": 1, "minor": 5 },
    "meta": { "name": "Trip", "version": "1.0", "description": "", "author": "", "url": "", "license": "" },
    "assets": [ "base", "scene/earth" ],
    "addons": { "recommended": [ "addons/more" ], "custom": [ { "version": { "major": 1, "minor": 0 },
                "identifier": "x", "name": "X", "description": "", "assets": [ "scene/x" ] } ] },
    "camera": { "type": "setNavigationState", "anchor": "Earth", "aim": "", "frame": "Root",
                "position": { "x": 1, "y": 2.5, "z": -3e8 }, "up": { "x": 0, "y": 0, "z": 1 }, "yaw": 0.5 },
    "time": { "type": "relative", "value": "-1d", "is_paused": true },
    "delta_times": [ 1, 60, 3600 ],
    "mark_nodes": [ "Earth", "Moon" ],
    "properties": [ { "type": "setPropertyValue", "name": "*.Fade", "value": "0.5" },
                    { "type": "setPropertyValueSingle", "name": "A.B", "value": "{1, 2}" } ],
    "actions": [ { "identifier": "a", "name": "A", "documentation": "", "gui_path": "/", "is_local": true,
                   "script": "print(1)"
} ],
    "keybindings": [ { "key": "Ctrl+A", "action": "a" } ],
    "modules": [ { "name": "Space", "loadedInstruction": "x()", "notLoadedInstruction": "y()" } ],
    "additional_scripts": [ "one()", "two()" ],
    "panel_visibility": {
  "time" : false
}
})json");
  const auto read = readProfile(file);
  ASSERT_TRUE(read) << read.error().front().message();
  const Profile& profile = *read;
  EXPECT_EQ(profile.name, "Trip");
  EXPECT_THAT(profile.assets, ElementsAre("base", "scene/earth", "scene/more", "scene/x"));
  const auto& state = std::get<Profile::SetNavigationState>(profile.camera);
  EXPECT_EQ(state.position, glm::dvec3(1, 2.5, -3e8));
  EXPECT_EQ(state.up, glm::dvec3(0, 0, 1));
  EXPECT_EQ(state.frame, "Root");
  EXPECT_EQ(state.yaw, 0.5);
  EXPECT_TRUE(profile.time->relative);
  EXPECT_TRUE(profile.time->paused);
  EXPECT_THAT(profile.deltaTimes, ElementsAre(1, 60, 3600));
  EXPECT_THAT(profile.markedNodes, ElementsAre("Earth", "Moon"));
  EXPECT_TRUE(profile.properties.at(1).single);
  EXPECT_EQ(profile.properties.at(1).value, "{1, 2}");
  EXPECT_EQ(profile.actions.at(0).script, "print(1)");
  EXPECT_TRUE(profile.actions.at(0).isLocal);
  EXPECT_EQ(profile.keyBindings.at(0).action, "a");
  EXPECT_EQ(profile.modules.at(0).notLoaded, "y()");
  EXPECT_EQ(profile.additionalScripts.size(), 2U);
}

TEST_F(ProfileTest, ReadsOlderKeyBindings) {
  const auto file = folder_.write("p.profile", R"json({ "version": { "major": 1, "minor": 0 },
    "keybindings": [ { "key": "T", "name": "N", "documentation": "", "gui_path": "/", "is_local": false,
                       "script": "print(2)" } ], "ui_panel_visibility": {
  "scene" : true
}
})json");
  const auto profile = readProfile(file);
  ASSERT_TRUE(profile) << profile.error().front().message();
  EXPECT_EQ(profile->actions.at(0).script, "print(2)");
  EXPECT_EQ(profile->keyBindings.at(0).action, profile->actions.at(0).identifier);
}

TEST_F(ProfileTest, NamesFileAndKeyOfEveryMistake) {
  const std::pair<const char*, const char*> cases[] = {
      {R"(, "asets": [])", "unknown key asets; did you mean assets?"},
      {R"(, "assets": "base")", ": assets"},
      {R"(, "assets": [ 4 ])", "assets[1]"},
      {R"(, "camera": { "type": "fly" })", "camera.type"},
      {R"(, "camera": { "type": "goToGeo", "anchor": "E", "latitude": "north", "longitude": 1 })", "camera.latitude"},
      {R"(, "camera": { "type": "goToGeo", "anchor": "E", "latitude": 91, "longitude": 1 })", "camera.latitude"},
      {R"(, "camera": { "type": "goToNode", "anchor": "E", "hight": 4 })", "camera.hight"},
      {R"(, "camera": { "type": "setNavigationState", "anchor": "E", "position": { "x": 1, "y": 2 } })",
       "camera.position.z"},
      {R"(, "time": { "type": "later", "value": "1d" })", "time.type"},
      {R"(, "time": { "type": "relative", "value": "1d", "paused": true })", "time.paused"},
      {R"(, "delta_times": [ 1, "2" ])", "delta_times"},
      {R"(, "properties": [ { "type": "setPropertyValue", "name": "a", "value": 5 } ])", "properties[1].value"},
      {R"(, "actions": [ { "identifier": "a", "scripts": "" } ])", "actions[1].scripts"},
      {R"(, "keybindings": [ { "key": "A" } ])", "keybindings[1].action"},
      {R"(, "modules": [ { "name": "x", "loaded": "" } ])", "modules[1].loaded"},
      {R"(, "meta": { "title": "x" })", "meta.title"},
      {R"(, "panel_visibility": { "time": 3 })", "panel_visibility.time"},
      {R"(, "addons": { "recommended": [ "nowhere" ] })", "nowhere.addon"},
  };
  for (const auto& [rest, expected] : cases) {
    EXPECT_THAT(errorsOf(rest), HasSubstr(expected)) << rest;
    EXPECT_THAT(errorsOf(rest), HasSubstr("p.profile")) << rest;
  }
  EXPECT_EQ(errorsOf(""), "");
  const std::string two = errorsOf(R"(, "wrong": 1, "assets": 2)");
  EXPECT_THAT(two, HasSubstr("unknown key wrong"));
  EXPECT_THAT(two, HasSubstr("assets"));
  const auto future = readProfile(folder_.write("f.profile", R"({ "version": { "major": 2, "minor": 0 } })"));
  ASSERT_FALSE(future);
  EXPECT_THAT(future.error().front().message(), HasSubstr("version.major"));
  EXPECT_FALSE(readProfile(folder_.write("g.profile", "{ \"version\": ")));
  EXPECT_FALSE(readProfile(folder_.path() / "missing.profile"));
  EXPECT_FALSE(readProfile(folder_.path()));
}

TEST_F(ProfileTest, AssetsLieBesideTheProfiles) {
  const auto file = folder_.write("data/profiles/trips/p.profile", "{}");
  folder_.write("data/assets/a.asset", "");
  EXPECT_EQ(assetsFolder(file, "/elsewhere"), folder_.path() / "data/assets");
}

}  // namespace
}  // namespace meridian::assets
