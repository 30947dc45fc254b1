#include "host/ui/user_interface.h"

#include <algorithm>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include "host/graphics/default_state.h"
#include "host/ui/imgui_panel_builder.h"

namespace meridian::ui {
namespace {

class ImGuiInterface final : public UserInterface {
 public:
  ImGuiInterface() : context_(ImGui::CreateContext()) {
    ImGui::GetIO().IniFilename = nullptr;  // no file in whatever folder we were started in
    ImGui::StyleColorsDark();
    ImGui::GetStyle().Colors[ImGuiCol_WindowBg].w = 0.8F;
  }
  ImGuiInterface(const ImGuiInterface&) = delete;
  ImGuiInterface& operator=(const ImGuiInterface&) = delete;
  ~ImGuiInterface() override {
    ImGui::SetCurrentContext(context_);
    if (drawing_) {
      ImGui_ImplOpenGL3_Shutdown();
    }
    if (listening_) {
      ImGui_ImplGlfw_Shutdown();
    }
    ImGui::DestroyContext(context_);
  }

  [[nodiscard]] bool start(GLFWwindow* window) {
    listening_ = ImGui_ImplGlfw_InitForOpenGL(window, true);
    drawing_ = listening_ && ImGui_ImplOpenGL3_Init("#version 450 core");
    return drawing_;
  }

  void add(std::unique_ptr<Panel> panel, Side side) override { panels_.push_back({std::move(panel), side}); }

  void draw() override {
    if (!visible_) {
      return;
    }
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    buildPanels();
    ImGui::Render();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    graphics::applyDefaultState();
  }

  void setVisible(bool visible) override { visible_ = visible; }
  [[nodiscard]] bool isVisible() const override { return visible_; }
  [[nodiscard]] bool hasMouse() const override { return visible_ && ImGui::GetIO().WantCaptureMouse; }
  [[nodiscard]] bool hasKeyboard() const override { return visible_ && ImGui::GetIO().WantTextInput; }

 private:
  void buildPanels() {
    // They start one below the other. How high they are ImGui knows after having built them once or twice.
    const ImGuiCond place = ImGui::GetFrameCount() <= framesToPlace ? ImGuiCond_Always : ImGuiCond_FirstUseEver;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    float tops[] = {margin, margin};
    for (const auto& [panel, side] : panels_) {
      const bool isRight = side == Side::Right;
      float& top = tops[isRight ? 1 : 0];
      ImGui::SetNextWindowPos({isRight ? screen.x - margin : margin, top}, place, {isRight ? 1.0F : 0.0F, 0.0F});
      ImGui::SetNextWindowSizeConstraints({leastWidth, 0.0F}, {10'000.0F, screen.y - 2.0F * margin});
      if (ImGui::Begin(panel->title().c_str(), nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        panel->build(builder_);
      }
      top += ImGui::GetWindowHeight() + margin;
      keepOnScreen(screen);
      ImGui::End();
    }
  }

  /// A panel grows to the right and down when a tree in it is opened: what it holds would end outside the window.
  static void keepOnScreen(const ImVec2& screen) {
    if (!(screen.x > 0.0F) || !(screen.y > 0.0F)) {
      return;  // minimised
    }
    const ImVec2 size = ImGui::GetWindowSize();
    const ImVec2 position = ImGui::GetWindowPos();
    const ImVec2 kept{std::min(position.x, std::max(margin, screen.x - margin - size.x)),
                      std::min(position.y, std::max(margin, screen.y - margin - size.y))};
    if (kept.x != position.x || kept.y != position.y) {
      ImGui::SetWindowPos(kept);
    }
  }

  struct Placed {
    std::unique_ptr<Panel> panel;
    Side side;
  };
  static constexpr float margin = 10.0F;
  static constexpr float leastWidth = 240.0F;
  static constexpr int framesToPlace = 3;

  ImGuiContext* context_;
  bool listening_ = false;
  bool drawing_ = false;
  bool visible_ = true;
  ImGuiPanelBuilder builder_;
  std::vector<Placed> panels_;
};

}  // namespace

Result<std::unique_ptr<UserInterface>> UserInterface::create(GLFWwindow* window) {
  auto interface = std::make_unique<ImGuiInterface>();
  if (!interface->start(window)) {
    return failure("the panels cannot be drawn with this window", {}, "run without panels: --headless");
  }
  return interface;
}

}  // namespace meridian::ui
