#include "globebrowsing/patch_scripts.h"

#include <algorithm>
#include <cctype>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "globebrowsing/script_arguments.h"
#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

namespace fs = std::filesystem;

using Arguments = std::span<const Value>;

constexpr std::size_t mostFiles = 100'000;
/// What OpenSpace gives the heights of patches.
constexpr int heightTileSize = 65;

std::string textIn(const Value& table, std::string_view key) {
  const Value* value = table.find(key);
  return value != nullptr && value->string() != nullptr ? *value->string() : std::string();
}

/// A layer's table for the file that the key names; nil without.
Value layerTable(const Value& info, const PatchInfo& patch, const fs::path& folder, std::string_view fileKey) {
  const std::string file = textIn(info, fileKey);
  if (file.empty()) {
    return {};
  }
  Table layer{{},
              {{"Identifier", patch.identifier},
               {"Name", patch.name},
               {"Description", textIn(info, "Description")},
               {"FilePath", (folder / file).lexically_normal().string()}}};
  if (const Value* zIndex = info.find("ZIndex")) {
    layer.fields.emplace("ZIndex", *zIndex);
  }
  return layer;
}

std::string asIdentifier(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c == '.' || std::isspace(c) != 0; }, '_');
  return name;
}

/// All `.info` files below a folder, sorted; none for a folder that is not there.
Result<std::vector<fs::path>> infoFiles(const Host& host, const Value& folder) {
  const auto root = text(folder, "folder").and_then([&](const std::string& path) { return host.readablePath(path); });
  std::vector<fs::path> files;
  std::error_code error;
  if (!root || !fs::is_directory(*root, error)) {
    log::info("there is no folder {} of patches", folder.string() != nullptr ? *folder.string() : folder.toLua());
    return files;
  }
  fs::recursive_directory_iterator entries(*root, fs::directory_options::skip_permission_denied, error);
  for (; !error && entries != fs::recursive_directory_iterator() && files.size() < mostFiles;
       entries.increment(error)) {
    std::error_code ignored;
    if (entries->path().extension() == ".info" && entries->is_regular_file(ignored)) {
      files.push_back(entries->path());
    }
  }
  if (error) {
    return failure(fmt::format("the folder cannot be read: {}", error.message()), root->string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// Does something with every patch below a folder.
template <class Use>
ScriptResult forEachPatch(Host& host, Arguments arguments, Use use) {
  if (const auto found = globe(host, arguments[1]); !found) {
    return tl::make_unexpected(found.error());
  }
  const auto files = infoFiles(host, arguments[0]);
  if (!files) {
    return tl::make_unexpected(files.error());
  }
  for (const fs::path& file : *files) {
    const Result<void> done =
        readPatchInfo(host, file).and_then([&](const PatchInfo& patch) -> Result<void> { return use(patch); });
    if (!done) {
      log::error("{}", done.error().message());
    }
  }
  return none({});
}

ScriptResult addLayers(Host& host, Arguments arguments) {
  return forEachPatch(host, arguments, [&](const PatchInfo& patch) -> Result<void> {
    if (patch.colour.isTable()) {
      if (auto added = addLayerFromScript(host, arguments[1], "ColorLayers", patch.colour); !added) {
        return added;
      }
    }
    return patch.height.isTable() ? addLayerFromScript(host, arguments[1], "HeightLayers", patch.height)
                                  : Result<void>();
  });
}

struct FocusPlace {
  std::string name;
  std::string globe;
  double latitude = 0.0;   ///< degrees
  double longitude = 0.0;  ///< degrees
  double altitude = 0.0;   ///< metres
};

Result<void> addFocusNode(Host& host, const FocusPlace& place) {
  const Value translation = Table{{},
                                  {{"Type", "GlobeTranslation"},
                                   {"Globe", place.globe},
                                   {"Latitude", place.latitude},
                                   {"Longitude", place.longitude},
                                   {"Altitude", place.altitude},
                                   {"UseHeightmap", place.altitude == 0.0}}};
  const std::string identifier = asIdentifier(place.name);
  return host.addSceneGraphNode(
      Table{{},
            {{"Identifier", identifier},
             {"Parent", place.globe},
             {"Transform", Table{{}, {{"Translation", translation}}}},
             {"GUI", Table{{}, {{"Name", place.name}, {"Path", "/Other/Bookmarks/" + place.globe}}}}}});
}

ScriptResult addFocusNodes(Host& host, Arguments arguments) {
  return forEachPatch(host, arguments, [&](const PatchInfo& patch) -> Result<void> {
    if (!patch.centreDegrees) {
      return {};
    }
    return addFocusNode(host,
                        {patch.name, *arguments[1].string(), patch.centreDegrees->y, patch.centreDegrees->x, 0.0});
  });
}

ScriptResult addFocusNodeAt(Host& host, Arguments arguments) {
  const auto name = text(arguments[0], "name");
  const auto found = globe(host, arguments[1]);
  const auto latitude = number(arguments[2], "latitude");
  const auto longitude = number(arguments[3], "longitude");
  const auto altitude = arguments.size() > 4 ? number(arguments[4], "altitude") : Result<double>(0.0);
  if (!name || !found) {
    return tl::make_unexpected(!name ? name.error() : found.error());
  }
  for (const auto* each : {&latitude, &longitude, &altitude}) {
    if (!*each) {
      return tl::make_unexpected(each->error());
    }
  }
  return none(addFocusNode(host, {*name, *arguments[1].string(), *latitude, *longitude, *altitude}));
}

ScriptResult parseInfoFile(const Host& host, Arguments arguments) {
  const auto patch = text(arguments[0], "file")
                         .and_then([&](const std::string& path) { return host.readablePath(path); })
                         .and_then([&](const fs::path& file) { return readPatchInfo(host, file); });
  if (!patch) {
    return tl::make_unexpected(patch.error());
  }
  Table table{{}, {{"Identifier", patch->identifier}, {"Name", patch->name}}};
  for (const auto& [key, value] :
       {std::pair{"Color", patch->colour}, {"Height", patch->height}, {"Location", patch->location}}) {
    if (!value.isNil()) {
      table.fields.emplace(key, value);
    }
  }
  return std::vector<Value>{std::move(table)};
}

}  // namespace

Result<PatchInfo> readPatchInfo(const Host& host, const fs::path& file) {
  const Result<Value> info = host.readLuaData(file);
  if (!info) {
    return tl::make_unexpected(info.error());
  }
  PatchInfo patch;
  patch.name = textIn(*info, "Name");
  patch.identifier = textIn(*info, "Identifier");
  patch.identifier = patch.identifier.empty() ? asIdentifier(patch.name) : patch.identifier;
  patch.name = patch.name.empty() ? patch.identifier : patch.name;
  if (patch.identifier.empty()) {
    return failure("the file gives neither Identifier nor Name", file.string(), "set both as strings");
  }
  const fs::path folder = file.parent_path();
  patch.colour = layerTable(*info, patch, folder, "ColorFile");
  patch.height = layerTable(*info, patch, folder, "HeightFile");
  if (const Table* colour = patch.colour.table()) {
    Table blended = *colour;
    const std::string mode = textIn(*info, "BlendMode");
    blended.fields.emplace("BlendMode", mode.empty() ? "Color" : mode);
    patch.colour = std::move(blended);
  }
  if (const Table* height = patch.height.table()) {
    Table sized = *height;
    sized.fields.emplace("TilePixelSize", heightTileSize);
    patch.height = std::move(sized);
  }
  if (const Value* location = info->find("Location")) {
    patch.location = *location;
    const Value* centre = location->find("Center");
    if (const auto degrees = centre != nullptr ? centre->numbers(2) : std::nullopt) {
      patch.centreDegrees = glm::dvec2((*degrees)[0], (*degrees)[1]);
    }
  }
  return patch;
}

std::vector<ScriptFunction> patchFunctions(Host& host) {
  return {{"parseInfoFile", "file", "What a patch's file says, as tables of layers", 1, 1,
           [&host](Arguments a) { return parseInfoFile(host, a); }},
          {"addBlendingLayersFromDirectory", "folder, globe", "Adds the layers of all patches below a folder", 2, 2,
           [&host](Arguments a) { return addLayers(host, a); }},
          {"addFocusNodesFromDirectory", "folder, globe", "Adds a node at each patch below a folder", 2, 2,
           [&host](Arguments a) { return addFocusNodes(host, a); }},
          {"addFocusNodeFromLatLong", "name, globe, latitude, longitude, altitude?", "Adds a node at a place", 4, 5,
           [&host](Arguments a) { return addFocusNodeAt(host, a); }}};
}

}  // namespace meridian::globebrowsing
