#include "host/api/property.h"

#include <memory>

#include <gtest/gtest.h>

#include "host/api/property_owner.h"

namespace meridian {
namespace {

TEST(Property, SetsWhatFitsAndKeepsItsValueOtherwise) {
  FloatProperty opacity({"Opacity"}, 0.5, {0.0, 1.0});
  EXPECT_TRUE(opacity.set(0.25));
  for (const Value& bad : {Value(1.5), Value("x"), Value(), Value(std::numeric_limits<double>::quiet_NaN())}) {
    EXPECT_FALSE(opacity.set(bad)) << bad.toLua();
  }
  EXPECT_EQ(opacity.get(), 0.25);
  opacity.put(7.0);
  EXPECT_EQ(opacity.get(), 1.0);
}

TEST(Property, TellsOnlyOfChanges) {
  BoolProperty enabled({"Enabled"}, true);
  int changes = 0;
  enabled.onChange([&] { ++changes; });
  ASSERT_TRUE(enabled.set(true));
  EXPECT_EQ(changes, 0);
  ASSERT_TRUE(enabled.set(false));
  EXPECT_EQ(changes, 1);
}

TEST(Property, ReadOnlyIsForOthers) {
  IntProperty count({"Count", "", "", true}, 1);
  EXPECT_FALSE(count.set(2));
  count.put(2);
  EXPECT_EQ(count.get(), 2);
}

TEST(Property, RoundsAndLimitsWholeNumbers) {
  IntProperty count({"Count"}, 1, 0, 10);
  EXPECT_TRUE(count.set(2.6));
  EXPECT_EQ(count.get(), 3);
  EXPECT_FALSE(count.set(1e300));
  EXPECT_FALSE(count.set(11));
}

TEST(Property, OptionsTakeWordsAndPlaces) {
  OptionProperty mode({"Mode"}, {"Normal", "Multiply"});
  EXPECT_TRUE(mode.set("Multiply"));
  EXPECT_EQ(mode.value(), Value(1));
  EXPECT_TRUE(mode.set(0));
  EXPECT_EQ(mode.word(), "Normal");
  EXPECT_FALSE(mode.set("Dodge"));
  EXPECT_FALSE(mode.set(2));
}

TEST(Property, VectorsTakeListsOfTheirLength) {
  Vec3Property scale({"Scale"}, glm::dvec3(1.0), {0.0, 10.0});
  EXPECT_TRUE(scale.set(Value(glm::dvec3(1.0, 2.0, 3.0))));
  EXPECT_EQ(scale.get(), glm::dvec3(1.0, 2.0, 3.0));
  EXPECT_FALSE(scale.set(Value(glm::dvec2(1.0, 2.0))));
  EXPECT_FALSE(scale.set(Value(glm::dvec3(1.0, 2.0, 30.0))));
  EXPECT_FALSE(scale.accepts(1.0));
}

TEST(Property, InterpolatesNumbersAndLists) {
  EXPECT_EQ(interpolate(2.0, 4.0, 0.25), Value(2.5));
  EXPECT_EQ(interpolate(Value(glm::dvec2(0.0, 1.0)), Value(glm::dvec2(2.0, 3.0)), 0.5), Value(glm::dvec2(1.0, 2.0)));
  EXPECT_EQ(interpolate("a", "b", 0.5), Value("b"));
  EXPECT_EQ(interpolate(1.0, Value(glm::dvec2(0.0)), 0.5), Value(glm::dvec2(0.0)));
}

TEST(PropertyOwner, KnowsUrisAndPlaces) {
  PropertyOwner root("");
  PropertyOwner scene("Scene");
  PropertyOwner earth("Earth");
  FloatProperty opacity({"Opacity"}, 1.0);
  root.addChild(scene);
  scene.addChild(earth);
  earth.addProperty(opacity);
  EXPECT_EQ(opacity.uri(), "Scene.Earth.Opacity");
  EXPECT_EQ(root.propertyAt("Scene.Earth.Opacity"), &opacity);
  EXPECT_EQ(root.propertyAt("Scene.Earth"), nullptr);
  EXPECT_EQ(root.propertyAt("Scene..Opacity"), nullptr);
  EXPECT_EQ(root.propertyAt(""), nullptr);
  EXPECT_FALSE(opacity.set("x"));
  EXPECT_EQ(opacity.set("x").error().where, "Scene.Earth.Opacity");
}

TEST(PropertyOwner, TellsTheRootOfEveryChangeOfStructure) {
  PropertyOwner root("");
  PropertyOwner scene("Scene");
  root.addChild(scene);
  unsigned version = root.structureVersion();
  const auto changed = [&] { return std::exchange(version, root.structureVersion()) != root.structureVersion(); };
  auto property = std::make_unique<BoolProperty>(Property::Description{"Enabled"}, true);
  scene.addProperty(*property);
  EXPECT_TRUE(changed());
  EXPECT_EQ(scene.structureVersion(), root.structureVersion());
  property->put(false);
  EXPECT_FALSE(changed());
  property.reset();
  EXPECT_TRUE(changed());
  EXPECT_TRUE(scene.properties().empty());
  scene.addTag("planet");
  EXPECT_TRUE(changed());
}

TEST(PropertyOwner, ReordersChildren) {
  PropertyOwner layers("Layers");
  PropertyOwner a("A");
  PropertyOwner b("B");
  PropertyOwner c("C");
  for (PropertyOwner* each : {&a, &b, &c}) {
    layers.addChild(*each);
  }
  layers.moveChild(c, 0);
  EXPECT_EQ(layers.children(), (std::vector<PropertyOwner*>{&c, &a, &b}));
  layers.moveChild(c, 99);
  EXPECT_EQ(layers.children(), (std::vector<PropertyOwner*>{&a, &b, &c}));
}

TEST(PropertyOwner, LetsGoInEitherOrder) {
  auto parent = std::make_unique<PropertyOwner>("Parent");
  auto child = std::make_unique<PropertyOwner>("Child");
  parent->addChild(*child);
  parent.reset();
  EXPECT_EQ(child->parent(), nullptr);
  EXPECT_EQ(child->uri(), "Child");
}

}  // namespace
}  // namespace meridian
