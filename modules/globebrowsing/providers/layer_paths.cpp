#include "globebrowsing/providers/layer_paths.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "globebrowsing/providers/default_tile_provider.h"

namespace meridian::globebrowsing {

namespace {

/// A provider with a path of its own names its key here. None of the other tables of a layer has a key of these names.
constexpr std::array<std::string_view, 6> pathKeys{"FilePath",  "FolderPath",    "Folder",
                                                   "Prototype", "ColorRampFile", "Colormap"};

}  // namespace

Value withPaths(const Value& table, const std::function<std::string(const std::string&)>& change) {
  if (!table.isTable()) {
    return table;
  }
  Table changed = *table.table();
  for (Value& item : changed.list) {
    item = withPaths(item, change);
  }
  for (auto& [key, value] : changed.fields) {
    const std::string* text = value.string();
    if (text == nullptr) {
      value = withPaths(value, change);
    } else if (!text->empty() && std::find(pathKeys.begin(), pathKeys.end(), key) != pathKeys.end()) {
      value = change(*text);
    }
  }
  return changed;
}

Value withWholePaths(const Value& table, const std::string& folder) {
  return withPaths(table, [&](const std::string& path) { return dataPath(path, folder).text; });
}

}  // namespace meridian::globebrowsing
