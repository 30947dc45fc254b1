#include "host/ui/imgui_panel_builder.h"

#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <imgui.h>

namespace meridian::ui {
namespace {

/// Builds frames of one window without drawing them, with a mouse.
class ImGuiPanelBuilderTest : public ::testing::Test {
 protected:
  ImGuiPanelBuilderTest() : context_(ImGui::CreateContext()) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {800.0F, 600.0F};
    io.DeltaTime = 1.0F / 60.0F;
    unsigned char* pixels = nullptr;
    int width = 0;
    int height = 0;
    io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    io.MousePos = {-1.0F, -1.0F};
  }
  ~ImGuiPanelBuilderTest() override { ImGui::DestroyContext(context_); }

  void frame(const std::function<void(PanelBuilder&)>& build) {
    ImGui::NewFrame();
    ImGui::SetNextWindowPos({0.0F, 0.0F});
    ImGui::SetNextWindowSize({400.0F, 400.0F});
    ImGui::Begin("Test");
    build(builder_);
    // Of the widget built last: where a click goes.
    min_ = ImGui::GetItemRectMin();
    max_ = ImGui::GetItemRectMax();
    ImGui::End();
    ImGui::Render();
  }

  /// Presses and releases the last widget at a share of its width.
  void click(const std::function<void(PanelBuilder&)>& build, float share) {
    frame(build);
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {min_.x + share * (max_.x - min_.x), 0.5F * (min_.y + max_.y)};
    frame(build);
    io.MouseDown[0] = true;
    frame(build);
    io.MouseDown[0] = false;
    frame(build);
  }

  void clickProperty(Property& property, float share) {
    click([&](PanelBuilder& builder) { builder.property(property); }, share);
  }

  ImGuiContext* context_;
  ImGuiPanelBuilder builder_;
  ImVec2 min_{};
  ImVec2 max_{};
};

TEST_F(ImGuiPanelBuilderTest, ABooleanIsACheckBox) {
  BoolProperty property({"Enabled"}, false);
  clickProperty(property, 0.05F);
  EXPECT_TRUE(property.get());
  clickProperty(property, 0.05F);
  EXPECT_FALSE(property.get());
}

TEST_F(ImGuiPanelBuilderTest, ANumberWithARangeIsASlider) {
  FloatProperty property({"Opacity"}, 0.0, {0.0, 1.0});
  clickProperty(property, 0.4F);
  EXPECT_GT(property.get(), 0.2);
  EXPECT_LT(property.get(), 0.9);
}

TEST_F(ImGuiPanelBuilderTest, ATriggerIsAButton) {
  TriggerProperty property({"Reset"});
  int fired = 0;
  property.onChange([&] { ++fired; });
  clickProperty(property, 0.5F);
  EXPECT_EQ(fired, 1);
}

TEST_F(ImGuiPanelBuilderTest, AReadOnlyPropertyCannotBeChanged) {
  BoolProperty property({"Enabled", "Enabled", "", true}, false);
  clickProperty(property, 0.05F);
  EXPECT_FALSE(property.get());
}

TEST_F(ImGuiPanelBuilderTest, AButtonSaysWhenItWasPressed) {
  int pressed = 0;
  click([&](PanelBuilder& builder) { pressed += builder.button("Press") ? 1 : 0; }, 0.5F);
  EXPECT_EQ(pressed, 1);
}

TEST_F(ImGuiPanelBuilderTest, WhatIsCalledTheSameIsToldApartByWhatIsNotShown) {
  int first = 0;
  int second = 0;
  click(
      [&](PanelBuilder& builder) {
        first += builder.button("Add##0") ? 1 : 0;
        second += builder.button("Add##1") ? 1 : 0;
      },
      0.5F);
  EXPECT_EQ(first, 0);
  EXPECT_EQ(second, 1);
}

TEST_F(ImGuiPanelBuilderTest, EveryTypeAndOddContentIsBuilt) {
  IntProperty whole({"Whole"}, 3);
  StringProperty text({"Text"}, "100 %s");
  StringProperty longText({"LongText"}, std::string(5000, 'x'));
  OptionProperty option({"Option"}, {"One", "Two"}, 1);
  Vec2Property two({"Two"}, {1.0, 2.0});
  Vec3Property three({"Three", "", "A tip with a %n"}, {1.0, 2.0, 3.0}, {0.0, 10.0});
  Vec4Property four({"Four"}, {1.0, 2.0, 3.0, 4.0});
  frame([&](PanelBuilder& builder) {
    for (Property* property :
         std::initializer_list<Property*>{&whole, &text, &longText, &option, &two, &three, &four}) {
      builder.property(*property);
    }
    builder.text("50 % of %s");
    builder.warning("%n%n");
    if (builder.beginSection("Section")) {
      builder.endSection();
    }
  });
  EXPECT_EQ(whole.get(), 3);
  EXPECT_EQ(text.get(), "100 %s");
  EXPECT_EQ(three.get(), glm::dvec3(1.0, 2.0, 3.0));
}

}  // namespace
}  // namespace meridian::ui
