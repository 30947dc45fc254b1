#include "host/scripting/property_scripts.h"

#include <gtest/gtest.h>

#include "host/api/property.h"
#include "host/scripting/script_engine.h"

namespace meridian::scripting {
namespace {

class PropertyScriptsTest : public testing::Test {
 protected:
  PropertyScriptsTest() {
    root_.addChild(layer_);
    for (Property* property :
         {static_cast<Property*>(&enabled_), static_cast<Property*>(&opacity_), static_cast<Property*>(&fade_),
          static_cast<Property*>(&mode_), static_cast<Property*>(&reload_), static_cast<Property*>(&size_)}) {
      layer_.addProperty(*property);
    }
    reload_.onChange([this] { ++reloads_; });
    engine_.registerLibrary(propertyLibrary(root_, index_, animation_));
    engine_.registerLibrary(logLibrary());
  }
  void run(const std::string& text) {
    const Result<void> done = engine_.run(text, "test");
    EXPECT_TRUE(done) << done.error().message();
  }

  ScriptEngine engine_;
  PropertyOwner root_{""};
  PropertyOwner layer_{"Layer"};
  BoolProperty enabled_{{"Enabled"}, true};
  FloatProperty opacity_{{"Opacity"}, 1.0, {0.0, 1.0}};
  FloatProperty fade_{{"Fade"}, 1.0, {0.0, 1.0}};
  OptionProperty mode_{{"Mode"}, {"Normal", "Multiply"}};
  TriggerProperty reload_{{"Reload"}};
  FloatProperty size_{{"Size", "", "", true}, 5.0};
  PropertyIndex index_{root_};
  PropertyAnimation animation_{index_, [this](std::string text) { engine_.queue(std::move(text)); }};
  int reloads_ = 0;
};

TEST_F(PropertyScriptsTest, SetsByUriAndByPattern) {
  run("openspace.setPropertyValueSingle('Layer.Opacity', 0.25)");
  EXPECT_EQ(opacity_.get(), 0.25);
  run("openspace.setPropertyValue('Layer.*', false)");
  EXPECT_FALSE(enabled_.get());
  EXPECT_EQ(opacity_.get(), 0.25);
  EXPECT_EQ(reloads_, 0);
  run("openspace.setPropertyValueSingle('Layer.Mode', 'Multiply')");
  EXPECT_EQ(mode_.get(), 1);
  run("openspace.setPropertyValueSingle('Layer.Reload', nil)");
  EXPECT_EQ(reloads_, 1);
}

TEST_F(PropertyScriptsTest, GoesOnAfterWhatCannotBeSet) {
  run("openspace.setPropertyValueSingle('Layer.Opacity', 7) openspace.setPropertyValue('No.Such', 1) "
      "openspace.setPropertyValueSingle('Layer.Size', 1) openspace.setPropertyValueSingle('Layer.Opacity', 'x') "
      "openspace.setPropertyValueSingle('Layer.Opacity', 0.5)");
  EXPECT_EQ(opacity_.get(), 0.5);
  EXPECT_EQ(size_.get(), 5.0);
}

TEST_F(PropertyScriptsTest, RaisesOnMisuse) {
  for (const char* text : {"openspace.setPropertyValue('a*b*c', 1)", "openspace.setPropertyValue('*', 1)",
                           "openspace.setPropertyValue(3, 1)", "openspace.setPropertyValue('Layer.Opacity')",
                           "openspace.setPropertyValue('Layer.Opacity', 1, 1, 'Slow')",
                           "openspace.setPropertyValue('Layer.Opacity', 1, 0/0)",
                           "openspace.setPropertyValueSingle('Layer.*', 1)", "openspace.propertyValue('No.Such')"}) {
    const Result<void> result = engine_.run(text, "test");
    ASSERT_FALSE(result) << text;
    EXPECT_EQ(result.error().where, "test:1") << text;
  }
}

TEST_F(PropertyScriptsTest, ReadsAndLists) {
  run("assert(openspace.propertyValue('Layer.Opacity') == 1 and openspace.getPropertyValue('Layer.Mode') == 0) "
      "assert(openspace.hasProperty('Layer.Mode') and not openspace.hasProperty('Layer')) "
      "assert(#openspace.property('Layer.*') == 6 and openspace.property('*.Fade')[1] == 'Layer.Fade')");
}

TEST_F(PropertyScriptsTest, ListsOwners) {
  PropertyOwner settings("Settings");
  layer_.addChild(settings);
  run("openspace.addTag('Layer', 'map') "
      "local function owners(pattern) return table.concat(openspace.propertyOwner(pattern), ' ') end "
      "assert(owners('Layer') == 'Layer' and owners('Layer.Settings') == 'Layer.Settings') "
      "assert(owners('Layer*') == 'Layer Layer.Settings' and owners('*.Settings') == 'Layer.Settings') "
      "assert(owners('{map}.Settings') == 'Layer.Settings' and owners('{no}.Settings') == '') "
      "assert(owners('Layer.Opacity') == '')");
  EXPECT_FALSE(engine_.run("openspace.propertyOwner('a*b*')", "test"));
}

TEST_F(PropertyScriptsTest, MovesOverTimeAndRunsThePostScript) {
  run("openspace.setPropertyValueSingle('Layer.Opacity', 0, 2, 'QuadraticEaseIn', 'finished = true')");
  animation_.advance(1.0);
  EXPECT_DOUBLE_EQ(opacity_.get(), 0.75);
  animation_.advance(1.0);
  EXPECT_TRUE(engine_.runQueued().empty());
  run("assert(finished)");
}

TEST_F(PropertyScriptsTest, SettingAtOnceEndsAMovement) {
  run("openspace.setPropertyValueSingle('Layer.Opacity', 0, 2) openspace.setPropertyValueSingle('Layer.Opacity', 0.5)");
  animation_.advance(1.0);
  EXPECT_EQ(opacity_.get(), 0.5);
}

TEST_F(PropertyScriptsTest, FadesOutAndInAgain) {
  run("openspace.toggleFade('Layer', 2, 'out = true')");
  animation_.advance(1.0);
  EXPECT_DOUBLE_EQ(fade_.get(), 0.5);
  EXPECT_TRUE(enabled_.get());
  animation_.advance(1.0);
  EXPECT_TRUE(engine_.runQueued().empty());
  EXPECT_FALSE(enabled_.get());
  run("assert(out) openspace.toggleFade('Layer')");
  EXPECT_TRUE(enabled_.get());
  EXPECT_EQ(fade_.get(), 0.0);
  animation_.advance(1.0);
  EXPECT_EQ(fade_.get(), 1.0);
}

TEST_F(PropertyScriptsTest, TagsOwners) {
  run("openspace.addTag('Layer', 'map') openspace.setPropertyValue('{map}.Opacity', 0.5)");
  EXPECT_EQ(opacity_.get(), 0.5);
  run("openspace.removeTag('Layer', 'map')");
  EXPECT_TRUE(layer_.tags().empty());
}

TEST_F(PropertyScriptsTest, TheCommandLineGetsAnError) {
  EXPECT_TRUE(setProperties(index_, animation_, "*.Opacity", 0.1));
  EXPECT_FALSE(setProperties(index_, animation_, "Layer.Opacity", 4.0));
  EXPECT_FALSE(setProperties(index_, animation_, "Layer.Nothing", 4.0));
}

}  // namespace
}  // namespace meridian::scripting
