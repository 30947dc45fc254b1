#include "host/assets/asset_graph.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <lua.hpp>

#include "host/api/log.h"
#include "host/assets/asset_table.h"
#include "host/assets/json_asset.h"

namespace meridian::assets {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t largestAsset = std::uintmax_t{16} << 20;

/// With the extension of an asset unless it has it: ".asset", or ".jasset" if only that is there.
fs::path withExtension(const fs::path& path) {
  if (isAssetFile(path)) {
    return path;
  }
  std::error_code ignored;
  fs::path lua = path;
  lua += ".asset";
  fs::path json = path;
  json += ".jasset";
  if (fs::is_regular_file(lua, ignored)) {
    return lua;
  }
  if (fs::is_regular_file(json, ignored)) {
    return json;
  }
  return path.has_extension() ? path : lua;
}

/// How the error of an asset begins whose fault another one is.
constexpr std::string_view requirementFailed = "the required asset ";

Result<std::string> readAsset(const fs::path& file) {
  std::error_code error;
  if (fs::is_directory(file, error)) {
    return failure("this is a folder, not an asset", file.string(), "name an .asset file in it");
  }
  if (!fs::is_regular_file(file, error)) {
    return failure("no such asset", file.string(), "check the path");
  }
  if (fs::file_size(file, error) > largestAsset) {
    return failure(fmt::format("the asset is larger than {} MiB", largestAsset >> 20), file.string());
  }
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) {
    return failure("the asset cannot be read", file.string(), "check its permissions");
  }
  return text.str();
}

/// While an asset's code runs it is the current one.
class Running {
 public:
  Running(std::vector<Asset*>& stack, Asset& asset) : stack_(stack) { stack_.push_back(&asset); }
  ~Running() { stack_.pop_back(); }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

 private:
  std::vector<Asset*>& stack_;
};

}  // namespace

bool isAssetFile(const fs::path& path) {
  return path.extension() == ".asset" || path.extension() == ".jasset";
}

Result<fs::path> AssetGraph::resolve(std::string_view path, const Asset* from) const {
  if (path.empty() || path.find('\0') != std::string_view::npos) {
    return failure("the path of an asset is empty or holds a zero");
  }
  const bool besideAsset = path.starts_with("./") || path.starts_with("../");
  Result<fs::path> expanded = tokens_->expand(path);
  if (!expanded) {
    return expanded;
  }
  fs::path whole = *expanded;
  if (!whole.is_absolute()) {
    const fs::path* assets = tokens_->find("ASSETS");
    std::error_code ignored;
    whole = besideAsset && from != nullptr ? from->file.parent_path() / whole
            : assets != nullptr            ? *assets / whole
                                           : fs::absolute(whole, ignored);
  }
  const fs::path file = withExtension(whole.lexically_normal());
  std::error_code error;
  fs::path real = fs::weakly_canonical(file, error);
  return error ? file : real;
}

Asset* AssetGraph::find(const fs::path& file) const {
  const auto found = byFile_.find(file);
  return found == byFile_.end() ? nullptr : found->second;
}

Asset* AssetGraph::find(std::uint64_t id) const {
  const auto found = std::lower_bound(assets_.begin(), assets_.end(), id,
                                      [](const auto& asset, std::uint64_t sought) { return asset->id < sought; });
  return found == assets_.end() || (*found)->id != id ? nullptr : found->get();
}

Asset& AssetGraph::load(const fs::path& file, bool enabled) {
  if (Asset* known = find(file)) {
    return *known;
  }
  Asset& asset = *assets_.emplace_back(std::make_unique<Asset>());
  asset.id = ++lastId_;
  asset.file = file;
  byFile_.emplace(file, &asset);
  if (Result<void> done = runFile(asset, enabled); !done) {
    fail(asset, std::move(done.error()));
  } else {
    asset.state = Asset::State::Loaded;
  }
  return asset;
}

Result<void> AssetGraph::runFile(Asset& asset, bool enabled) {
  const Result<std::string> text = readAsset(asset.file);
  if (!text) {
    return tl::make_unexpected(text.error());
  }
  tokens_->allowReading(asset.file.parent_path());
  lua_State* lua = engine_->state();
  makeAssetTable(lua, *this, asset, enabled);
  const Running running(running_, asset);
  const Result<std::string> script =
      asset.file.extension() == ".jasset" ? luaFromJsonAsset(*text, asset.file.string()) : text;
  if (!script) {
    return tl::make_unexpected(script.error());
  }
  if (Result<void> loaded = engine_->load(*script, asset.file.string()); !loaded) {
    return loaded;
  }
  setGlobals(lua, asset);
  return engine_->call(0, 0);
}

Result<Asset*> AssetGraph::require(Asset& parent, std::string_view path, bool enabled) {
  const Result<fs::path> file = resolve(path, &parent);
  if (!file) {
    return tl::make_unexpected(file.error());
  }
  if (const Asset* known = find(*file);
      known != nullptr && (known->state == Asset::State::Loading || known->state == Asset::State::Initializing)) {
    std::string circle;
    for (auto link = std::find(running_.begin(), running_.end(), known); link != running_.end(); ++link) {
      circle += (*link)->file.filename().string() + " -> ";
    }
    return failure("assets require each other in a circle: " + circle + known->file.filename().string());
  }
  Asset& asset = load(*file, enabled);
  const bool late = parent.state != Asset::State::Loading;
  if (late) {
    initialize(asset);
  }
  if (!accept(parent, asset)) {
    return failure(fmt::format("{}\"{}\" failed: {}", requirementFailed, path, asset.cause));
  }
  if (std::find(parent.required.begin(), parent.required.end(), &asset) == parent.required.end()) {
    parent.required.push_back(&asset);
  }
  return &asset;
}

bool AssetGraph::initialize(Asset& asset) {
  if (asset.state != Asset::State::Loaded) {
    return asset.state == Asset::State::Initialized;
  }
  asset.state = Asset::State::Initializing;
  // By index: onInitialize may require more.
  for (std::size_t i = 0; i < asset.required.size(); ++i) {
    Asset& each = *asset.required[i];
    initialize(each);
    if (!accept(asset, each)) {
      fail(asset, {fmt::format("{}\"{}\" failed: {}", requirementFailed, each.file.string(), each.cause),
                   asset.file.string()});
      return false;
    }
  }
  for (std::size_t i = 0; i < asset.onInitialize.size(); ++i) {
    if (Result<void> done = startFunction(asset, asset.onInitialize[i]); !done) {
      fail(asset, std::move(done.error()));
      return false;
    }
  }
  asset.state = Asset::State::Initialized;
  initialized_.push_back(&asset);
  return true;
}

Result<void> AssetGraph::startFunction(Asset& asset, int reference) {
  const Running running(running_, asset);
  lua_rawgeti(engine_->state(), LUA_REGISTRYINDEX, reference);
  // What waits counts as done: other assets need not wait as well. An asset that is gone by then has nothing to go on.
  return engine_->start(0, [this, id = asset.id](const std::function<void()>& part) {
    if (Asset* const still = find(id); still != nullptr && still->state == Asset::State::Initialized) {
      const Running again(running_, *still);
      part();
    }
  });
}

Result<void> AssetGraph::callFunction(Asset& asset, int reference) {
  const Running running(running_, asset);
  lua_rawgeti(engine_->state(), LUA_REGISTRYINDEX, reference);
  return engine_->call(0, 0);
}

bool AssetGraph::accept(Asset& asset, const Asset& required) {
  if (required.state != Asset::State::Failed) {
    return true;
  }
  if (required.isUnavailable()) {
    asset.missing = asset.missing.empty() ? required.missing : asset.missing;
    return true;
  }
  asset.causeOfOthers = required.cause;
  return false;
}

void AssetGraph::noteMissing(const fs::path& path) {
  if (!running_.empty() && running_.back()->missing.empty()) {
    running_.back()->missing = path;
  }
}

void AssetGraph::note(Registration registration) {
  // Whoever had one of that name has lost it.
  for (const auto& asset : assets_) {
    std::erase_if(asset->registrations, [&](const Registration& each) { return each.name == registration.name; });
  }
  if (!running_.empty()) {
    running_.back()->registrations.push_back(std::move(registration));
  }
}

void AssetGraph::fail(Asset& asset, Error error) {
  asset.state = Asset::State::Failed;
  // The first cause goes on to those that require this one, rather than a chain that grows with each of them.
  asset.cause = error.what.starts_with(requirementFailed) ? asset.causeOfOthers : error.message();
  asset.errors.push_back(std::move(error));
}

void AssetGraph::sweep() {
  std::set<const Asset*> needed;
  std::vector<Asset*> open;
  for (const auto& asset : assets_) {
    if (asset->isRoot) {
      open.push_back(asset.get());
    }
  }
  while (!open.empty()) {
    Asset* asset = open.back();
    open.pop_back();
    if (needed.insert(asset).second) {
      open.insert(open.end(), asset->required.begin(), asset->required.end());
    }
  }
  const std::vector<Asset*> order(initialized_.rbegin(), initialized_.rend());
  for (Asset* asset : order) {
    if (needed.count(asset) == 0) {
      deinitialize(*asset);
    }
  }
  for (const auto& asset : assets_) {
    if (needed.count(asset.get()) == 0 && asset->state != Asset::State::Initialized) {
      takeBack(*asset);
    }
  }
  std::erase_if(initialized_, [&](const Asset* asset) { return needed.count(asset) == 0; });
  std::erase_if(assets_, [&](const std::unique_ptr<Asset>& asset) {
    if (needed.count(asset.get()) != 0) {
      return false;
    }
    forget(*asset);
    return true;
  });
}

void AssetGraph::deinitialize(Asset& asset) {
  // A copy: they may add to it.
  const std::vector<int> functions(asset.onDeinitialize.rbegin(), asset.onDeinitialize.rend());
  for (const int function : functions) {
    if (const Result<void> done = callFunction(asset, function); !done) {
      log::error("{}", done.error().message());
    }
  }
}

/// Its onDeinitialize cannot do that: it would stop at the first thing that was never added, or take away one of the
/// same name that is another asset's and in whose way this one failed.
void AssetGraph::takeBack(Asset& asset) {
  for (auto last = asset.registrations.rbegin(); last != asset.registrations.rend(); ++last) {
    last->takeBack();
  }
  asset.registrations.clear();
}

void AssetGraph::forget(Asset& asset) {
  lua_State* lua = engine_->state();
  // Functions that other assets kept may still call `asset`: its table goes, so that they get an error and no ghost.
  // Those of its own functions that were copied out of it look for the asset and get one, too.
  if (asset.table != 0) {
    lua_rawgeti(lua, LUA_REGISTRYINDEX, asset.table);
    lua_pushnil(lua);
    while (lua_next(lua, -2) != 0) {
      lua_pop(lua, 1);
      lua_pushvalue(lua, -1);
      lua_pushnil(lua);
      lua_rawset(lua, -4);
    }
    lua_pop(lua, 1);
  }
  for (const int reference : {asset.table, asset.exports}) {
    luaL_unref(lua, LUA_REGISTRYINDEX, reference == 0 ? LUA_NOREF : reference);
  }
  for (const auto* references : {&asset.onInitialize, &asset.onDeinitialize}) {
    for (const int reference : *references) {
      luaL_unref(lua, LUA_REGISTRYINDEX, reference);
    }
  }
  byFile_.erase(asset.file);
}

std::string AssetGraph::nameOf(const Asset& asset) const {
  std::string name;
  if (asset.table == 0) {
    return name;
  }
  lua_State* lua = engine_->state();
  lua_rawgeti(lua, LUA_REGISTRYINDEX, asset.table);
  lua_pushliteral(lua, "meta");
  if (lua_rawget(lua, -2) == LUA_TTABLE) {
    lua_pushliteral(lua, "Name");
    if (lua_rawget(lua, -2) == LUA_TSTRING) {
      name = lua_tostring(lua, -1);
    }
    lua_pop(lua, 1);
  }
  lua_pop(lua, 2);
  return name;
}

}  // namespace meridian::assets
