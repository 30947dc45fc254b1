#include "host/scripting/property_pattern.h"

#include <gtest/gtest.h>

#include "host/api/property.h"
#include "host/api/property_owner.h"
#include "host/scripting/property_index.h"

namespace meridian::scripting {
namespace {

/// Scene.{Earth, Moon, Mars}.Renderable.{Enabled, Opacity}; Earth is tagged planet and home, Moon moon and home, Mars
/// planet; Earth's Renderable is tagged globe.
class PropertyPatternTest : public testing::Test {
 protected:
  struct Renderable : PropertyOwner {
    Renderable() : PropertyOwner("Renderable") {
      addProperty(enabled);
      addProperty(opacity);
    }
    BoolProperty enabled{{"Enabled"}, true};
    FloatProperty opacity{{"Opacity"}, 1.0};
  };
  struct Node : PropertyOwner {
    explicit Node(const char* identifier) : PropertyOwner(identifier) { addChild(renderable); }
    Renderable renderable;
  };
  PropertyPatternTest() {
    root_.addChild(scene_);
    for (Node* node : {&earth_, &moon_, &mars_}) {
      scene_.addChild(*node);
    }
    earth_.addTag("planet");
    earth_.addTag("home");
    moon_.addTag("moon");
    moon_.addTag("home");
    mars_.addTag("planet");
    earth_.renderable.addTag("globe");
  }
  std::string matches(std::string_view text) {
    const Result<PropertyPattern> pattern = PropertyPattern::parse(text);
    if (!pattern) {
      return "error";
    }
    std::string out;
    for (const Property* property : index_.match(*pattern)) {
      const std::string uri = property->uri();
      out += uri.substr(6, 2) + uri.substr(uri.rfind('.') + 1, 1) + ' ';
    }
    return out;
  }

  PropertyOwner root_{""};
  PropertyOwner scene_{"Scene"};
  Node earth_{"Earth"};
  Node moon_{"Moon"};
  Node mars_{"Mars"};
  PropertyIndex index_{root_};
};

TEST_F(PropertyPatternTest, MatchesWhatTheDocumentationMeans) {
  const std::pair<const char*, const char*> cases[] = {
      {"Scene.Earth.Renderable.Opacity", "EaO "},
      {"Scene.Earth.Renderable", ""},
      {"Renderable.Opacity", ""},
      {"scene.earth.renderable.opacity", ""},
      {"Scene.*.Opacity", "EaO MoO MaO "},
      {"Scene.M*.Opacity", "MoO MaO "},
      {"*.Opacity", "EaO MoO MaO "},
      {"*Opacity", "EaO MoO MaO "},
      {"Scene.Earth.*", "EaE EaO "},
      {"Earth.*", ""},
      {"Earth*Opacity", "EaO "},
      {"Scene.*.Opacit", ""},
      {"Scene.*Scene.Earth.Renderable.Opacity", ""},
      {"{planet}.Renderable.Opacity", "EaO MaO "},
      {"{planet}.Opacity", "EaO MaO "},
      {"{planet}.able.Opacity", ""},
      {"{planet&home}.Renderable.Opacity", "EaO "},
      {"{planet|moon}.Renderable.Opacity", "EaO MoO MaO "},
      {"{planet~home}.Renderable.Opacity", "MaO "},
      {"{globe}.Opacity", "EaO "},
      {"{globe&planet}.Opacity", ""},
      {"{home}.*", "EaE EaO MoE MoO "},
      {"{home}.Renderable*", "EaE EaO MoE MoO "},
      {"{home}.Renderable*ity", "EaO MoO "},
      {"{nobody}.Opacity", ""},
      {"{ planet & home }.Opacity", "EaO "},
  };
  for (const auto& [pattern, expected] : cases) {
    EXPECT_EQ(matches(pattern), expected) << pattern;
  }
}

TEST_F(PropertyPatternTest, RefusesWhatMeansNothing) {
  for (const char* pattern :
       {"", "*", "**", "a*b*c", "{planet.Opacity", "{}.Opacity", "{planet}", "{planet}.", "{planet}Opacity",
        "{a&b&c}.Opacity", "{a&b|c}.Opacity", "{a&}.Opacity", "{&b}.Opacity"}) {
    EXPECT_EQ(matches(pattern), "error") << pattern;
  }
}

TEST_F(PropertyPatternTest, TheIndexFollowsTheTree) {
  EXPECT_EQ(index_.entries().size(), 6u);
  EXPECT_EQ(index_.find("Scene.Mars.Renderable.Opacity"), &mars_.renderable.opacity);
  scene_.removeChild(mars_);
  EXPECT_EQ(index_.find("Scene.Mars.Renderable.Opacity"), nullptr);
  scene_.addChild(mars_);
  EXPECT_EQ(index_.find("Scene.Mars.Renderable.Opacity"), &mars_.renderable.opacity);
}

}  // namespace
}  // namespace meridian::scripting
