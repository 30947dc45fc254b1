#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"
#include "host/assets/path_tokens.h"
#include "host/scripting/script_engine.h"

namespace meridian::assets {

/// One `.asset` file that was reached. References are to values in Lua's registry.
struct Asset {
  enum class State { Loading, Loaded, Initializing, Initialized, Failed };

  std::filesystem::path file;
  State state = State::Loading;
  bool isRoot = false;
  std::vector<Error> errors;
  std::vector<Asset*> required;
  int table = 0;    ///< `asset`
  int exports = 0;  ///< what asset.require gives
  std::vector<int> onInitialize;
  std::vector<int> onDeinitialize;
};

/// The assets, who requires whom, and the order in which they come and go.
class AssetGraph {
 public:
  AssetGraph(scripting::ScriptEngine& engine, PathTokens& tokens) : engine_(&engine), tokens_(&tokens) {}
  AssetGraph(const AssetGraph&) = delete;
  AssetGraph& operator=(const AssetGraph&) = delete;

  [[nodiscard]] scripting::ScriptEngine& engine() const { return *engine_; }
  [[nodiscard]] const PathTokens& tokens() const { return *tokens_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Asset>>& assets() const { return assets_; }
  [[nodiscard]] const Asset* running() const { return running_.empty() ? nullptr : running_.back(); }

  /// The file that a path in asset.require means; `from` is null for what no asset requires.
  [[nodiscard]] Result<std::filesystem::path> resolve(std::string_view path, const Asset* from) const;
  [[nodiscard]] Asset* find(const std::filesystem::path& file) const;

  /// Runs the file unless it was run before. Its state says how that went.
  Asset& load(const std::filesystem::path& file, bool enabled);
  /// Initialises what it requires, then itself. False when something failed, now or earlier.
  bool initialize(Asset& asset);
  /// What asset.require does: loads, and joins the two. Errors: a circle, a failure.
  Result<Asset*> require(Asset& parent, std::string_view path, bool enabled);

  /// Deinitialises and forgets all that no root needs any more, those who require before the required.
  void sweep();

  /// asset.meta.Name.
  [[nodiscard]] std::string nameOf(const Asset& asset) const;

 private:
  void fail(Asset& asset, Error error);
  Result<void> runFile(Asset& asset, bool enabled);
  Result<void> callFunction(Asset& asset, int reference);
  void forget(Asset& asset);

  scripting::ScriptEngine* engine_;
  PathTokens* tokens_;
  std::vector<std::unique_ptr<Asset>> assets_;  ///< in the order of loading
  std::map<std::filesystem::path, Asset*> byFile_;
  std::vector<Asset*> initialized_;  ///< in that order
  std::vector<Asset*> running_;      ///< whose code runs, the outermost first
};

}  // namespace meridian::assets
