#include "host/ui/caption.h"

#include <algorithm>
#include <span>

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "host/api/log.h"
#include "host/graphics/default_state.h"

namespace meridian::ui {
namespace {

constexpr float fontPixels = 13.0F;  // of ImGui's own font
constexpr int pictureRows = 1080;    // up to twice as many, the font is drawn as it is
constexpr float margin = 3.0F;       // in pixels of that font
constexpr ImU32 ground = IM_COL32(0, 0, 0, 110);
constexpr ImU32 letters = IM_COL32(235, 235, 235, 230);

/// Makes a context of ImGui the current one, and then the former.
class Current {
 public:
  explicit Current(ImGuiContext* context) : former_(ImGui::GetCurrentContext()) { ImGui::SetCurrentContext(context); }
  ~Current() { ImGui::SetCurrentContext(former_); }
  Current(const Current&) = delete;
  Current& operator=(const Current&) = delete;

 private:
  ImGuiContext* former_;
};

}  // namespace

/// A context of its own: that of the panels belongs to a window and its input.
class Caption::Painter {
 public:
  Painter() {
    ImGuiContext* const former = ImGui::GetCurrentContext();
    context_ = ImGui::CreateContext();
    ImGui::SetCurrentContext(former);
    const Current current(context_);
    ImGui::GetIO().IniFilename = nullptr;
    drawing_ = ImGui_ImplOpenGL3_Init("#version 450 core");
    if (!drawing_) {
      log::error("credits cannot be drawn onto pictures with this OpenGL context");
    }
  }
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;
  ~Painter() {
    {
      const Current current(context_);
      if (drawing_) {
        ImGui_ImplOpenGL3_Shutdown();
      }
    }
    ImGui::DestroyContext(context_);
  }

  void draw(const graphics::RenderTarget& target, std::string_view text) {
    if (!drawing_) {
      return;
    }
    const Current current(context_);
    const glm::ivec2 size = target.size();
    ImGui::GetIO().DisplaySize = {static_cast<float>(size.x), static_cast<float>(size.y)};
    ImGui_ImplOpenGL3_NewFrame();
    ImGui::NewFrame();
    lay(*ImGui::GetForegroundDrawList(), text, size);
    ImGui::Render();
    target.bind();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    graphics::applyDefaultState();
  }

 private:
  static void lay(ImDrawList& list, std::string_view text, glm::ivec2 size) {
    const ImFont& font = *ImGui::GetFont();
    const auto scale = static_cast<float>(std::max(1, size.y / pictureRows));
    const float border = margin * scale;
    const float width = std::max(static_cast<float>(size.x) - 2.0F * border, 1.0F);
    // Where lines end.
    std::string_view lines[mostLines];
    int count = 0;
    while (!text.empty() && count < mostLines) {
      const char* const end = text.data() + text.size();
      const char* stop = font.CalcWordWrapPositionA(scale, text.data(), end, width);
      stop = std::max(stop, text.data() + 1);  // a picture may be narrower than a letter
      lines[count++] = text.substr(0, static_cast<std::size_t>(stop - text.data()));
      text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
      text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    }
    const float lineHeight = fontPixels * scale;
    float top = static_cast<float>(size.y) - static_cast<float>(count) * lineHeight - border;
    for (const std::string_view line : std::span(lines, static_cast<std::size_t>(count))) {
      const char* const end = line.data() + line.size();
      const float right = border + font.CalcTextSizeA(lineHeight, width, 0.0F, line.data(), end).x + border;
      list.AddRectFilled({0.0F, top}, {right, top + lineHeight}, ground);
      list.AddText(&font, lineHeight, {border, top}, letters, line.data(), end);
      top += lineHeight;
    }
  }

  ImGuiContext* context_ = nullptr;
  bool drawing_ = false;
};

Caption::Caption() = default;
Caption::~Caption() = default;

void Caption::draw(const graphics::RenderTarget& target, std::string_view text) {
  if (text.empty()) {
    return;
  }
  if (painter_ == nullptr) {
    painter_ = std::make_unique<Painter>();
  }
  painter_->draw(target, text);
}

}  // namespace meridian::ui
