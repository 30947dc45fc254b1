#include "host/assets/asset_loader.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "host/api/log.h"
#include "host/assets/asset_graph.h"

namespace meridian::assets {

namespace fs = std::filesystem;

namespace {

using Arguments = std::span<const Value>;

Result<std::string> textAt(Arguments arguments, std::size_t i) {
  if (arguments[i].string() == nullptr) {
    return failure(fmt::format("argument {} must be a string", i + 1));
  }
  return *arguments[i].string();
}

/// A node's identifier, or a table that holds it.
Result<std::string> identifierAt(Arguments arguments, std::size_t i) {
  const Value* identifier = arguments[i].isTable() ? arguments[i].find("Identifier") : &arguments[i];
  if (identifier == nullptr || identifier->string() == nullptr) {
    return failure(fmt::format("argument {} must be an identifier or a table with Identifier", i + 1));
  }
  return *identifier->string();
}

ScriptResult nothing() {
  return std::vector<Value>();
}

}  // namespace

struct AssetLoader::Private {
  Private(scripting::ScriptEngine& engine, PathTokens& pathTokens, AssetTarget& assetTarget)
      : graph(engine, pathTokens), target(&assetTarget) {}

  AssetGraph graph;
  AssetTarget* target;

  /// The file of the machine if there is one, else as in asset.require.
  [[nodiscard]] Result<fs::path> rootFile(std::string_view path) const {
    std::error_code error;
    for (const char* extension : {"", ".asset", ".jasset"}) {
      fs::path file = fs::path(path);
      file += extension;
      if (fs::is_regular_file(file, error)) {
        return graph.resolve(fs::absolute(file, error).string(), nullptr);
      }
    }
    Result<fs::path> required = graph.resolve(path, nullptr);
    if (fs::is_directory(path, error) && !(required && fs::is_regular_file(*required, error))) {
      return failure("this is a folder, not an asset", std::string(path), "name an .asset file in it");
    }
    return required;
  }
};

AssetLoader::AssetLoader(scripting::ScriptEngine& engine, PathTokens& tokens, AssetTarget& target)
    : private_(std::make_unique<Private>(engine, tokens, target)) {
  registerNodeFunctions(engine);
  registerAssetFunctions(engine);
}

void AssetLoader::registerNodeFunctions(scripting::ScriptEngine& engine) {
  Private* self = private_.get();
  engine.registerLibrary(
      {"",
       {{"addSceneGraphNode", "table", "Adds a node to the scene.", 1, 1,
         [this, self](Arguments a) -> ScriptResult {
           if (!a[0].isTable()) {
             return failure("argument 1 must be a table");
           }
           return self->target->addNode(a[0], self->graph.engine().place(), currentFolder()).and_then([&] {
             noteNode(a[0]);
             return nothing();
           });
         }},
        {"removeSceneGraphNode", "identifier or table", "Removes a node and those below it.", 1, 1,
         [self](Arguments a) -> ScriptResult {
           return identifierAt(a, 0)
               .and_then([&](const std::string& identifier) { return self->target->removeNode(identifier); })
               .and_then(nothing);
         }},
        {"hasSceneGraphNode", "identifier", "Whether the scene has the node.", 1, 1,
         [self](Arguments a) -> ScriptResult {
           return textAt(a, 0).map(
               [&](const std::string& identifier) { return std::vector<Value>{self->target->hasNode(identifier)}; });
         }}}});
}

/// openspace.asset.parents.
ScriptResult AssetLoader::parents(std::string_view path) const {
  return private_->rootFile(path).map([&](const fs::path& file) {
    const Asset* asset = private_->graph.find(file);
    Table files;
    for (const auto& each : private_->graph.assets()) {
      if (std::find(each->required.begin(), each->required.end(), asset) != each->required.end()) {
        files.list.emplace_back(each->file.string());
      }
    }
    return std::vector<Value>{std::move(files)};
  });
}

void AssetLoader::registerAssetFunctions(scripting::ScriptEngine& engine) {
  Private* self = private_.get();
  // While an asset runs others cannot come and go: that waits for the next frame.
  const auto outsideAssets = [self](std::string_view name, Arguments a, auto act) -> ScriptResult {
    return textAt(a, 0).and_then([&](const std::string& path) -> ScriptResult {
      if (self->graph.running() != nullptr) {
        self->graph.engine().queue(fmt::format("openspace.asset.{}({})", name, Value(path).toLua()));
        return nothing();
      }
      return act(path).and_then(nothing);
    });
  };
  const auto list = [self](bool rootsOnly) -> ScriptResult {
    Table files;
    for (const auto& asset : self->graph.assets()) {
      if (asset->isRoot || !rootsOnly) {
        files.list.emplace_back(asset->file.string());
      }
    }
    return std::vector<Value>{std::move(files)};
  };
  engine.registerLibrary(
      {"asset",
       {{"add", "path", "Loads an asset.", 1, 1,
         [this, outsideAssets](Arguments a) {
           return outsideAssets("add", a, [this](const std::string& path) { return add(path); });
         }},
        {"remove", "path", "Removes an asset.", 1, 1,
         [this, outsideAssets](Arguments a) {
           return outsideAssets("remove", a, [this](const std::string& path) { return remove(path); });
         }},
        {"reload", "path", "Removes an asset and loads it again.", 1, 1,
         [this, outsideAssets](Arguments a) {
           return outsideAssets("reload", a, [this](const std::string& path) {
             return remove(path).and_then([&] { return add(path); });
           });
         }},
        {"removeAll", "", "Removes all assets.", 0, 0,
         [this](Arguments) -> ScriptResult {
           if (runsAsset()) {
             return failure("openspace.asset.removeAll cannot be called by an asset that is being loaded");
           }
           removeAll();
           return std::vector<Value>{};
         }},
        {"parents", "path", "The files of the assets that require an asset.", 1, 1,
         [this](Arguments a) -> ScriptResult {
           return textAt(a, 0).and_then([this](const std::string& path) { return parents(path); });
         }},
        {"isLoaded", "path", "Whether an asset is loaded.", 1, 1,
         [this](Arguments a) -> ScriptResult {
           return textAt(a, 0).map([this](const std::string& path) { return std::vector<Value>{isLoaded(path)}; });
         }},
        {"allAssets", "", "The files of all assets.", 0, 0, [list](Arguments) { return list(false); }},
        {"rootAssets", "", "The files of the assets that were added.", 0, 0,
         [list](Arguments) { return list(true); }}}});
}

AssetLoader::~AssetLoader() = default;

Result<void> AssetLoader::add(std::string_view path) {
  const Result<fs::path> file = private_->rootFile(path);
  if (!file) {
    return tl::make_unexpected(file.error());
  }
  Asset& asset = private_->graph.load(*file, true);
  asset.isRoot = true;
  private_->graph.initialize(asset);
  if (asset.isUnavailable()) {
    log::warning("not available: {}; {}", asset.cause, asset.missing.string());
    return {};
  }
  if (!asset.errors.empty()) {
    return tl::make_unexpected(asset.errors.front());
  }
  return {};
}

Result<void> AssetLoader::remove(std::string_view path) {
  const Result<fs::path> file = private_->rootFile(path);
  Asset* asset = file ? private_->graph.find(*file) : nullptr;
  if (asset == nullptr || !asset->isRoot) {
    return failure("no asset of that name was added", std::string(path));
  }
  asset->isRoot = false;
  private_->graph.sweep();
  return {};
}

void AssetLoader::removeAll() {
  for (const auto& asset : private_->graph.assets()) {
    asset->isRoot = false;
  }
  private_->graph.sweep();
}

std::vector<AssetReport> AssetLoader::reports() const {
  std::vector<AssetReport> reports;
  for (const auto& asset : private_->graph.assets()) {
    reports.push_back(
        {asset->file, private_->graph.nameOf(*asset), asset->errors.empty(), !asset->isUnavailable(), asset->errors});
  }
  return reports;
}

bool AssetLoader::isLoaded(std::string_view path) const {
  const Result<fs::path> file = private_->rootFile(path);
  const Asset* asset = file ? private_->graph.find(*file) : nullptr;
  return asset != nullptr && asset->state == Asset::State::Initialized;
}

void AssetLoader::noteMissing(const fs::path& path) {
  private_->graph.noteMissing(path);
}

void AssetLoader::noteNode(const Value& table) {
  if (const Value* identifier = table.find("Identifier"); identifier != nullptr && identifier->string() != nullptr) {
    noteRegistration("node " + *identifier->string(), [target = private_->target, node = *identifier->string()] {
      if (target->hasNode(node)) {
        if (const Result<void> done = target->removeNode(node); !done) {
          log::error("{}", done.error().message());
        }
      }
    });
  }
}

void AssetLoader::noteRegistration(std::string name, std::function<void()> takeBack) {
  private_->graph.note({std::move(name), std::move(takeBack)});
}

bool AssetLoader::runsAsset() const {
  return private_->graph.running() != nullptr;
}

std::string AssetLoader::currentFolder() const {
  if (const Asset* running = private_->graph.running()) {
    return running->file.parent_path().string();
  }
  const fs::path* assets = private_->graph.tokens().find("ASSETS");
  return assets != nullptr ? assets->string() : std::string();
}

}  // namespace meridian::assets
