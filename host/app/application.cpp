#include "host/app/application.h"

#include <utility>

#include "host/api/log.h"
#include "host/assets/file_scripts.h"
#include "host/navigation/script_library.h"
#include "host/scripting/property_scripts.h"
#include "host/scripting/time_scripts.h"

namespace meridian::app {

RenderSettings::RenderSettings() : PropertyOwner("RenderEngine", "Render engine") {
  addProperty(antialiasing);
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
  registerLibraries();
  scene_.evaluate(clock_.time());
}

Application::~Application() {
  unload();
}

void Application::registerLibraries() {
  scripts_.registerLibrary(scripting::propertyLibrary(root_, properties_, animation_));
  scripts_.registerLibrary(scripting::logLibrary());
  scripts_.registerLibrary(scripting::timeLibrary(clock_, [this] { return seconds_; }));
  scripts_.registerLibrary(assets::fileLibrary(tokens_, [this] { return assetLoader_.currentFolder(); }));
  scripts_.registerLibrary(navigation::navigationLibrary(camera_, navigator_));
  scripts_.registerLibrary({"globebrowsing", navigation::geoFunctions(camera_, navigator_)});
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

Result<void> Application::addNode(const Value& table, const std::string& where, const std::string& folder) {
  const auto node = scene_.addNode(table, where, folder);
  if (!node) {
    return tl::make_unexpected(node.error());
  }
  if (const Renderable* renderable = (*node)->renderable()) {
    const Renderable::Contents contents = renderable->contents();
    counts_.globes += contents.globes;
    counts_.layers += contents.layers;
    counts_.usableLayers += contents.usableLayers;
    counts_.unusable.insert(counts_.unusable.end(), contents.unusable.begin(), contents.unusable.end());
  }
  return {};
}

Result<void> Application::removeNode(const std::string& identifier) {
  return scene_.removeNode(identifier);
}

bool Application::hasNode(const std::string& identifier) const {
  return scene_.node(identifier) != nullptr;
}

}  // namespace meridian::app
