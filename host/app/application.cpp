#include "host/app/application.h"

#include <algorithm>
#include <cctype>
#include <utility>

#include "host/api/log.h"
#include "host/assets/file_scripts.h"
#include "host/navigation/flight_scripts.h"
#include "host/navigation/placing_scripts.h"
#include "host/navigation/script_library.h"
#include "host/recording/recording_scripts.h"
#include "host/scene/scene_scripts.h"
#include "host/scripting/foreign_scripts.h"
#include "host/scripting/lua_data.h"
#include "host/scripting/property_scripts.h"
#include "host/scripting/time_scripts.h"

namespace meridian::app {

RenderSettings::RenderSettings() : PropertyOwner("RenderEngine", "Render engine") {
  addProperty(antialiasing);
  addProperty(showAttribution);
  addProperty(verticalSync);
}

Application::Application(Paths paths)
    : paths_(std::move(paths)),
      clock_(Time::now()),
      animation_(properties_, [this](std::string script) { scripts_.queue(std::move(script)); }),
      tokens_(paths_),
      assetLoader_(scripts_, tokens_, *this) {
  root_.addChild(scene_);
  root_.addChild(camera_);
  root_.addChild(navigator_);
  root_.addChild(renderSettings_);
  root_.addChild(moduleOwner_);
  root_.addChild(foreignSettings_.dashboard);
  moduleOwner_.addChild(foreignSettings_.webGui);
  moduleOwner_.addChild(foreignSettings_.exoplanets);
  registerLibraries();
  scene_.setEye([this](const scene::SceneNode& node) {
    return camera_.poseIn(node).position / scene_.worldFromNode(node).scale;
  });
  scene_.evaluate(clock_.time());
}

Application::~Application() {
  unload();
}

void Application::registerLibraries() {
  // First, so that what is ours takes the place of what is not.
  for (const ScriptLibrary& library : scripting::foreignLibraries()) {
    scripts_.registerLibrary(library);
  }
  const NoteRegistration note = [this](std::string name, std::function<void()> takeBack) {
    noteRegistration(std::move(name), std::move(takeBack));
  };
  scripts_.registerLibrary(scripting::actionLibrary(actions_, note));
  scripts_.registerLibrary(scripting::keyLibrary(keys_, note));
  scripts_.registerLibrary(scene::sceneLibrary(scene_));
  scripts_.registerLibrary(moduleLibrary());
  scripts_.registerLibrary(scripting::propertyLibrary(root_, properties_, animation_));
  scripts_.registerLibrary(scripting::logLibrary());
  scripts_.registerLibrary(scripting::timeLibrary(clock_, [this] { return seconds_; }));
  const auto folder = [this] { return assetLoader_.currentFolder(); };
  const auto missing = [this](const std::filesystem::path& path) { assetLoader_.noteMissing(path); };
  scripts_.registerLibrary(assets::fileLibrary(tokens_, folder, missing));
  scripts_.registerLibrary(assets::orbitLibrary(tokens_, folder, missing));
  scripts_.registerLibrary(recordingLibrary());
  scripts_.registerLibrary(navigation::navigationLibrary(camera_, navigator_));
  scripts_.registerLibrary(navigation::flightLibrary(camera_, navigator_, flight_));
  scripts_.registerLibrary(navigation::pathLibrary(camera_, navigator_, flight_));
  scripts_.registerLibrary({"globebrowsing", navigation::geoFunctions(camera_, navigator_)});
  scripts_.registerLibrary({"globebrowsing", navigation::placingFunctions(scene_, camera_, navigator_)});
  // Up to version 0.20 flights over globes were there as well.
  ScriptLibrary flights = navigation::flightLibrary(camera_, navigator_, flight_);
  flights.name = "globebrowsing";
  std::erase_if(flights.functions, [](const ScriptFunction& each) { return !each.name.starts_with("flyToGeo"); });
  scripts_.registerLibrary(flights);
}

/// What assets ask before they use a module.
ScriptLibrary Application::moduleLibrary() const {
  return {"modules",
          {{"isLoaded", "name", "Whether the program has the module.", 1, 1,
            [this](std::span<const Value> a) -> ScriptResult {
              if (a[0].string() == nullptr) {
                return failure("argument 1 must be the name of a module");
              }
              return std::vector<Value>{hasModule(*a[0].string())};
            }}}};
}

ScriptLibrary Application::recordingLibrary() {
  const auto whole = [this](std::string_view path) {
    return tokens_.expand(path).map([this](const std::filesystem::path& expanded) {
      return expanded.is_absolute() ? expanded : *tokens_.find("RECORDINGS") / expanded;
    });
  };
  const auto readable = [this](const std::filesystem::path& path) { return tokens_.readable(path); };
  const auto writable = [this](const std::filesystem::path& path) { return tokens_.writable(path); };
  return recording::recordingLibrary(
      recording_, {[whole, readable](std::string_view path) { return whole(path).and_then(readable); },
                   [whole, writable](std::string_view path) { return whole(path).and_then(writable); },
                   paths_.temporary / "session.osrectxt"});
}

bool Application::hasModule(std::string_view name) const {
  return std::any_of(modules_.begin(), modules_.end(), [name](const auto& module) {
    const std::string& own = module->identifier();
    return std::equal(own.begin(), own.end(), name.begin(), name.end(),
                      [](unsigned char a, unsigned char b) { return std::tolower(a) == std::tolower(b); });
  });
}

void Application::addModules(std::vector<std::unique_ptr<Module>> modules) {
  for (auto& module : modules) {
    if (const auto initialized = module->initialize(*this); !initialized) {
      log::error("module {}: {}", module->identifier(), initialized.error().message());
    } else {
      moduleOwner_.addChild(*module);
    }
    // A failed one is kept too: what it had registered by then may refer to it.
    modules_.push_back(std::move(module));
  }
}

Result<void> Application::load(const std::string& asset) {
  return assetLoader_.add(asset);
}

void Application::unload() {
  assetLoader_.removeAll();
  // Scripts may have added nodes that no asset knows of.
  while (scene_.nodes().size() > 1) {
    if (const auto removed = scene_.removeNode(scene_.nodes()[1]->identifier()); !removed) {
      log::error("{}", removed.error().message());
      return;
    }
  }
}

void Application::registerRenderable(std::string type, RenderableFactory factory) {
  scene_.registerRenderable(std::move(type), std::move(factory));
}

void Application::registerScriptLibrary(ScriptLibrary library) {
  scripts_.registerLibrary(library);
}

void Application::registerPanel(std::unique_ptr<Panel> panel) {
  panels_.push_back(std::move(panel));
}

Renderable* Application::renderable(std::string_view node) {
  const scene::SceneNode* const found = scene_.node(node);
  return found != nullptr ? found->renderable() : nullptr;
}

std::vector<std::string> Application::nodes() const {
  std::vector<std::string> identifiers;
  identifiers.reserve(scene_.nodes().size());
  for (const auto& node : scene_.nodes()) {
    identifiers.push_back(node->identifier());
  }
  return identifiers;
}

std::optional<std::filesystem::path> Application::pathToken(std::string_view name) const {
  const std::filesystem::path* const folder = tokens_.find(name);
  return folder == nullptr ? std::nullopt : std::optional(*folder);
}

Host::ScriptPlace Application::scriptPlace() const {
  return {scripts_.place(), assetLoader_.currentFolder(), assetLoader_.runsAsset()};
}

Result<std::filesystem::path> Application::wholePath(std::string_view path) const {
  return tokens_.expand(path).map([this](const std::filesystem::path& expanded) {
    return expanded.is_absolute() ? expanded : (assetLoader_.currentFolder() / expanded).lexically_normal();
  });
}

Result<std::filesystem::path> Application::readablePath(std::string_view path) const {
  return wholePath(path).and_then([this](const std::filesystem::path& whole) { return tokens_.readable(whole); });
}

Result<std::filesystem::path> Application::writablePath(std::string_view path) const {
  return wholePath(path).and_then([this](const std::filesystem::path& whole) { return tokens_.writable(whole); });
}

Result<Value> Application::readLuaData(const std::filesystem::path& file) const {
  return scripting::readLuaData(file);
}

Result<void> Application::addSceneGraphNode(const Value& table) {
  const ScriptPlace place = scriptPlace();
  return addNode(table, place.where, place.folder).map([&] { assetLoader_.noteNode(table); });
}

void Application::noteRegistration(std::string name, std::function<void()> takeBack) {
  assetLoader_.noteRegistration(std::move(name), std::move(takeBack));
}

Result<void> Application::addNode(const Value& table, const std::string& where, const std::string& folder) {
  return scene_.addNode(table, where, folder).map([](const scene::SceneNode*) {});
}

Result<void> Application::removeNode(const std::string& identifier) {
  return scene_.removeNode(identifier);
}

bool Application::hasNode(const std::string& identifier) const {
  return scene_.node(identifier) != nullptr;
}

}  // namespace meridian::app
