#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"
#include "host/api/module.h"
#include "host/api/panel.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"
#include "host/api/statistics.h"
#include "host/app/foreign_settings.h"
#include "host/assets/asset_loader.h"
#include "host/assets/path_tokens.h"
#include "host/navigation/camera.h"
#include "host/navigation/flight.h"
#include "host/navigation/orbit_navigator.h"
#include "host/recording/session_control.h"
#include "host/scene/scene.h"
#include "host/scripting/actions.h"
#include "host/scripting/clock.h"
#include "host/scripting/property_animation.h"
#include "host/scripting/property_index.h"
#include "host/scripting/script_engine.h"

namespace meridian::app {

/// The properties `RenderEngine.*`.
class RenderSettings final : public PropertyOwner {
 public:
  RenderSettings();
  IntProperty antialiasing{
      {"Antialiasing", "Antialiasing", "Samples a pixel: 1 is none; others become what the driver has"}, 1, 1, 4};
  BoolProperty showAttribution{
      {"ShowAttribution", "Show attribution", "Whether the credits of what is seen stand on the picture"}, true};
  BoolProperty verticalSync{{"VerticalSync", "Vertical sync", "Whether frames wait for the screen"}, true};
};

/// Everything of a running program but windows and drawing: the scene with its camera, time, scripts, assets and
/// modules, wired to each other. Render thread only. No OpenGL.
///
/// Property tree: Scene, Camera, Navigation, RenderEngine, Modules.
class Application final : public Host, private assets::AssetTarget {
 public:
  explicit Application(Paths paths);
  ~Application() override;
  Application(const Application&) = delete;
  Application& operator=(const Application&) = delete;

  /// Takes the modules over and initialises them. A module that fails is logged and has no
  /// properties.
  void addModules(std::vector<std::unique_ptr<Module>> modules);
  /// Loads a root asset; see AssetLoader::add.
  Result<void> load(const std::string& asset);
  /// Takes all assets and nodes away again; in time before what draws them goes.
  void unload();

  void registerRenderable(std::string type, RenderableFactory factory) override;
  void registerScriptLibrary(ScriptLibrary library) override;
  void registerPanel(std::unique_ptr<Panel> panel) override;
  [[nodiscard]] const Paths& paths() const override { return paths_; }
  [[nodiscard]] Statistics& statistics() override { return statistics_; }
  [[nodiscard]] Renderable* renderable(std::string_view node) override;
  [[nodiscard]] std::vector<std::string> nodes() const override;
  [[nodiscard]] std::optional<std::filesystem::path> pathToken(std::string_view name) const override;
  [[nodiscard]] ScriptPlace scriptPlace() const override;
  [[nodiscard]] Result<std::filesystem::path> readablePath(std::string_view path) const override;
  [[nodiscard]] Result<std::filesystem::path> writablePath(std::string_view path) const override;
  [[nodiscard]] Result<Value> readLuaData(const std::filesystem::path& file) const override;
  Result<void> addSceneGraphNode(const Value& table) override;
  void noteRegistration(std::string name, std::function<void()> takeBack) override;

  /// The panels registered so far; they are then the caller's.
  [[nodiscard]] std::vector<std::unique_ptr<Panel>> takePanels() { return std::move(panels_); }

  [[nodiscard]] scene::Scene& scene() { return scene_; }
  [[nodiscard]] navigation::Camera& camera() { return camera_; }
  [[nodiscard]] navigation::OrbitNavigator& navigator() { return navigator_; }
  [[nodiscard]] navigation::Flight& flight() { return flight_; }
  [[nodiscard]] recording::SessionControl& recording() { return recording_; }
  [[nodiscard]] scripting::Clock& clock() { return clock_; }
  [[nodiscard]] scripting::ScriptEngine& scripts() { return scripts_; }
  [[nodiscard]] scripting::PropertyIndex& properties() { return properties_; }
  [[nodiscard]] scripting::PropertyAnimation& animation() { return animation_; }
  [[nodiscard]] scripting::Actions& actions() { return actions_; }
  [[nodiscard]] scripting::KeyBindings& keys() { return keys_; }
  /// Upper and lower case are the same.
  [[nodiscard]] bool hasModule(std::string_view name) const;
  [[nodiscard]] assets::AssetLoader& assetLoader() { return assetLoader_; }
  [[nodiscard]] RenderSettings& renderSettings() { return renderSettings_; }
  /// Frame seconds since the program began: what scripts call application time.
  void addSeconds(double seconds) { seconds_ += seconds; }
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  [[nodiscard]] Result<std::filesystem::path> wholePath(std::string_view path) const;
  Result<void> addNode(const Value& table, const std::string& where, const std::string& folder) override;
  Result<void> removeNode(const std::string& identifier) override;
  [[nodiscard]] bool hasNode(const std::string& identifier) const override;
  void registerLibraries();
  [[nodiscard]] ScriptLibrary moduleLibrary() const;
  [[nodiscard]] ScriptLibrary recordingLibrary();

  // In the order of use: what comes later refers to what comes before and goes first.
  Paths paths_;
  Statistics statistics_;
  PropertyOwner root_{""};
  PropertyOwner moduleOwner_{"Modules"};
  ForeignSettings foreignSettings_;
  std::vector<std::unique_ptr<Module>> modules_;
  std::vector<std::unique_ptr<Panel>> panels_;
  scripting::Clock clock_;
  scene::Scene scene_;
  navigation::Camera camera_{scene_};
  navigation::OrbitNavigator navigator_{camera_};
  navigation::Flight flight_{camera_, navigator_};
  RenderSettings renderSettings_;
  scripting::ScriptEngine scripts_;
  recording::SessionControl recording_{camera_, clock_, scripts_};
  scripting::Actions actions_{scripts_};
  scripting::KeyBindings keys_{actions_};
  scripting::PropertyIndex properties_{root_};
  scripting::PropertyAnimation animation_;
  assets::PathTokens tokens_;
  assets::AssetLoader assetLoader_;
  double seconds_ = 0.0;
};

}  // namespace meridian::app
