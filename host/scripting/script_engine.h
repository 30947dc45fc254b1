#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/api/error.h"
#include "host/api/script_library.h"
#include "host/api/value.h"

struct lua_State;

namespace meridian::scripting {

/// What one script may use before it is stopped with an error.
struct ScriptLimits {
  std::size_t memoryBytes = std::size_t{512} << 20;  ///< of the whole Lua state
  std::uint64_t instructions = 200'000'000;          ///< of Lua's machine, in one run or call; about two seconds
};

/// One Lua 5.4 state without a way out: no os, io, package, debug, require, dofile, loadfile, collectgarbage and
/// string.dump; load takes text only; setmetatable refuses __gc. A script that passes its limits is stopped, also
/// inside pcall and coroutines. Reading a global that nobody set is logged once per name.
///
/// Every Error's `where` is "CHUNK:LINE", chunk names unabridged. Render thread only.
class ScriptEngine {
 public:
  explicit ScriptEngine(ScriptLimits limits = {});
  ~ScriptEngine();
  ScriptEngine(const ScriptEngine&) = delete;
  ScriptEngine& operator=(const ScriptEngine&) = delete;

  /// Adds `openspace.NAME.*` (an empty name: `openspace.*`); a function of the same name is replaced. Wrong numbers of
  /// arguments, and arguments that no Value can hold (functions, cycles), are Lua errors.
  void registerLibrary(const ScriptLibrary& library);
  /// All that was registered, by name: for documentation.
  [[nodiscard]] const std::map<std::string, ScriptLibrary>& libraries() const { return libraries_; }

  /// Runs text at once, up to where it waits. `chunkName` is a file's path, or a word such as "script".
  Result<void> run(std::string_view text, const std::string& chunkName);
  /// The values of `return EXPRESSION`.
  [[nodiscard]] Result<std::vector<Value>> evaluate(std::string_view expression, const std::string& chunkName);

  /// Scripts that wait until the frame's place for them; those that are queued while they run wait for the next.
  void queue(std::string text, std::string chunkName = "script");
  /// Runs what waits, in order, and tells the observers. An error ends its own script only.
  std::vector<Error> runQueued();
  [[nodiscard]] bool hasQueued() const { return !queue_.empty(); }

  /// Goes on with scripts that wait for nothing any longer (ScriptFunction::mustWait). Returns their errors.
  std::vector<Error> resumeWaiting();
  [[nodiscard]] bool hasWaiting() const;
  /// For runs without frames: functions that would have to wait are called at once.
  void neverWait() { mayWait_ = false; }

  /// Hears every queued script before it runs, so that a recording can keep it.
  void onQueuedScript(std::function<void(std::string_view text)> observer) {
    observers_.push_back(std::move(observer));
  }

  /// "CHUNK:LINE" of the Lua code that is calling us now; empty outside a script function.
  [[nodiscard]] std::string place() const;

  [[nodiscard]] std::size_t memoryInUse() const;

  /// For rooms that extend Lua itself (assets), together with "host/scripting/lua_value.h".
  [[nodiscard]] lua_State* state() const { return lua_; }
  /// Loads text (never bytecode) and leaves the function on the stack; on error the stack is as it was.
  Result<void> load(std::string_view text, const std::string& chunkName);
  /// Calls the function below `arguments` values on the stack, under fresh instruction limits; on success `results`
  /// values (-1: all) replace them, on error nothing does.
  Result<void> call(int arguments, int results);
  /// What is to be around every part of a script after its first; one that does not call `part` ends the script.
  using Around = std::function<void(const std::function<void()>& part)>;
  /// As call() without results; but where the function waits this returns, and the rest comes with resumeWaiting().
  Result<void> start(int arguments, Around around = {});
  /// The Error that a C++ function makes into a Lua error: it pushes the message and remembers the parts, so that the
  /// caller of run() gets them back. Lua's own error() must follow.
  void pushError(lua_State* lua, Error error);

 private:
  struct Private;
  struct Waiting;
  /// Runs a thread until it ends or waits.
  Result<void> runPart(Waiting script, int arguments);
  struct Queued {
    std::string text;
    std::string chunkName;
  };

  ScriptLimits limits_;
  std::unique_ptr<Private> private_;
  lua_State* lua_ = nullptr;
  std::map<std::string, ScriptLibrary> libraries_;
  std::deque<Queued> queue_;
  std::vector<Waiting> waiting_;
  bool mayWait_ = true;
  std::vector<std::function<void(std::string_view)>> observers_;
};

}  // namespace meridian::scripting
