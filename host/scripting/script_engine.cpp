#include "host/scripting/script_engine.h"

#include <cstdlib>
#include <new>
#include <optional>

#include <fmt/format.h>
#include <lua.hpp>

#include "host/api/log.h"
#include "host/scripting/lua_value.h"
#include "host/scripting/sandbox.h"

namespace meridian::scripting {

struct ScriptEngine::Private : Guard {
  ScriptEngine* engine = nullptr;
  lua_State* calling = nullptr;          ///< whose script function runs now
  std::deque<ScriptFunction> functions;  ///< Lua's closures point into it
  Error raised;                          ///< the last error made by pushError, and its text
  std::string raisedText;
  std::optional<Error> explained;  ///< by the message handler of the call that failed
  /// The thread of a script that may wait and runs now, and the call that it begins to wait for.
  lua_State* thread = nullptr;
  const ScriptFunction* awaited = nullptr;
  std::vector<Value> awaitedArguments;

  static Private& of(lua_State* lua) { return static_cast<Private&>(guardOf(lua)); }

  /// The Lua function for every ScriptFunction, which its upvalue points to.
  static int callFunction(lua_State* lua);
  /// Whether the call has to wait and can; then it is the awaited one.
  bool beginsToWait(lua_State* lua, const ScriptFunction& function);
  /// Of a failed protected call whose message was handled by explain().
  Error takeError(int status, const std::string& chunkName, std::size_t memoryBytes);
  /// A message handler: finds the parts of the error.
  static int explain(lua_State* lua);
};

/// A script in a Lua thread of its own.
struct ScriptEngine::Waiting {
  lua_State* thread = nullptr;
  int reference = 0;  ///< keeps the thread
  std::string chunkName;
  Around around;
  const ScriptFunction* awaited = nullptr;
  std::vector<Value> arguments{};  ///< of the awaited call
};

namespace {

/// Gives while a scope lasts, and takes back however it is left.
template <class T>
class Scoped {
 public:
  Scoped(T& place, T value) : place_(place), before_(std::exchange(place, value)) {}
  ~Scoped() { place_ = before_; }
  Scoped(const Scoped&) = delete;
  Scoped& operator=(const Scoped&) = delete;

 private:
  T& place_;
  T before_;
};

void* allocate(void* context, void* block, std::size_t oldSize, std::size_t newSize) {
  Guard& guard = *static_cast<Guard*>(context);
  const std::size_t before = block != nullptr ? oldSize : 0;
  if (newSize == 0) {
    std::free(block);
    guard.memoryUsed -= before;
    return nullptr;
  }
  if (newSize > before && newSize - before > guard.memoryLimit - std::min(guard.memoryLimit, guard.memoryUsed)) {
    return nullptr;
  }
  void* result = std::realloc(block, newSize);
  if (result != nullptr) {
    guard.memoryUsed += newSize;
    guard.memoryUsed -= before;
  }
  return result;
}

/// A message of Lua's own begins with an abridged place; the error gets the whole one.
Error withoutPlace(std::string_view message, const std::string& place, const char* abridged) {
  const std::string prefix = std::string(abridged) + ": ";
  if (message.substr(0, place.size() + 2) == place + ": ") {
    message.remove_prefix(place.size() + 2);
  } else if (message.substr(0, prefix.size()) == prefix) {
    message.remove_prefix(prefix.size());
  }
  return {std::string(message), place};
}

std::string joinedPlace(const std::string& place, const std::string& where) {
  if (place.empty() || where.compare(0, place.size(), place) == 0) {
    return where;
  }
  return where.empty() ? place : place + ": " + where;
}

int unknownMember(lua_State* lua) {
  return luaL_error(lua, "%s.%s does not exist", lua_tostring(lua, lua_upvalueindex(1)),
                    luaL_tolstring(lua, 2, nullptr));
}

/// Pushes the table of that name inside the one on top of the stack, made if need be, which then raises on unknown
/// names.
void pushLibraryTable(lua_State* lua, const std::string& name, const std::string& fullName) {
  lua_pushlstring(lua, name.data(), name.size());
  if (lua_rawget(lua, -2) == LUA_TTABLE) {
    return;
  }
  lua_pop(lua, 1);
  lua_newtable(lua);
  lua_createtable(lua, 0, 1);
  lua_pushlstring(lua, fullName.data(), fullName.size());
  lua_pushcclosure(lua, unknownMember, 1);
  lua_setfield(lua, -2, "__index");
  lua_setmetatable(lua, -2);
  lua_pushlstring(lua, name.data(), name.size());
  lua_pushvalue(lua, -2);
  lua_rawset(lua, -4);
}

std::size_t argumentCount(lua_State* lua, const ScriptFunction& function) {
  auto count = static_cast<std::size_t>(lua_gettop(lua));
  while (count > function.minimumArguments && lua_isnil(lua, static_cast<int>(count))) {
    --count;
  }
  return count;
}

Result<std::vector<Value>> argumentsOf(lua_State* lua, const ScriptFunction& function) {
  const std::size_t count = argumentCount(lua, function);
  if (count < function.minimumArguments || count > function.maximumArguments) {
    return failure(fmt::format("{} takes {} arguments ({}), got {}", function.name,
                               function.minimumArguments == function.maximumArguments
                                   ? fmt::format("{}", function.minimumArguments)
                                   : fmt::format("{} to {}", function.minimumArguments, function.maximumArguments),
                               function.arguments, count));
  }
  std::vector<Value> arguments;
  arguments.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    Result<Value> argument = toValue(lua, static_cast<int>(i + 1));
    if (!argument) {
      return failure(fmt::format("{}: argument {}: {}", function.name, i + 1, argument.error().what));
    }
    arguments.push_back(std::move(*argument));
  }
  return arguments;
}

Result<int> invoke(lua_State* lua, const ScriptFunction& function) {
  const ScriptResult result = argumentsOf(lua, function).and_then([&](const std::vector<Value>& arguments) {
    return function.call(arguments);
  });
  if (!result) {
    return tl::make_unexpected(result.error());
  }
  luaL_checkstack(lua, static_cast<int>(result->size()), "too many results");
  for (const Value& value : *result) {
    pushValue(lua, value);
  }
  return static_cast<int>(result->size());
}

const ScriptFunction& calledFunction(lua_State* lua) {
  return *static_cast<const ScriptFunction*>(lua_touserdata(lua, lua_upvalueindex(1)));
}

/// The name of the chunk that a function on the stack is of.
std::string chunkOf(lua_State* lua, int index) {
  lua_Debug function{};
  lua_pushvalue(lua, index);
  lua_getinfo(lua, ">S", &function);
  return function.source[0] == '@' ? function.source + 1 : function.short_src;
}

/// The body of a script's thread, which has a message handler, a function and its arguments on its stack: as
/// lua_pcall(), but the function may wait. Leaves the status.
int guardedBody(lua_State* lua) {
  const auto finish = [](lua_State* thread, int status, lua_KContext /*context*/) -> int {
    lua_pushinteger(thread, status == LUA_YIELD ? LUA_OK : status);
    return 1;
  };
  return finish(lua, lua_pcallk(lua, lua_gettop(lua) - 2, 0, 1, 0, finish), 0);
}

}  // namespace

bool ScriptEngine::Private::beginsToWait(lua_State* lua, const ScriptFunction& function) {
  if (!function.mustWait || !engine->mayWait_ || lua != thread || lua_isyieldable(lua) == 0) {
    return false;
  }
  Result<std::vector<Value>> arguments = argumentsOf(lua, function);
  if (!arguments || !function.mustWait(*arguments)) {
    return false;
  }
  awaited = &function;
  awaitedArguments = std::move(*arguments);
  return true;
}

int ScriptEngine::Private::callFunction(lua_State* lua) {
  Private& self = of(lua);
  const auto callNow = [](lua_State* caller, int /*status*/, lua_KContext /*context*/) -> int {
    Private& own = of(caller);
    const Scoped nowCalling(own.calling, caller);
    Result<int> results = invoke(caller, calledFunction(caller));
    if (results) {
      return *results;
    }
    Error error = std::move(results.error());
    error.where = joinedPlace(placeFrom(caller, 1), error.where);
    own.engine->pushError(caller, std::move(error));
    return lua_error(caller);
  };
  if (self.beginsToWait(lua, calledFunction(lua))) {
    return lua_yieldk(lua, 0, 0, callNow);
  }
  return callNow(lua, LUA_OK, 0);
}

int ScriptEngine::Private::explain(lua_State* lua) {
  Private& self = of(lua);
  std::size_t length = 0;
  const char* text = luaL_tolstring(lua, 1, &length);
  const std::string_view message(text, length);
  if (message == self.raisedText) {
    self.explained = self.raised;
    return 1;
  }
  lua_Debug frame{};
  std::string abridged;
  for (int level = 0; lua_getstack(lua, level, &frame) != 0; ++level) {
    lua_getinfo(lua, "Sl", &frame);
    if (frame.currentline > 0) {
      abridged = fmt::format("{}:{}", frame.short_src, frame.currentline);
      break;
    }
  }
  self.explained = withoutPlace(message, placeFrom(lua, 0), abridged.c_str());
  return 1;
}

Error ScriptEngine::Private::takeError(int status, const std::string& chunkName, std::size_t memoryBytes) {
  Error error{"the script failed", chunkName};
  if (status == LUA_ERRMEM) {
    error.what = fmt::format("the script needs more than {} MiB of memory", memoryBytes >> 20);
  } else if (explained) {
    error = *std::exchange(explained, std::nullopt);
    error.where = error.where.empty() ? chunkName : error.where;
  }
  return error;
}

ScriptEngine::ScriptEngine(ScriptLimits limits) : limits_(limits), private_(std::make_unique<Private>()) {
  private_->engine = this;
  private_->memoryLimit = std::numeric_limits<std::size_t>::max();
  lua_ = lua_newstate(allocate, static_cast<Guard*>(private_.get()));
  if (lua_ == nullptr) {
    throw std::bad_alloc();
  }
  *static_cast<Guard**>(lua_getextraspace(lua_)) = private_.get();
  lua_atpanic(lua_, [](lua_State* lua) -> int {
    log::error("Lua panics: {}", lua_tostring(lua, -1));
    return 0;
  });
  openSandbox(lua_);
  lua_pushglobaltable(lua_);
  pushLibraryTable(lua_, "openspace", "openspace");
  lua_settop(lua_, 0);
  private_->memoryLimit = limits_.memoryBytes;
}

ScriptEngine::~ScriptEngine() {
  lua_close(lua_);
}

void ScriptEngine::registerLibrary(const ScriptLibrary& library) {
  const Scoped unlimited(private_->memoryLimit, std::numeric_limits<std::size_t>::max());
  lua_pushglobaltable(lua_);
  pushLibraryTable(lua_, "openspace", "openspace");
  if (!library.name.empty()) {
    pushLibraryTable(lua_, library.name, "openspace." + library.name);
  }
  ScriptLibrary& known = libraries_[library.name];
  known.name = library.name;
  for (const ScriptFunction& function : library.functions) {
    std::erase_if(known.functions, [&](const ScriptFunction& each) { return each.name == function.name; });
    known.functions.push_back(function);
    ScriptFunction& kept = private_->functions.emplace_back(function);
    lua_pushlstring(lua_, function.name.data(), function.name.size());
    lua_pushlightuserdata(lua_, &kept);
    lua_pushcclosure(lua_, Private::callFunction, 1);
    lua_rawset(lua_, -3);
  }
  lua_settop(lua_, 0);
}

Result<void> ScriptEngine::load(std::string_view text, const std::string& chunkName) {
  const std::string source = '@' + chunkName;
  const int status = luaL_loadbufferx(lua_, text.data(), text.size(), source.c_str(), "t");
  if (status == LUA_OK) {
    return {};
  }
  const std::string message = luaL_tolstring(lua_, -1, nullptr);
  lua_pop(lua_, 2);
  // Lua abridges long names, so the line is looked for after the last part of the name that it kept.
  const std::size_t tail = std::min<std::size_t>(chunkName.size(), 40);
  const std::size_t at = message.find(chunkName.substr(chunkName.size() - tail) + ':');
  if (status == LUA_ERRSYNTAX && at != std::string::npos) {
    const std::size_t line = at + tail + 1;
    const std::size_t end = message.find(':', line);
    if (end != std::string::npos) {
      return failure(message.substr(std::min(end + 2, message.size())),
                     chunkName + ':' + message.substr(line, end - line));
    }
  }
  return failure(message, chunkName);
}

Result<void> ScriptEngine::call(int arguments, int results) {
  Private& self = *private_;
  const int functionIndex = lua_gettop(lua_) - arguments;
  const std::string chunkName = chunkOf(lua_, functionIndex);
  lua_pushcfunction(lua_, Private::explain);
  lua_insert(lua_, functionIndex);

  const Scoped calling(self.calling, static_cast<lua_State*>(nullptr));
  const Scoped thread(self.thread, static_cast<lua_State*>(nullptr));
  const Scoped budget(self.instructionsLeft, static_cast<std::int64_t>(limits_.instructions));
  const Scoped exhausted(self.exhausted, false);
  installHook(lua_);
  self.explained.reset();
  const int status = lua_pcall(lua_, arguments, results, functionIndex);
  installHook(lua_);
  lua_remove(lua_, functionIndex);
  if (status == LUA_OK) {
    return {};
  }
  Error error = self.takeError(status, chunkName, limits_.memoryBytes);
  lua_pop(lua_, 1);
  if (status == LUA_ERRMEM) {
    lua_gc(lua_, LUA_GCCOLLECT);
  }
  return tl::make_unexpected(std::move(error));
}

Result<void> ScriptEngine::start(int arguments, Around around) {
  const std::string chunkName = chunkOf(lua_, lua_gettop(lua_) - arguments);
  Waiting script{nullptr, LUA_NOREF, chunkName, std::move(around)};
  {
    const Scoped unlimited(private_->memoryLimit, std::numeric_limits<std::size_t>::max());
    script.thread = lua_newthread(lua_);
    script.reference = luaL_ref(lua_, LUA_REGISTRYINDEX);
    lua_checkstack(script.thread, arguments + 3);
  }
  lua_pushcfunction(script.thread, guardedBody);
  lua_pushcfunction(script.thread, Private::explain);
  lua_xmove(lua_, script.thread, arguments + 1);
  return runPart(std::move(script), arguments + 2);
}

Result<void> ScriptEngine::runPart(Waiting script, int arguments) {
  Private& self = *private_;
  // Lua's limit of nested calls goes on counting from the thread that is calling.
  lua_State* const from = self.calling != nullptr ? self.calling : lua_;
  const Scoped calling(self.calling, static_cast<lua_State*>(nullptr));
  const Scoped thread(self.thread, script.thread);
  const Scoped budget(self.instructionsLeft, static_cast<std::int64_t>(limits_.instructions));
  const Scoped exhausted(self.exhausted, false);
  installHook(script.thread);
  self.explained.reset();
  self.awaited = nullptr;
  int results = 0;
  const int resumed = lua_resume(script.thread, from, arguments, &results);
  if (resumed == LUA_YIELD && self.awaited != nullptr) {
    script.awaited = std::exchange(self.awaited, nullptr);
    script.arguments = std::exchange(self.awaitedArguments, {});
    waiting_.push_back(std::move(script));
    return {};
  }
  Result<void> result;
  if (resumed == LUA_YIELD) {
    result = failure("attempt to yield from outside a coroutine", placeFrom(script.thread, 0));
  } else {
    const int status = resumed == LUA_OK ? static_cast<int>(lua_tointeger(script.thread, -1)) : resumed;
    if (status != LUA_OK) {
      result = tl::make_unexpected(self.takeError(status, script.chunkName, limits_.memoryBytes));
    }
    if (status == LUA_ERRMEM) {
      lua_gc(lua_, LUA_GCCOLLECT);
    }
  }
  luaL_unref(lua_, LUA_REGISTRYINDEX, script.reference);
  return result;
}

bool ScriptEngine::hasWaiting() const {
  return !waiting_.empty();
}

std::vector<Error> ScriptEngine::resumeWaiting() {
  std::vector<Error> errors;
  std::vector<Waiting> now;
  now.swap(waiting_);
  for (Waiting& script : now) {
    // Another script may have got hold of the thread and have resumed or closed it.
    const bool isThere = lua_status(script.thread) == LUA_YIELD;
    if (isThere && script.awaited->mustWait(script.arguments)) {
      waiting_.push_back(std::move(script));
      continue;
    }
    const int reference = script.reference;
    bool isRun = false;
    const auto part = [&] {
      isRun = true;
      if (Result<void> done = runPart(std::move(script), 0); !done) {
        errors.push_back(std::move(done.error()));
      }
    };
    const Around around = script.around;
    if (isThere && around) {
      around(part);
    } else if (isThere) {
      part();
    }
    if (!isRun) {
      luaL_unref(lua_, LUA_REGISTRYINDEX, reference);
    }
  }
  return errors;
}

Result<void> ScriptEngine::run(std::string_view text, const std::string& chunkName) {
  return load(text, chunkName).and_then([this] { return start(0); });
}

Result<std::vector<Value>> ScriptEngine::evaluate(std::string_view expression, const std::string& chunkName) {
  const int top = lua_gettop(lua_);
  const Result<void> done =
      load(fmt::format("return {}", expression), chunkName).and_then([this] { return call(0, LUA_MULTRET); });
  if (!done) {
    return tl::make_unexpected(done.error());
  }
  std::vector<Value> values;
  for (int i = top + 1; i <= lua_gettop(lua_); ++i) {
    Result<Value> value = toValue(lua_, i);
    if (!value) {
      lua_settop(lua_, top);
      return failure(value.error().what, chunkName);
    }
    values.push_back(std::move(*value));
  }
  lua_settop(lua_, top);
  return values;
}

void ScriptEngine::queue(std::string text, std::string chunkName) {
  queue_.push_back({std::move(text), std::move(chunkName)});
}

std::vector<Error> ScriptEngine::runQueued() {
  std::vector<Error> errors;
  std::deque<Queued> now;
  now.swap(queue_);
  for (const Queued& script : now) {
    for (const auto& observer : observers_) {
      observer(script.text);
    }
    if (Result<void> done = run(script.text, script.chunkName); !done) {
      errors.push_back(std::move(done.error()));
    }
  }
  return errors;
}

std::string ScriptEngine::place() const {
  return private_->calling != nullptr ? placeFrom(private_->calling, 1) : std::string();
}

std::size_t ScriptEngine::memoryInUse() const {
  return private_->memoryUsed;
}

void ScriptEngine::pushError(lua_State* lua, Error error) {
  private_->raised = std::move(error);
  private_->raisedText = private_->raised.message();
  lua_pushlstring(lua, private_->raisedText.data(), private_->raisedText.size());
}

}  // namespace meridian::scripting
