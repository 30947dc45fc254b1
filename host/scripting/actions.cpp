#include "host/scripting/actions.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "host/api/log.h"
#include "host/api/schema.h"

namespace meridian::scripting {

namespace {

using Arguments = std::span<const Value>;
using Type = Schema::Type;

Error noSuchAction(std::string_view identifier) {
  return {fmt::format("there is no action \"{}\"", identifier), {}, "check the identifier"};
}

std::string textIn(const Value& table, std::string_view key) {
  const Value* value = table.find(key);
  return value != nullptr && value->string() != nullptr ? *value->string() : std::string();
}

Result<std::string> textAt(Arguments arguments, std::size_t i, std::string_view name) {
  if (arguments[i].string() == nullptr) {
    return failure(fmt::format("argument {} ({}) must be a string", i + 1, name));
  }
  return *arguments[i].string();
}

ScriptResult none(const Result<void>& done) {
  return done ? ScriptResult(std::vector<Value>()) : tl::make_unexpected(done.error());
}

ScriptResult one(Value value) {
  return std::vector<Value>{std::move(value)};
}

Result<Action> actionFrom(const Value& table) {
  static const Schema schema({{"Identifier", Type::String, "the action's name in scripts", true},
                              {"Command", Type::String, "the script it runs", true},
                              {"Name", Type::String, "its name for people"},
                              {"Documentation", Type::String, "what it does, for people"},
                              {"GuiPath", Type::String, "where user interfaces show it"},
                              {"IsLocal", Type::Boolean, "whether it is for this computer alone"}});
  return schema.validate(table, "", "action").map([&] {
    const Value* local = table.find("IsLocal");
    return Action{textIn(table, "Identifier"), textIn(table, "Name"),    textIn(table, "Documentation"),
                  textIn(table, "GuiPath"),    textIn(table, "Command"), local != nullptr && *local->boolean()};
  });
}

Value valueOf(const Action& action) {
  return Table{{},
               {{"Identifier", action.identifier},
                {"Name", action.name},
                {"Documentation", action.documentation},
                {"GuiPath", action.guiPath},
                {"Command", action.command},
                {"IsLocal", action.isLocal}}};
}

/// An action's identifier, or the table it was made from.
Result<std::string> identifierAt(Arguments arguments, std::size_t i) {
  const Value* identifier = arguments[i].isTable() ? arguments[i].find("Identifier") : &arguments[i];
  if (identifier == nullptr || identifier->string() == nullptr) {
    return failure(fmt::format("argument {} must be an action's identifier", i + 1));
  }
  return *identifier->string();
}

Value listOf(const std::vector<std::string>& texts) {
  Table list;
  list.list.assign(texts.begin(), texts.end());
  return list;
}

/// The one spelling of a key: "CTRL+SHIFT+H".
Result<std::string> spelled(std::string_view key) {
  static constexpr std::array<std::string_view, 4> modifiers{"CTRL", "SHIFT", "ALT", "SUPER"};
  std::string upper;
  std::transform(key.begin(), key.end(), std::back_inserter(upper),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  std::erase(upper, ' ');
  std::array<bool, modifiers.size()> held{};
  std::string_view rest = upper;
  for (std::size_t plus; (plus = rest.find('+', 1)) != std::string_view::npos && plus + 1 < rest.size();) {
    std::string_view word = rest.substr(0, plus);
    word = word == "CONTROL" ? modifiers[0] : word;
    const auto found = std::find(modifiers.begin(), modifiers.end(), word);
    if (found == modifiers.end()) {
      return failure(fmt::format("\"{}\" is no key: {} is no modifier", key, word), {},
                     "use Ctrl, Shift, Alt and Super, as in Ctrl+Shift+H");
    }
    held[static_cast<std::size_t>(found - modifiers.begin())] = true;
    rest.remove_prefix(plus + 1);
  }
  if (rest.empty()) {
    return failure(fmt::format("\"{}\" is no key", key), {}, "write it as SPACE, F5, a or Ctrl+Shift+H");
  }
  std::string whole;
  for (std::size_t i = 0; i < modifiers.size(); ++i) {
    whole += held[i] ? std::string(modifiers[i]) + '+' : "";
  }
  return whole + std::string(rest);
}

}  // namespace

Result<void> Actions::add(const Action& action) {
  if (action.identifier.empty()) {
    return failure("the action has no identifier");
  }
  if (!actions_.try_emplace(action.identifier, action).second) {
    return failure(fmt::format("there is an action \"{}\" already", action.identifier), {},
                   "choose another identifier");
  }
  return {};
}

Result<void> Actions::remove(std::string_view identifier) {
  const auto found = actions_.find(identifier);
  if (found == actions_.end()) {
    return tl::make_unexpected(noSuchAction(identifier));
  }
  actions_.erase(found);
  return {};
}

const Action* Actions::find(std::string_view identifier) const {
  const auto found = actions_.find(identifier);
  return found == actions_.end() ? nullptr : &found->second;
}

Result<void> Actions::trigger(std::string_view identifier, const Value& arguments) {
  const Action* action = find(identifier);
  if (action == nullptr) {
    return tl::make_unexpected(noSuchAction(identifier));
  }
  // On one line, so that the script's line numbers stay.
  const std::string given = arguments.isTable() ? arguments.toLua() : "{}";
  engine_->queue("local args = " + given + "; " + action->command, "action " + action->identifier);
  return {};
}

Result<void> KeyBindings::bind(std::string_view key, std::string action) {
  return spelled(key).map([&](std::string whole) {
    const auto [first, last] = bindings_.equal_range(whole);
    if (std::none_of(first, last, [&](const auto& pair) { return pair.second == action; })) {
      bindings_.emplace(std::move(whole), std::move(action));
    }
  });
}

Result<void> KeyBindings::unbind(std::string_view key, std::string_view action) {
  return spelled(key).map([&](const std::string& whole) {
    std::erase_if(bindings_, [&](const auto& pair) { return pair.first == whole && pair.second == action; });
  });
}

Result<void> KeyBindings::clear(std::string_view key) {
  return spelled(key).map([&](const std::string& whole) { bindings_.erase(whole); });
}

bool KeyBindings::press(std::string_view key) {
  const std::vector<std::string> bound = actionsOf(key);
  for (const std::string& action : bound) {
    if (auto done = actions_->trigger(action); !done) {
      log::error("key {}: {}", key, done.error().message());
    }
  }
  return !bound.empty();
}

std::vector<std::string> KeyBindings::actionsOf(std::string_view key) const {
  std::vector<std::string> found;
  if (const auto whole = spelled(key)) {
    const auto [first, last] = bindings_.equal_range(*whole);
    std::transform(first, last, std::back_inserter(found), [](const auto& pair) { return pair.second; });
  }
  return found;
}

std::vector<std::string> KeyBindings::keysOf(std::string_view action) const {
  std::vector<std::string> found;
  for (const auto& [key, bound] : bindings_) {
    if (bound == action) {
      found.push_back(key);
    }
  }
  return found;
}

ScriptLibrary actionLibrary(Actions& actions, NoteRegistration note) {
  return {"action",
          {{"registerAction", "table", "Adds an action.", 1, 1,
            [&actions, note = std::move(note)](Arguments a) -> ScriptResult {
              const auto action = actionFrom(a[0]);
              return none(action.and_then([&](const Action& made) { return actions.add(made); }).map([&] {
                note("action " + action->identifier, [&actions, identifier = action->identifier] {
                  static_cast<void>(actions.remove(identifier));  // it may be gone
                });
              }));
            }},
           {"removeAction", "identifier or table", "Removes an action.", 1, 1,
            [&actions](Arguments a) -> ScriptResult {
              const auto identifier = identifierAt(a, 0);
              return identifier ? none(actions.remove(*identifier)) : tl::make_unexpected(identifier.error());
            }},
           {"hasAction", "identifier", "Whether there is an action of that name.", 1, 1,
            [&actions](Arguments a) -> ScriptResult {
              return identifierAt(a, 0).map(
                  [&](const std::string& each) { return std::vector<Value>{actions.find(each) != nullptr}; });
            }},
           {"action", "identifier", "The table of one action.", 1, 1,
            [&actions](Arguments a) -> ScriptResult {
              const auto identifier = identifierAt(a, 0);
              if (!identifier) {
                return tl::make_unexpected(identifier.error());
              }
              const Action* action = actions.find(*identifier);
              return action != nullptr ? one(valueOf(*action)) : tl::make_unexpected(noSuchAction(*identifier));
            }},
           {"actions", "", "The tables of all actions.", 0, 0,
            [&actions](Arguments) {
              Table list;
              for (const auto& [identifier, action] : actions.all()) {
                list.list.push_back(valueOf(action));
              }
              return one(std::move(list));
            }},
           {"triggerAction", "identifier, arguments?", "Runs an action's script; `args` is then the table given.", 1, 2,
            [&actions](Arguments a) -> ScriptResult {
              const auto identifier = identifierAt(a, 0);
              return identifier ? none(actions.trigger(*identifier, a.size() > 1 ? a[1] : Value()))
                                : tl::make_unexpected(identifier.error());
            }}}};
}

ScriptLibrary keyLibrary(KeyBindings& keys, NoteRegistration note) {
  return {
      "",
      {{"bindKey", "key, action", "Makes a key call an action.", 2, 2,
        [&keys, note = std::move(note)](Arguments a) -> ScriptResult {
          const auto key = textAt(a, 0, "key");
          const auto action = identifierAt(a, 1);
          if (!key || !action) {
            return tl::make_unexpected(!key ? key.error() : action.error());
          }
          const std::vector<std::string> before = keys.actionsOf(*key);
          return none(keys.bind(*key, *action).map([&] {
            if (std::find(before.begin(), before.end(), *action) != before.end()) {
              return;  // it is another's, who may stay when this one goes
            }
            note("key " + *key + ' ' + *action, [&keys, bound = *key, called = *action] {
              static_cast<void>(keys.unbind(bound, called));  // the key is one, or it had not been bound
            });
          }));
        }},
       {"clearKey", "key or list of keys", "Makes a key call nothing.", 1, 1,
        [&keys](Arguments a) -> ScriptResult {
          const std::vector<Value> all = a[0].isTable() ? a[0].table()->list : std::vector<Value>{a[0]};
          for (const Value& key : all) {
            if (key.string() == nullptr) {
              return failure("argument 1 (key) must be a string or a list of strings");
            }
            if (auto done = keys.clear(*key.string()); !done) {
              return none(done);
            }
          }
          return {};
        }},
       {"clearKeys", "", "Makes all keys call nothing.", 0, 0,
        [&keys](Arguments) -> ScriptResult {
          keys.clearAll();
          return {};
        }},
       {"keyBindings", "key", "The actions that a key calls.", 1, 1,
        [&keys](Arguments a) -> ScriptResult {
          return textAt(a, 0, "key").map([&](const std::string& key) {
            return std::vector<Value>{listOf(keys.actionsOf(key))};
          });
        }},
       {"keyBindingsForAction", "action", "The keys that call an action.", 1, 1, [&keys](Arguments a) -> ScriptResult {
          return identifierAt(a, 0).map(
              [&](const std::string& action) { return std::vector<Value>{listOf(keys.keysOf(action))}; });
        }}}};
}

}  // namespace meridian::scripting
