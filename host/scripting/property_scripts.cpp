#include "host/scripting/property_scripts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "host/api/log.h"
#include "host/api/property.h"

namespace meridian::scripting {

namespace {

constexpr double defaultFadeSeconds = 1.0;

/// What all functions of the library work on.
struct Context {
  PropertyOwner* root;
  PropertyIndex* index;
  PropertyAnimation* animation;
};

using Arguments = std::span<const Value>;

Result<std::string> text(Arguments arguments, std::size_t i, std::string_view name) {
  if (i < arguments.size() && arguments[i].string() != nullptr) {
    return *arguments[i].string();
  }
  return failure(fmt::format("argument {} ({}) must be a string", i + 1, name));
}

struct Change {
  std::string pattern;
  Value value;
  double seconds = 0.0;
  Easing easing = nullptr;
  std::string postScript;
  bool bouncing = false;
};

Result<double> secondsAt(Arguments arguments, std::size_t i, double otherwise) {
  if (i >= arguments.size() || arguments[i].isNil()) {
    return otherwise;
  }
  const std::optional<double> seconds = arguments[i].number();
  if (!seconds || !std::isfinite(*seconds)) {
    return failure(fmt::format("argument {} (duration) must be a finite number of seconds", i + 1));
  }
  return std::max(0.0, *seconds);
}

/// uri, value, duration?, easing?, postScript?, bouncing?
Result<Change> changeFrom(Arguments arguments) {
  Change change;
  const Result<std::string> pattern = text(arguments, 0, "uri");
  const Result<double> seconds = secondsAt(arguments, 2, 0.0);
  if (!pattern || !seconds) {
    return tl::make_unexpected(!pattern ? pattern.error() : seconds.error());
  }
  change.pattern = *pattern;
  change.value = arguments[1];
  change.seconds = *seconds;
  change.easing = *easingFromName("Linear");
  if (arguments.size() > 3 && !arguments[3].isNil()) {
    const std::string* name = arguments[3].string();
    // OpenSpace's scripts also write "" for no easing.
    const auto easing =
        name == nullptr ? std::nullopt : (name->empty() ? std::optional(change.easing) : easingFromName(*name));
    if (!easing) {
      return failure(
          fmt::format("unknown easing {}", arguments[3].toLua()), {},
          "use Linear, or Quadratic, Cubic, Quartic, Quintic, Sine, Circular, Exponential, Elastic or Bounce "
          "with EaseIn, EaseOut or EaseInOut");
    }
    change.easing = *easing;
  }
  if (arguments.size() > 4 && !arguments[4].isNil()) {
    const Result<std::string> script = text(arguments, 4, "postScript");
    if (!script) {
      return tl::make_unexpected(script.error());
    }
    change.postScript = *script;
  }
  if (arguments.size() > 5) {
    change.bouncing = arguments[5].boolean().value_or(false);
    if (change.bouncing && change.seconds <= 0.0) {
      return failure("bouncing needs a duration");
    }
  }
  return change;
}

/// Those that the pattern means and that take this type of value. Buttons are pressed only by their own name or by nil,
/// so that a wildcard for values does not press them.
std::vector<Property*> takers(PropertyIndex& index, const PropertyPattern& pattern, const Value& value) {
  std::vector<Property*> properties = index.match(pattern);
  std::erase_if(properties, [&](const Property* property) {
    if (!property->accepts(value)) {
      return true;
    }
    const bool isButton = dynamic_cast<const TriggerProperty*>(property) != nullptr;
    return isButton && !pattern.isExact() && !value.isNil();
  });
  return properties;
}

/// Sets or starts to move; one error for each property that refuses.
std::vector<Error> apply(const Context& context, const PropertyPattern& pattern, const Change& change,
                         const std::function<void(std::string)>& runLater) {
  const std::vector<Property*> properties = takers(*context.index, pattern, change.value);
  if (properties.empty()) {
    const bool named = !context.index->match(pattern).empty();
    return {Error{named ? fmt::format("\"{}\" takes no {}", change.pattern, kindName(change.value.kind()))
                        : fmt::format("no property matches \"{}\"", change.pattern),
                  {}}};
  }
  std::vector<Error> errors;
  std::vector<Property*> moving;
  std::vector<std::string> setAtOnce;
  for (Property* property : properties) {
    if (property->isReadOnly()) {
      errors.push_back({"the property is read only", property->uri()});
    } else if (change.seconds > 0.0 && property->isNumeric()) {
      moving.push_back(property);
    } else {
      setAtOnce.push_back(property->uri());
    }
  }
  // Callbacks may remove properties, so each is looked up again.
  for (const std::string& uri : setAtOnce) {
    Property* property = context.index->find(uri);
    if (property == nullptr) {
      continue;
    }
    context.animation->cancel(*property);
    if (Result<void> done = property->set(change.value); !done) {
      errors.push_back(done.error());
    }
  }
  if (!moving.empty()) {
    if (!setAtOnce.empty()) {
      std::erase_if(moving, [&](const Property* property) {
        const auto& entries = context.index->entries();
        return std::none_of(entries.begin(), entries.end(), [&](const auto& e) { return e.property == property; });
      });
    }
    context.animation->start(moving, {change.value, change.seconds, change.easing, change.postScript, change.bouncing});
  } else if (!change.postScript.empty()) {
    runLater(change.postScript);
  }
  return errors;
}

ScriptResult setFromScript(const Context& context, Arguments arguments, bool single) {
  const Result<Change> change = changeFrom(arguments);
  if (!change) {
    return tl::make_unexpected(change.error());
  }
  const Result<PropertyPattern> pattern = PropertyPattern::parse(change->pattern);
  if (!pattern) {
    return tl::make_unexpected(pattern.error());
  }
  if (single && !pattern->isExact()) {
    return failure(fmt::format("\"{}\" is no single property", change->pattern), {}, "use setPropertyValue");
  }
  for (const Error& error : apply(context, *pattern, *change, context.animation->runLater())) {
    log::error("setPropertyValue: {}", error.message());
  }
  return {};
}

/// Fades an owner in or out: Enabled and Fade below what the pattern names.
ScriptResult fade(const Context& context, Arguments arguments, std::optional<bool> in) {
  const Result<std::string> pattern = text(arguments, 0, "pattern");
  const Result<double> seconds = secondsAt(arguments, 1, defaultFadeSeconds);
  const Result<std::string> last = arguments.size() > 2 ? text(arguments, 2, "endScript") : Result<std::string>("");
  if (!pattern || !seconds || !last) {
    return tl::make_unexpected(!pattern ? pattern.error() : (!seconds ? seconds.error() : last.error()));
  }
  const Result<PropertyPattern> enabled = PropertyPattern::parse(*pattern + ".Enabled");
  const Result<PropertyPattern> faded = PropertyPattern::parse(*pattern + ".Fade");
  if (!enabled || !faded) {
    return tl::make_unexpected(!enabled ? enabled.error() : faded.error());
  }
  const auto warn = [](const std::vector<Error>& errors) {
    for (const Error& error : errors) {
      log::error("fade: {}", error.message());
    }
  };
  if (!in) {
    const std::vector<Property*> switches = context.index->match(*enabled);
    in = std::none_of(switches.begin(), switches.end(),
                      [](const Property* property) { return property->value().boolean().value_or(false); });
  }
  const Easing linear = *easingFromName("Linear");
  const bool hasFade = !takers(*context.index, *faded, 0.0).empty();
  if (*in) {
    if (hasFade) {
      for (Property* property : context.index->match(*enabled)) {
        const bool wasOff = property->value() == Value(false);
        Property* fadeOfIt = property->owner() != nullptr ? property->owner()->property("Fade") : nullptr;
        if (wasOff && fadeOfIt != nullptr) {
          (void)fadeOfIt->set(0.0);
        }
      }
    }
    warn(apply(context, *enabled, {*pattern, true, 0.0, linear, hasFade ? "" : *last}, context.animation->runLater()));
    if (hasFade) {
      warn(apply(context, *faded, {*pattern, 1.0, *seconds, linear, *last}, context.animation->runLater()));
    }
    return {};
  }
  const std::string off = fmt::format("openspace.setPropertyValue({}, false)", Value(*pattern + ".Enabled").toLua());
  if (hasFade && *seconds > 0.0) {
    warn(apply(context, *faded, {*pattern, 0.0, *seconds, linear, off + "\n" + *last}, context.animation->runLater()));
  } else {
    warn(apply(context, *enabled, {*pattern, false, 0.0, linear, *last}, context.animation->runLater()));
  }
  return {};
}

ScriptResult readValue(const Context& context, Arguments arguments) {
  const Result<std::string> uri = text(arguments, 0, "uri");
  if (!uri) {
    return tl::make_unexpected(uri.error());
  }
  const Property* property = context.index->find(*uri);
  if (property == nullptr) {
    return failure(fmt::format("there is no property \"{}\"", *uri));
  }
  return std::vector{property->value()};
}

ScriptResult invertBoolean(const Context& context, Arguments arguments) {
  const Result<std::string> uri = text(arguments, 0, "uri");
  if (!uri) {
    return tl::make_unexpected(uri.error());
  }
  Property* property = context.index->find(*uri);
  const std::optional<bool> value = property != nullptr ? property->value().boolean() : std::nullopt;
  if (!value) {
    return failure(fmt::format("there is no boolean property \"{}\"", *uri));
  }
  if (Result<void> set = property->set(!*value); !set) {
    return tl::make_unexpected(set.error());
  }
  return {};
}

Result<PropertyPattern> patternFrom(Arguments arguments) {
  return text(arguments, 0, "pattern").and_then([](const std::string& each) { return PropertyPattern::parse(each); });
}

ScriptResult listUris(const Context& context, Arguments arguments) {
  const Result<PropertyPattern> pattern = patternFrom(arguments);
  if (!pattern) {
    return tl::make_unexpected(pattern.error());
  }
  Table uris;
  for (const Property* property : context.index->match(*pattern)) {
    uris.list.emplace_back(property->uri());
  }
  return std::vector<Value>{std::move(uris)};
}

/// Those below `owner` whose URIs begin with `prefix`, each before its children.
void addOwners(const PropertyOwner& owner, const std::string& prefix, const PropertyPattern& pattern, Table& uris) {
  for (const PropertyOwner* child : owner.children()) {
    const std::string uri = prefix + child->identifier();
    if (pattern.matches(uri, child)) {
      uris.list.emplace_back(uri);
    }
    addOwners(*child, uri + '.', pattern, uris);
  }
}

ScriptResult listOwners(const Context& context, Arguments arguments) {
  const Result<PropertyPattern> pattern = patternFrom(arguments);
  if (!pattern) {
    return tl::make_unexpected(pattern.error());
  }
  Table uris;
  addOwners(*context.root, {}, *pattern, uris);
  return std::vector<Value>{std::move(uris)};
}

ScriptResult changeTag(const Context& context, Arguments arguments, bool add) {
  const Result<std::string> uri = text(arguments, 0, "uri");
  const Result<std::string> tag = text(arguments, 1, "tag");
  if (!uri || !tag) {
    return tl::make_unexpected(!uri ? uri.error() : tag.error());
  }
  PropertyOwner* owner = context.root;
  for (std::size_t start = 0; owner != nullptr && start <= uri->size();) {
    const std::size_t end = std::min(uri->find('.', start), uri->size());
    owner = owner->child(std::string_view(*uri).substr(start, end - start));
    start = end + 1;
  }
  if (owner == nullptr) {
    return failure(fmt::format("there is no property owner \"{}\"", *uri));
  }
  if (add) {
    owner->addTag(*tag);
  } else {
    owner->removeTag(*tag);
  }
  return {};
}

}  // namespace

ScriptLibrary propertyLibrary(PropertyOwner& root, PropertyIndex& index, PropertyAnimation& animation) {
  const Context context{&root, &index, &animation};
  const std::string setArguments = "uri, value, duration?, easing?, postScript?, bouncing?";
  const auto read = [context](Arguments a) { return readValue(context, a); };
  return {"",
          {{"setPropertyValue", setArguments, "Sets all properties that a pattern means.", 2, 6,
            [context](Arguments a) { return setFromScript(context, a, false); }},
           {"setPropertyValueSingle", setArguments, "Sets one property.", 2, 6,
            [context](Arguments a) { return setFromScript(context, a, true); }},
           {"propertyValue", "uri", "The value of a property.", 1, 1, read},
           {"getPropertyValue", "uri", "Older name of propertyValue.", 1, 1, read},
           {"invertBooleanProperty", "uri", "Switches a property that is true or false.", 1, 1,
            [context](Arguments a) { return invertBoolean(context, a); }},
           {"hasProperty", "uri", "Whether there is a property of that URI.", 1, 1,
            [context](Arguments a) -> ScriptResult {
              const std::string* uri = a[0].string();
              return std::vector<Value>{uri != nullptr && context.index->find(*uri) != nullptr};
            }},
           {"property", "pattern", "The URIs of all properties that a pattern means.", 1, 1,
            [context](Arguments a) { return listUris(context, a); }},
           {"propertyOwner", "pattern", "The URIs of all property owners that a pattern means.", 1, 1,
            [context](Arguments a) { return listOwners(context, a); }},
           {"stopPropertyBouncing", "uri", "Ends a bouncing movement.", 1, 1,
            [context](Arguments a) -> ScriptResult {
              const Result<std::string> uri = text(a, 0, "uri");
              if (!uri) {
                return tl::make_unexpected(uri.error());
              }
              if (!context.animation->stopBouncing(*uri)) {
                log::warning("stopPropertyBouncing: \"{}\" is not bouncing", *uri);
              }
              return {};
            }},
           {"fadeIn", "pattern, duration?, endScript?", "Enables and fades in.", 1, 3,
            [context](Arguments a) { return fade(context, a, true); }},
           {"fadeOut", "pattern, duration?, endScript?", "Fades out and disables.", 1, 3,
            [context](Arguments a) { return fade(context, a, false); }},
           {"toggleFade", "pattern, duration?, endScript?", "Fades out what is enabled, else in.", 1, 3,
            [context](Arguments a) { return fade(context, a, std::nullopt); }},
           {"addTag", "uri, tag", "Tags a property owner.", 2, 2,
            [context](Arguments a) { return changeTag(context, a, true); }},
           {"removeTag", "uri, tag", "Takes a tag away.", 2, 2,
            [context](Arguments a) { return changeTag(context, a, false); }}}};
}

Result<void> setProperties(PropertyIndex& index, PropertyAnimation& animation, std::string_view pattern,
                           const Value& value) {
  const Result<PropertyPattern> parsed = PropertyPattern::parse(pattern);
  if (!parsed) {
    return tl::make_unexpected(parsed.error());
  }
  const Context context{nullptr, &index, &animation};
  const std::vector<Error> errors =
      apply(context, *parsed, {std::string(pattern), value, 0.0, nullptr, {}}, animation.runLater());
  if (!errors.empty()) {
    return tl::make_unexpected(errors.front());
  }
  return {};
}

ScriptLibrary logLibrary() {
  const auto printer = [](std::string name, std::string description, log::Level level) {
    return ScriptFunction{std::move(name), "text", std::move(description), 1, 1, [level](Arguments a) -> ScriptResult {
                            log::write(level, a[0].string() != nullptr ? *a[0].string() : a[0].toLua());
                            return {};
                          }};
  };
  return {"",
          {printer("printTrace", "Logs at level trace.", log::Level::Trace),
           printer("printDebug", "Logs at level debug.", log::Level::Debug),
           printer("printInfo", "Logs at level info.", log::Level::Info),
           printer("printWarning", "Logs at level warning.", log::Level::Warning),
           printer("printError", "Logs at level error.", log::Level::Error),
           printer("printFatal", "Logs at level error.", log::Level::Error)}};
}

}  // namespace meridian::scripting
