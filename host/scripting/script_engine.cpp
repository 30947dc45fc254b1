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

  static Private& of(lua_State* lua) { return static_cast<Private&>(guardOf(lua)); }
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

Result<int> invoke(lua_State* lua, const ScriptFunction& function) {
  auto count = static_cast<std::size_t>(lua_gettop(lua));
  while (count > function.minimumArguments && lua_isnil(lua, static_cast<int>(count))) {
    --count;
  }
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
  const ScriptResult result = function.call(arguments);
  if (!result) {
    return tl::make_unexpected(result.error());
  }
  luaL_checkstack(lua, static_cast<int>(result->size()), "too many results");
  for (const Value& value : *result) {
    pushValue(lua, value);
  }
  return static_cast<int>(result->size());
}

}  // namespace

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
  const auto trampoline = [](lua_State* lua) -> int {
    Private& self = Private::of(lua);
    const auto& function = *static_cast<const ScriptFunction*>(lua_touserdata(lua, lua_upvalueindex(1)));
    const Scoped calling(self.calling, lua);
    Result<int> results = invoke(lua, function);
    if (results) {
      return *results;
    }
    Error error = std::move(results.error());
    error.where = joinedPlace(placeFrom(lua, 1), error.where);
    self.engine->pushError(lua, std::move(error));
    return lua_error(lua);
  };
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
    lua_pushcclosure(lua_, trampoline, 1);
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
  lua_Debug function{};
  lua_pushvalue(lua_, functionIndex);
  lua_getinfo(lua_, ">S", &function);
  const std::string chunkName = function.source[0] == '@' ? function.source + 1 : function.short_src;

  const auto explain = [](lua_State* lua) -> int {
    Private& engine = Private::of(lua);
    std::size_t length = 0;
    const char* text = luaL_tolstring(lua, 1, &length);
    const std::string_view message(text, length);
    if (message == engine.raisedText) {
      engine.explained = engine.raised;
    } else {
      lua_Debug frame{};
      std::string abridged;
      for (int level = 0; lua_getstack(lua, level, &frame) != 0; ++level) {
        lua_getinfo(lua, "Sl", &frame);
        if (frame.currentline > 0) {
          abridged = fmt::format("{}:{}", frame.short_src, frame.currentline);
          break;
        }
      }
      engine.explained = withoutPlace(message, placeFrom(lua, 0), abridged.c_str());
    }
    return 1;
  };
  lua_pushcfunction(lua_, explain);
  lua_insert(lua_, functionIndex);

  const Scoped calling(self.calling, static_cast<lua_State*>(nullptr));
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
  Error error{"the script failed", chunkName};
  if (status == LUA_ERRMEM) {
    error.what = fmt::format("the script needs more than {} MiB of memory", limits_.memoryBytes >> 20);
  } else if (self.explained) {
    error = *std::exchange(self.explained, std::nullopt);
    error.where = error.where.empty() ? chunkName : error.where;
  }
  lua_pop(lua_, 1);
  if (status == LUA_ERRMEM) {
    lua_gc(lua_, LUA_GCCOLLECT);
  }
  return tl::make_unexpected(std::move(error));
}

Result<void> ScriptEngine::run(std::string_view text, const std::string& chunkName) {
  return load(text, chunkName).and_then([this] { return call(0, 0); });
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
