#include "host/ui/imgui_panel_builder.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include <imgui.h>

#include "host/api/log.h"

namespace meridian::ui {
namespace {

const ImVec4 warningColour(1.0F, 0.65F, 0.2F, 1.0F);
// A wider range than this cannot be met with a slider's few hundred pixels.
constexpr double widestSlider = 1e4;

bool fitsSlider(const NumberRange& range) {
  return range.maximum - range.minimum <= widestSlider;
}

/// `count` numbers side by side, by slider or by dragging.
bool editNumbers(const char* label, double* numbers, int count, const NumberRange& range) {
  if (fitsSlider(range)) {
    return ImGui::SliderScalarN(label, ImGuiDataType_Double, numbers, count, &range.minimum, &range.maximum, "%.4g");
  }
  const double magnitude = std::max(1.0, std::abs(*std::max_element(numbers, numbers + count, [](double a, double b) {
                                      return std::abs(a) < std::abs(b);
                                    })));
  return ImGui::DragScalarN(label, ImGuiDataType_Double, numbers, count, static_cast<float>(0.005 * magnitude),
                            &range.minimum, &range.maximum, "%.6g");
}

std::optional<Value> edit(BoolProperty& property, const char* label) {
  bool value = property.get();
  return ImGui::Checkbox(label, &value) ? std::optional<Value>(value) : std::nullopt;
}

std::optional<Value> edit(FloatProperty& property, const char* label) {
  double value = property.get();
  return editNumbers(label, &value, 1, property.range()) ? std::optional<Value>(value) : std::nullopt;
}

std::optional<Value> edit(IntProperty& property, const char* label) {
  int value = property.get();
  const bool slider = fitsSlider({static_cast<double>(property.minimum()), static_cast<double>(property.maximum())});
  const bool changed =
      slider ? ImGui::SliderInt(label, &value, property.minimum(), property.maximum()) : ImGui::InputInt(label, &value);
  return changed ? std::optional<Value>(value) : std::nullopt;
}

std::optional<Value> edit(StringProperty& property, const char* label) {
  std::array<char, 1024> text{};
  if (property.get().size() >= text.size()) {
    ImGui::Text("%s: %s", label, property.get().c_str());
    return std::nullopt;
  }
  std::copy(property.get().begin(), property.get().end(), text.begin());
  const bool entered = ImGui::InputText(label, text.data(), text.size(), ImGuiInputTextFlags_EnterReturnsTrue);
  return entered ? std::optional<Value>(text.data()) : std::nullopt;
}

std::optional<Value> edit(OptionProperty& property, const char* label) {
  std::optional<Value> chosen;
  if (ImGui::BeginCombo(label, property.word().c_str())) {
    const auto& words = property.options();
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (ImGui::Selectable(words[i].c_str(), static_cast<int>(i) == property.get())) {
        chosen = static_cast<int>(i);
      }
    }
    ImGui::EndCombo();
  }
  return chosen;
}

std::optional<Value> edit(TriggerProperty& /*property*/, const char* label) {
  return ImGui::Button(label) ? std::optional<Value>(true) : std::nullopt;
}

template <int Count, class Vector>
std::optional<Value> edit(VectorProperty<Vector>& property, const char* label) {
  Vector value = property.get();
  return editNumbers(label, &value[0], Count, property.range()) ? std::optional<Value>(Value(value)) : std::nullopt;
}

std::optional<Value> editAny(Property& property, const char* label) {
  if (auto* boolean = dynamic_cast<BoolProperty*>(&property)) {
    return edit(*boolean, label);
  }
  if (auto* number = dynamic_cast<FloatProperty*>(&property)) {
    return edit(*number, label);
  }
  if (auto* integer = dynamic_cast<IntProperty*>(&property)) {
    return edit(*integer, label);
  }
  if (auto* text = dynamic_cast<StringProperty*>(&property)) {
    return edit(*text, label);
  }
  if (auto* option = dynamic_cast<OptionProperty*>(&property)) {
    return edit(*option, label);
  }
  if (auto* trigger = dynamic_cast<TriggerProperty*>(&property)) {
    return edit(*trigger, label);
  }
  if (auto* vector2 = dynamic_cast<Vec2Property*>(&property)) {
    return edit<2>(*vector2, label);
  }
  if (auto* vector3 = dynamic_cast<Vec3Property*>(&property)) {
    return edit<3>(*vector3, label);
  }
  if (auto* vector4 = dynamic_cast<Vec4Property*>(&property)) {
    return edit<4>(*vector4, label);
  }
  ImGui::TextUnformatted(property.value().toLua().c_str());
  return std::nullopt;
}

}  // namespace

void ImGuiPanelBuilder::text(std::string_view text) {
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
}

void ImGuiPanelBuilder::warning(std::string_view text) {
  ImGui::PushStyleColor(ImGuiCol_Text, warningColour);
  ImGui::PushTextWrapPos(0.0F);
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

void ImGuiPanelBuilder::property(Property& property) {
  ImGui::PushID(&property);
  const std::string& label = property.name();
  if (property.isReadOnly()) {
    ImGui::Text("%s: %s", label.c_str(), property.value().toLua().c_str());
  } else if (const auto value = editAny(property, label.c_str())) {
    if (const auto result = property.set(*value); !result) {
      log::warning("{}", result.error().message());
    }
  }
  if (!property.description().empty() && ImGui::IsItemHovered()) {
    ImGui::SetTooltip("%s", property.description().c_str());
  }
  ImGui::PopID();
}

bool ImGuiPanelBuilder::button(std::string_view label) {
  return ImGui::Button(std::string(label).c_str());
}

bool ImGuiPanelBuilder::beginSection(std::string_view title) {
  return ImGui::TreeNode(std::string(title).c_str());
}

void ImGuiPanelBuilder::endSection() {
  ImGui::TreePop();
}

}  // namespace meridian::ui
