#include "host/scripting/actions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "host/scripting/foreign_scripts.h"

namespace meridian::scripting {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class ActionsTest : public testing::Test {
 protected:
  ActionsTest() {
    const NoteRegistration note = [this](std::string name, std::function<void()> takeBack) {
      registrations_[std::move(name)] = std::move(takeBack);
    };
    engine_.registerLibrary(actionLibrary(actions_, note));
    engine_.registerLibrary(keyLibrary(keys_, note));
    engine_.registerLibrary({"", {{"note", "text", "", 1, 1, [this](std::span<const Value> a) -> ScriptResult {
                                     notes_ += a[0].toLua() + ' ';
                                     return {};
                                   }}}});
  }
  std::string run(const std::string& text) {
    const auto done = engine_.run(text, "test.lua");
    return done ? "" : done.error().message();
  }

  ScriptEngine engine_;
  Actions actions_{engine_};
  KeyBindings keys_{actions_};
  std::map<std::string, std::function<void()>> registrations_;
  std::string notes_;
};

TEST_F(ActionsTest, RunTheirScriptsWithArguments) {
  ASSERT_EQ(run("openspace.action.registerAction({ Identifier = 'a.b', Name = 'N', Command = [[\n"
                "openspace.note(args.x or 'none')]] })"),
            "");
  EXPECT_EQ(run("openspace.action.triggerAction('a.b', { x = 5 }) openspace.action.triggerAction('a.b')"), "");
  EXPECT_EQ(notes_, "") << "they run with the other queued scripts";
  EXPECT_THAT(engine_.runQueued(), IsEmpty());
  EXPECT_EQ(notes_, "5 \"none\" ");
  EXPECT_EQ(engine_.evaluate("openspace.action.hasAction('a.b')", "t")->at(0), Value(true));
  EXPECT_EQ(engine_.evaluate("openspace.action.actions()[1].Name", "t")->at(0), Value("N"));
  EXPECT_EQ(run("openspace.action.removeAction({ Identifier = 'a.b' })"), "");
  EXPECT_THAT(run("openspace.action.triggerAction('a.b')"), HasSubstr("there is no action"));
}

TEST_F(ActionsTest, RefuseWhatIsTakenOrIncomplete) {
  EXPECT_EQ(run("openspace.action.registerAction({ Identifier = 'a', Command = '' })"), "");
  EXPECT_THAT(run("openspace.action.registerAction({ Identifier = 'a', Command = '' })"), HasSubstr("already"));
  EXPECT_THAT(run("openspace.action.registerAction({ Identifier = 'b' })"), HasSubstr("Command"));
  EXPECT_THAT(run("openspace.action.registerAction({ Identifier = 3, Command = '' })"), HasSubstr("Identifier"));
}

TEST_F(ActionsTest, KeysAreTheSameInAnySpelling) {
  ASSERT_EQ(run("openspace.action.registerAction({ Identifier = 'a', Command = 'openspace.note(1)' })"
                "openspace.bindKey('shift+ctrl+h', 'a') openspace.bindKey('Ctrl+Shift+H', 'a')"),
            "");
  EXPECT_THAT(keys_.keysOf("a"), ElementsAre("CTRL+SHIFT+H"));
  EXPECT_TRUE(keys_.press("Ctrl+Shift+H"));
  EXPECT_FALSE(keys_.press("Ctrl+H"));
  EXPECT_THAT(engine_.runQueued(), IsEmpty());
  EXPECT_EQ(notes_, "1 ");
  EXPECT_EQ(run("openspace.clearKey({ 'CTRL+SHIFT+h', 'b' })"), "");
  EXPECT_FALSE(keys_.press("Ctrl+Shift+H"));
  EXPECT_EQ(run("openspace.bindKey('+', 'a') openspace.bindKey('Ctrl++', 'a')"), "") << "plus is a key, too";
  EXPECT_THAT(keys_.keysOf("a"), ElementsAre("+", "CTRL++"));
  EXPECT_EQ(run("openspace.clearKeys()"), "");
  EXPECT_THAT(keys_.keysOf("a"), IsEmpty());
  EXPECT_THAT(run("openspace.bindKey('Hyper+H', 'a')"), HasSubstr("no modifier"));
  EXPECT_THAT(run("openspace.bindKey('', 'a')"), HasSubstr("is no key"));
}

TEST_F(ActionsTest, WhatIsRegisteredCanBeTakenBack) {
  ASSERT_EQ(run("openspace.action.registerAction({ Identifier = 'a', Command = '' })"
                "openspace.bindKey('F5', 'a') openspace.bindKey('F5', 'b')"),
            "");
  EXPECT_NE(run("openspace.action.registerAction({ Identifier = 'a', Command = '' })"), "");
  ASSERT_EQ(registrations_.size(), 3U);
  registrations_.at("key F5 a")();
  EXPECT_THAT(keys_.actionsOf("F5"), ElementsAre("b"));
  for (int i = 0; i < 2; ++i) {  // the second time it is gone, which does no harm
    registrations_.at("action a")();
    EXPECT_EQ(actions_.find("a"), nullptr);
  }
}

TEST_F(ActionsTest, AKeyThatIsBoundAlreadyStaysItsFirstOnes) {
  ASSERT_EQ(run("openspace.bindKey('Ctrl+F5', 'a')"), "");
  registrations_.clear();
  ASSERT_EQ(run("openspace.bindKey('ctrl+f5', 'a')"), "");
  EXPECT_THAT(registrations_, IsEmpty());
}

TEST_F(ActionsTest, AKeyWhoseActionIsGoneDoesNoHarm) {
  ASSERT_EQ(run("openspace.bindKey('x', 'gone')"), "");
  EXPECT_TRUE(keys_.press("x"));
  EXPECT_THAT(engine_.runQueued(), IsEmpty());
}

TEST(ForeignScripts, DoNothingAndGiveNothing) {
  ScriptEngine engine;
  for (const ScriptLibrary& library : foreignLibraries()) {
    engine.registerLibrary(library);
  }
  const auto run = engine.run(
      "openspace.addScreenSpaceRenderable({ Type = 'X' }) openspace.dashboard.addDashboardItem({})\n"
      "for _ in pairs(openspace.exoplanets.systemList()) do error('not empty') end\n"
      "assert(openspace.audio.isPlaying('x') == false)\n"
      "openspace.spice.unloadKernel(openspace.spice.loadKernel('k.tls'))\n"
      "assert(select('#', openspace.spice.position('EARTH', 'SUN', 'GALACTIC', '', '2026 NOV 22')) == 0)\n"
      "openspace.spice.rotationMatrix('EARTH', 'GALACTIC', '2026 NOV 22') openspace.spice.convertTLEtoSPK('a', 'b')\n"
      "openspace.keyframeRecording.newSequence() openspace.keyframeRecording.addCameraKeyframe(1)\n"
      "assert(#openspace.keyframeRecording.keyframes() == 0)",
      "test.lua");
  EXPECT_TRUE(run) << run.error().message();
  EXPECT_FALSE(engine.run("openspace.audio.nonsense()", "test.lua"));
}

}  // namespace
}  // namespace meridian::scripting
