#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"
#include "host/assets/path_tokens.h"
#include "host/scripting/script_engine.h"

namespace meridian::assets {

/// Whether it is called "NAME.asset" (Lua) or "NAME.jasset" (JSON).
[[nodiscard]] bool isAssetFile(const std::filesystem::path& path);

/// What an asset's code registered, by a name of its kind ("node Earth"), and how to take it back if it is still there.
struct Registration {
  std::string name;
  std::function<void()> takeBack;
};

/// One asset's file that was reached. References are to values in Lua's registry.
struct Asset {
  enum class State { Loading, Loaded, Initializing, Initialized, Failed };

  std::uint64_t id = 0;  ///< of this one only: a file that is loaded again gets another
  std::filesystem::path file;
  State state = State::Loading;
  bool isRoot = false;
  std::vector<Error> errors;
  std::string cause;              ///< of the failure, its own or that of the asset that took it along
  std::string causeOfOthers;      ///< of the last one required that failed
  std::filesystem::path missing;  ///< the first data that it, or what it requires, would have read; empty: none
  std::vector<Asset*> required;
  int table = 0;    ///< `asset`
  int exports = 0;  ///< what asset.require gives
  std::vector<int> onInitialize;
  std::vector<int> onDeinitialize;
  std::vector<Registration> registrations;  ///< of its code, in that order

  /// It failed for want of data that were not synchronised. Those that require it go on without.
  [[nodiscard]] bool isUnavailable() const { return state == State::Failed && !missing.empty(); }
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
  /// Null once the asset is forgotten.
  [[nodiscard]] Asset* find(std::uint64_t id) const;

  /// Runs the file unless it was run before. Its state says how that went.
  Asset& load(const std::filesystem::path& file, bool enabled);
  /// Initialises what it requires, then itself. False when something failed, now or earlier.
  bool initialize(Asset& asset);
  /// What asset.require does: loads, and joins the two. Errors: a circle, a failure.
  Result<Asset*> require(Asset& parent, std::string_view path, bool enabled);

  /// Data that the running asset would have read were not synchronised.
  void noteMissing(const std::filesystem::path& path);

  /// The code that runs, of an asset or not, registered something.
  void note(Registration registration);

  /// Deinitialises and forgets all that no root needs any more, those who require before the required. Those that did
  /// not come as far as to be initialised lose what they registered.
  void sweep();

  /// asset.meta.Name.
  [[nodiscard]] std::string nameOf(const Asset& asset) const;

 private:
  void fail(Asset& asset, Error error);
  /// Whether the one can go on: the other is well, or only its data are not there.
  bool accept(Asset& asset, const Asset& required);
  Result<void> runFile(Asset& asset, bool enabled);
  /// It may wait, and then goes on after this has returned.
  Result<void> startFunction(Asset& asset, int reference);
  Result<void> callFunction(Asset& asset, int reference);
  void deinitialize(Asset& asset);
  static void takeBack(Asset& asset);
  void forget(Asset& asset);

  scripting::ScriptEngine* engine_;
  PathTokens* tokens_;
  std::vector<std::unique_ptr<Asset>> assets_;  ///< in the order of loading, which is that of their ids
  std::uint64_t lastId_ = 0;
  std::map<std::filesystem::path, Asset*> byFile_;
  std::vector<Asset*> initialized_;  ///< in that order
  std::vector<Asset*> running_;      ///< whose code runs, the outermost first
};

}  // namespace meridian::assets
