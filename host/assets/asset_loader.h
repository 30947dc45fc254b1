#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"
#include "host/api/script_library.h"
#include "host/api/value.h"
#include "host/assets/path_tokens.h"
#include "host/scripting/script_engine.h"

namespace meridian::assets {

/// What assets build: the scene.
class AssetTarget {
 public:
  virtual ~AssetTarget() = default;
  /// `where` is "FILE:LINE" of the call; `folder` is what relative paths in the table are relative to.
  virtual Result<void> addNode(const Value& table, const std::string& where, const std::string& folder) = 0;
  virtual Result<void> removeNode(const std::string& identifier) = 0;
  [[nodiscard]] virtual bool hasNode(const std::string& identifier) const = 0;
};

/// How one asset fared.
struct AssetReport {
  std::filesystem::path file;
  std::string name;  ///< of asset.meta; empty without
  bool ok = true;
  bool available = true;  ///< false: it failed for want of data that were not synchronised, which is no error
  std::vector<Error> errors;
};

/// Loads `.asset` and `.jasset` files with what they require, and initialises them, required ones first. An error fails
/// its asset and those that require it; all others go on. Adds `openspace.addSceneGraphNode`, `removeSceneGraphNode`,
/// `hasSceneGraphNode` and `openspace.asset.*` (add, remove, isLoaded, allAssets, rootAssets) to the engine.
///
/// Engine, tokens and target must outlive it. Render thread only.
class AssetLoader {
 public:
  AssetLoader(scripting::ScriptEngine& engine, PathTokens& tokens, AssetTarget& target);
  ~AssetLoader();
  AssetLoader(const AssetLoader&) = delete;
  AssetLoader& operator=(const AssetLoader&) = delete;

  /// Loads and initialises a root asset. `path` is a file of the machine (relative to the working folder), or a path as
  /// in asset.require. Adding it again does nothing. The error is that of the root; reports() has all of them.
  Result<void> add(std::string_view path);
  /// Runs onDeinitialize of a root asset and of what only it required, parents first; forgets them. Of one that failed
  /// what it had registered is taken back instead: nodes, actions, keys, layers, GeoJSON.
  Result<void> remove(std::string_view path);
  void removeAll();

  /// Every asset that was reached, in the order of loading. Assets that failed are in it until they are removed.
  [[nodiscard]] std::vector<AssetReport> reports() const;
  [[nodiscard]] bool isLoaded(std::string_view path) const;

  /// Data below ${SYNC} that the asset whose code runs now would have read are not there. Should it fail, it is not
  /// available, and those that require it go on without it.
  void noteMissing(const std::filesystem::path& path);

  /// The code that runs now added a node by another way than `openspace.addSceneGraphNode`. Should its asset fail, the
  /// node goes with it.
  void noteNode(const Value& table);
  /// Likewise whatever else has a name: see NoteRegistration.
  void noteRegistration(std::string name, std::function<void()> takeBack);

  /// Folder of the asset whose code runs now; ${ASSETS} outside of one.
  [[nodiscard]] std::string currentFolder() const;
  /// Whether an asset's code runs now.
  [[nodiscard]] bool runsAsset() const;

 private:
  struct Private;
  void registerNodeFunctions(scripting::ScriptEngine& engine);
  void registerAssetFunctions(scripting::ScriptEngine& engine);
  [[nodiscard]] ScriptResult parents(std::string_view path) const;
  std::unique_ptr<Private> private_;
};

}  // namespace meridian::assets
