#include "host/assets/profile.h"

#include <array>
#include <functional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "host/api/regular_file.h"
#include "host/api/schema.h"
#include "host/assets/json_value.h"

namespace meridian::assets {

namespace {

namespace fs = std::filesystem;

using Type = Schema::Type;
using Field = Schema::Field;

std::string textIn(const Value& table, std::string_view key) {
  const Value* value = table.find(key);
  return value != nullptr && value->string() != nullptr ? *value->string() : std::string();
}
std::optional<double> numberIn(const Value& table, std::string_view key) {
  const Value* value = table.find(key);
  return value != nullptr ? value->number() : std::nullopt;
}
bool flagIn(const Value& table, std::string_view key) {
  const Value* value = table.find(key);
  return value != nullptr && value->boolean().value_or(false);
}

/// Reads one file, and collects what is wrong.
class ProfileReader {
 public:
  explicit ProfileReader(fs::path file) : file_(std::move(file)) {}

  [[nodiscard]] const std::vector<Error>& errors() const { return errors_; }

  void read(Profile& profile) {
    const Result<Value> root = parse(file_);
    if (!root) {
      errors_.push_back(root.error());
      return;
    }
    static const Schema schema({{"version", Type::Table, "major and minor", true},
                                {"assets", Type::Table, "paths of assets"},
                                {"camera", Type::Table, "where the camera starts"},
                                {"time", Type::Table, "when"},
                                {"delta_times", Type::Table, "speeds of time, seconds a second"},
                                {"mark_nodes", Type::Table, "identifiers of interesting nodes"},
                                {"properties", Type::Table, "what is set after loading"},
                                {"actions", Type::Table, "scripts with names"},
                                {"keybindings", Type::Table, "keys that call them"},
                                {"additional_scripts", Type::Table, "what runs at last"},
                                {"modules", Type::Table, "scripts for modules that are there, or not"},
                                {"panel_visibility", Type::Table, "panels of OpenSpace's interface"},
                                {"ui_panel_visibility", Type::Table, "its older name"},
                                {"addons", Type::Table, "further assets"},
                                {"meta", Type::Table, "about the profile"}});
    if (!check(*root, schema, "")) {
      return;
    }
    readVersion(*root->find("version"));
    profile.assets = texts(*root, "assets");
    profile.markedNodes = texts(*root, "mark_nodes");
    profile.additionalScripts = texts(*root, "additional_scripts");
    readDeltaTimes(*root, profile);
    readMeta(*root, profile);
    if (const Value* time = root->find("time")) {
      readTime(*time, profile);
    }
    if (const Value* camera = root->find("camera")) {
      readCamera(*camera, profile);
    }
    readLists(*root, profile);
    if (const Value* addons = root->find("addons")) {
      readAddons(*addons, profile);
    }
  }

 private:
  static Result<Value> parse(const fs::path& file) {
    return readRegularFile(file, largestText, "the profile", "check the path").and_then([&](const std::string& text) {
      return valueFromJson(text, file.string());
    });
  }

  [[nodiscard]] std::string place(const std::string& key) const { return file_.string() + ": " + key; }
  void complain(std::string what, const std::string& key, std::string remedy = {}) {
    errors_.push_back({std::move(what), place(key), std::move(remedy)});
  }

  /// Types and unknown keys; whether all is well.
  bool check(const Value& value, const Schema& schema, const std::string& path) {
    const std::size_t before = errors_.size();
    if (auto valid = schema.validate(value, file_.string(), path); !valid) {
      errors_.push_back(std::move(valid.error()));
    }
    for (const UnknownKey& unknown : unknownKeys(value, {&schema}, {})) {
      complain("unknown key " + unknown.key, path + (path.empty() ? "" : ".") + unknown.key,
               unknown.meant.empty() ? "" : "did you mean " + unknown.meant + "?");
    }
    return errors_.size() == before;
  }

  /// The items of a list that fit a schema, each with its path.
  void forEach(const Value& root, const std::string& key, const Schema& schema,
               const std::function<void(const Value&, const std::string&)>& use) {
    const Value* list = root.find(key);
    if (list == nullptr) {
      return;
    }
    if (!list->table()->fields.empty()) {
      complain("expected a list, found an object", key);
      return;
    }
    for (std::size_t i = 0; i < list->table()->list.size(); ++i) {
      const std::string path = fmt::format("{}[{}]", key, i + 1);
      if (check(list->table()->list[i], schema, path)) {
        use(list->table()->list[i], path);
      }
    }
  }

  std::vector<std::string> texts(const Value& root, const std::string& key) {
    std::vector<std::string> found;
    const Value* list = root.find(key);
    if (list == nullptr) {
      return found;
    }
    if (!list->isTable() || !list->table()->fields.empty()) {
      complain("expected a list of strings", key);
      return found;
    }
    for (const Value& each : list->table()->list) {
      if (each.string() == nullptr) {
        complain("expected a string, found " + each.toLua(), fmt::format("{}[{}]", key, found.size() + 1));
        return found;
      }
      found.push_back(*each.string());
    }
    return found;
  }

  void readVersion(const Value& version) {
    static const Schema schema({{"major", Type::Integer, "1", true}, {"minor", Type::Integer, "0 or more", true, 0.0}});
    if (check(version, schema, "version") && *numberIn(version, "major") != 1.0) {
      complain(fmt::format("version {} is not known", *numberIn(version, "major")), "version.major",
               "profiles of version 1 can be read");
    }
  }

  void readDeltaTimes(const Value& root, Profile& profile) {
    if (const Value* list = root.find("delta_times")) {
      const auto numbers = list->numbers();
      if (!numbers || !list->table()->fields.empty()) {
        complain("expected a list of numbers", "delta_times");
      }
      profile.deltaTimes = numbers.value_or(std::vector<double>());
    }
  }

  void readMeta(const Value& root, Profile& profile) {
    static const Schema schema({{"name", Type::String, "the profile's name"},
                                {"version", Type::String, "of the profile"},
                                {"description", Type::String, "what it shows"},
                                {"author", Type::String, "who made it"},
                                {"url", Type::String, "where it is from"},
                                {"license", Type::String, "how it may be used"}});
    if (const Value* meta = root.find("meta"); meta != nullptr && check(*meta, schema, "meta")) {
      profile.name = textIn(*meta, "name");
    }
    for (const std::string key : {"panel_visibility", "ui_panel_visibility"}) {
      const Value* panels = root.find(key);
      for (const auto& [panel, shown] : panels != nullptr ? panels->table()->fields : Table().fields) {
        if (!shown.boolean()) {
          complain("expected true or false", fmt::format("{}.{}", key, panel));
        }
      }
    }
  }

  void readTime(const Value& time, Profile& profile) {
    static const Schema schema(
        {Field{"type", Type::String, "how the value counts", true, {}, {}, {"absolute", "relative"}},
         Field{"value", Type::String, "a date, or a number and a unit", true},
         Field{"is_paused", Type::Boolean, "whether time stands still"}});
    if (check(time, schema, "time")) {
      profile.time =
          Profile::StartTime{textIn(time, "type") == "relative", textIn(time, "value"), flagIn(time, "is_paused")};
    }
  }

  std::optional<glm::dvec3> vector(const Value& table, const std::string& key, const std::string& path) {
    static const Schema schema(
        {{"x", Type::Number, "", true}, {"y", Type::Number, "", true}, {"z", Type::Number, "", true}});
    const Value* value = table.find(key);
    if (value == nullptr || !check(*value, schema, path + '.' + key)) {
      return std::nullopt;
    }
    return glm::dvec3(*numberIn(*value, "x"), *numberIn(*value, "y"), *numberIn(*value, "z"));
  }

  void readCamera(const Value& camera, Profile& profile) {
    static const Schema geo({{"type", Type::String, "goToGeo", true},
                             {"anchor", Type::String, "identifier of a globe", true},
                             {"latitude", Type::Number, "degrees", true, -90.0, 90.0},
                             {"longitude", Type::Number, "degrees", true, -360.0, 360.0},
                             {"altitude", Type::Number, "metres"}});
    static const Schema node({{"type", Type::String, "goToNode", true},
                              {"anchor", Type::String, "identifier of a node", true},
                              {"height", Type::Number, "metres"}});
    static const Schema state({{"type", Type::String, "setNavigationState", true},
                               {"anchor", Type::String, "identifier of a node", true},
                               {"aim", Type::String, "identifier of the node that is looked at"},
                               {"frame", Type::String, "identifier of the node whose axes are meant"},
                               {"position", Type::Table, "x, y and z in metres", true},
                               {"up", Type::Table, "x, y and z"},
                               {"yaw", Type::Number, "radians"},
                               {"pitch", Type::Number, "radians"}});
    const std::string type = textIn(camera, "type");
    if (type == "goToGeo") {
      if (check(camera, geo, "camera")) {
        profile.camera = Profile::GoToGeo{textIn(camera, "anchor"), *numberIn(camera, "latitude"),
                                          *numberIn(camera, "longitude"), numberIn(camera, "altitude")};
      }
    } else if (type == "goToNode") {
      if (check(camera, node, "camera")) {
        profile.camera = Profile::GoToNode{textIn(camera, "anchor"), numberIn(camera, "height")};
      }
    } else if (type == "setNavigationState") {
      if (check(camera, state, "camera")) {
        const auto position = vector(camera, "position", "camera");
        const auto up = vector(camera, "up", "camera");
        profile.camera = Profile::SetNavigationState{textIn(camera, "anchor"),
                                                     textIn(camera, "aim"),
                                                     textIn(camera, "frame"),
                                                     position.value_or(glm::dvec3(0.0)),
                                                     up,
                                                     numberIn(camera, "yaw").value_or(0.0),
                                                     numberIn(camera, "pitch").value_or(0.0)};
      }
    } else {
      complain(fmt::format("unknown type \"{}\"", type), "camera.type",
               "use one of: goToGeo, goToNode, setNavigationState");
    }
  }

  void readLists(const Value& root, Profile& profile) {
    static const Schema property(
        {Field{"type", Type::String, "how it is set", true, {}, {}, {"setPropertyValue", "setPropertyValueSingle"}},
         Field{"name", Type::String, "its address, or a pattern", true},
         Field{"value", Type::String, "a value of Lua, in a string", true}});
    forEach(root, "properties", property, [&](const Value& each, const std::string&) {
      profile.properties.push_back(
          {textIn(each, "type") == "setPropertyValueSingle", textIn(each, "name"), textIn(each, "value")});
    });
    static const Schema action({{"identifier", Type::String, "its name in scripts", true},
                                {"script", Type::String, "what it does", true},
                                {"name", Type::String, "its name for people"},
                                {"documentation", Type::String, "about it"},
                                {"gui_path", Type::String, "where it is shown"},
                                {"is_local", Type::Boolean, "whether it is for this computer alone"}});
    forEach(root, "actions", action, [&](const Value& each, const std::string&) {
      profile.actions.push_back({textIn(each, "identifier"), textIn(each, "name"), textIn(each, "documentation"),
                                 textIn(each, "gui_path"), flagIn(each, "is_local"), textIn(each, "script")});
    });
    readKeyBindings(root, profile);
    static const Schema module({{"name", Type::String, "the module's name", true},
                                {"loadedInstruction", Type::String, "a script"},
                                {"notLoadedInstruction", Type::String, "a script"}});
    forEach(root, "modules", module, [&](const Value& each, const std::string&) {
      profile.modules.push_back(
          {textIn(each, "name"), textIn(each, "loadedInstruction"), textIn(each, "notLoadedInstruction")});
    });
  }

  /// Up to version 1.0 a key had its script with it.
  void readKeyBindings(const Value& root, Profile& profile) {
    static const Schema schema({{"key", Type::String, "such as Ctrl+H", true},
                                {"action", Type::String, "identifier of an action"},
                                {"script", Type::String, "what it does, without an action"},
                                {"name", Type::String, "its name for people"},
                                {"documentation", Type::String, "about it"},
                                {"gui_path", Type::String, "where it is shown"},
                                {"is_local", Type::Boolean, "whether it is for this computer alone"}});
    forEach(root, "keybindings", schema, [&](const Value& each, const std::string& path) {
      std::string identifier = textIn(each, "action");
      const std::string script = textIn(each, "script");
      if (identifier.empty() && script.empty()) {
        complain("the required key action is missing", path + ".action", "name an action");
        return;
      }
      if (identifier.empty()) {
        identifier = fmt::format("profile.keybind.{}", profile.keyBindings.size() + 1);
        profile.actions.push_back({identifier, textIn(each, "name"), textIn(each, "documentation"),
                                   textIn(each, "gui_path"), flagIn(each, "is_local"), script});
      }
      profile.keyBindings.push_back({textIn(each, "key"), std::move(identifier)});
    });
  }

  static const Schema& addonSchema() {
    static const Schema schema({{"version", Type::Table, "major and minor"},
                                {"identifier", Type::String, "its name in files"},
                                {"name", Type::String, "its name for people"},
                                {"description", Type::String, "about it"},
                                {"assets", Type::Table, "paths of assets", true}});
    return schema;
  }

  void addAssets(const std::vector<std::string>& more, Profile& profile) {
    profile.assets.insert(profile.assets.end(), more.begin(), more.end());
  }

  void readAddons(const Value& addons, Profile& profile) {
    static const Schema schema(
        {{"recommended", Type::Table, "names of .addon files"}, {"custom", Type::Table, "addons written here"}});
    if (!check(addons, schema, "addons")) {
      return;
    }
    for (const std::string& name : texts(addons, "recommended")) {
      readAddonFile(name, profile);
    }
    forEach(addons, "custom", addonSchema(),
            [&](const Value& each, const std::string&) { addAssets(texts(each, "assets"), profile); });
  }

  void readAddonFile(const std::string& name, Profile& profile) {
    std::error_code ignored;
    for (fs::path folder = fs::absolute(file_, ignored).parent_path();; folder = folder.parent_path()) {
      if (const fs::path file = folder / (name + ".addon"); fs::is_regular_file(file, ignored)) {
        ProfileReader reader(file);
        const Result<Value> root = parse(file);
        if (!root) {
          errors_.push_back(root.error());
        } else if (reader.check(*root, addonSchema(), "")) {
          addAssets(reader.texts(*root, "assets"), profile);
        }
        errors_.insert(errors_.end(), reader.errors_.begin(), reader.errors_.end());
        return;
      }
      if (folder == folder.parent_path()) {
        complain(fmt::format("there is no file {}.addon", name), "addons.recommended",
                 "put it beside the profile or into a folder above");
        return;
      }
    }
  }

  fs::path file_;
  std::vector<Error> errors_;
};

}  // namespace

tl::expected<Profile, std::vector<Error>> readProfile(const fs::path& file) {
  Profile profile;
  ProfileReader reader(file);
  reader.read(profile);
  if (!reader.errors().empty()) {
    return tl::make_unexpected(reader.errors());
  }
  return profile;
}

bool isProfile(const fs::path& file) {
  return file.extension() == ".profile";
}

}  // namespace meridian::assets
