#include "host/assets/json_asset.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "host/assets/json_value.h"

namespace meridian::assets {

namespace {

Result<std::string> requirements(const Value& dependencies, const std::string& where) {
  std::string lua;
  for (const Value& each : dependencies.table()->list) {
    const std::string* path = each.string();
    if (path == nullptr || path->empty()) {
      return failure("expected the path of an asset, found " + each.toLua(), where + ": dependencies");
    }
    const bool isPlaced = path->starts_with('.') || path->starts_with('/') || path->starts_with("${");
    lua += fmt::format("asset.require({})\n", Value((isPlaced ? "" : "./") + *path).toLua());
  }
  return lua;
}

Result<std::string> nodes(const Value& list, const std::string& where) {
  std::string lua;
  std::string added;
  std::string removed;
  for (std::size_t i = 0; i < list.table()->list.size(); ++i) {
    const Value& node = list.table()->list[i];
    const Value* identifier = node.find("Identifier");
    if (identifier == nullptr || identifier->string() == nullptr) {
      return failure("the node has no Identifier", fmt::format("{}: scenegraphnodes[{}]", where, i + 1));
    }
    lua += fmt::format("local node{} = {}\nasset.export(node{})\n", i, node.toLua(), i);
    added += fmt::format("openspace.addSceneGraphNode(node{}) ", i);
    removed.insert(0, fmt::format("openspace.removeSceneGraphNode(node{}) ", i));
  }
  return lua +
         fmt::format("asset.onInitialize(function() {}end)\nasset.onDeinitialize(function() {}end)\n", added, removed);
}

std::string metadata(const Value& table) {
  static constexpr std::pair<std::string_view, std::string_view> keys[] = {{"name", "Name"},
                                                                           {"asset_version", "Version"},
                                                                           {"description", "Description"},
                                                                           {"author", "Author"},
                                                                           {"license", "License"}};
  Table meta;
  for (const auto& [json, lua] : keys) {
    if (const Value* found = table.find(json)) {
      meta.fields.emplace(lua, *found);
    }
  }
  return fmt::format("asset.meta = {}\n", Value(std::move(meta)).toLua());
}

}  // namespace

Result<std::string> luaFromJsonAsset(std::string_view text, const std::string& where) {
  const Result<Value> root = valueFromJson(text, where);
  if (!root) {
    return tl::make_unexpected(root.error());
  }
  if (!root->isTable() || !root->table()->list.empty()) {
    return failure("an asset in JSON is an object", where, "write { \"scenegraphnodes\": [ ... ] }");
  }
  std::string lua;
  for (const std::string_view key : {"metadata", "dependencies", "scenegraphnodes"}) {
    const Value* value = root->find(key);
    if (value == nullptr) {
      continue;
    }
    if (!value->isTable()) {
      return failure(
          fmt::format("expected {}, found {}", key == "metadata" ? "an object" : "an array", kindName(value->kind())),
          fmt::format("{}: {}", where, key));
    }
    Result<std::string> part = key == "metadata"       ? Result<std::string>(metadata(*value))
                               : key == "dependencies" ? requirements(*value, where)
                                                       : nodes(*value, where);
    if (!part) {
      return part;
    }
    lua += *part;
  }
  return lua;
}

}  // namespace meridian::assets
