#include "globebrowsing/layers_file.h"

#include <fstream>
#include <system_error>

#include "globebrowsing/script_arguments.h"
#include "globebrowsing/source/service_asset.h"

namespace meridian::globebrowsing {

std::vector<Layer*> usersLayers(RenderableGlobe& globe) {
  std::vector<Layer*> found;
  for (const LayerGroupId id : allLayerGroups) {
    for (const auto& layer : globe.layers().group(id).layers()) {
      if (layer->isUsers()) {
        found.push_back(layer.get());
      }
    }
  }
  return found;
}

Result<std::filesystem::path> writeLayersFile(Host& host, const std::string& node, const std::string& path) {
  const Result<RenderableGlobe*> found = globe(host, node);
  if (!found) {
    return tl::make_unexpected(found.error());
  }
  std::vector<PlacedLayer> placed;
  for (const Layer* layer : usersLayers(**found)) {
    placed.push_back({layer->table(), std::string(name(layer->group()))});
  }
  if (placed.empty()) {
    return failure("no layers were added to " + node, {}, "add some by the map servers' panel or by addLayer");
  }
  return host.writablePath(path).and_then([&](const std::filesystem::path& file) -> Result<std::filesystem::path> {
    std::error_code ignored;
    std::filesystem::create_directories(file.parent_path(), ignored);
    std::ofstream stream(file, std::ios::binary | std::ios::trunc);
    stream << layersAsset(node, placed);
    stream.close();
    if (!stream) {
      return failure("the asset cannot be written", file.string(), "check the folder, its permissions and the disk");
    }
    return file;
  });
}

std::vector<ScriptFunction> layersFileFunctions(Host& host) {
  return {{"writeLayers", "globe, file", "Writes an asset of the layers that were added to a globe while it runs", 2, 2,
           [&host](std::span<const Value> arguments) -> ScriptResult {
             const Result<std::string> node = text(arguments[0], "globe");
             const Result<std::string> file = text(arguments[1], "file");
             if (!node || !file) {
               return tl::make_unexpected(node ? file.error() : node.error());
             }
             return writeLayersFile(host, *node, *file).map([](const std::filesystem::path& written) {
               return std::vector<Value>{written.string()};
             });
           }}};
}

}  // namespace meridian::globebrowsing
