#include "globebrowsing/source/service_asset.h"

#include <cctype>

#include <fmt/format.h>

#include "globebrowsing/source/capabilities_parts.h"
#include "globebrowsing/source/capabilities_reference.h"
#include "globebrowsing/source/gdal_wms_writer.h"

namespace meridian::globebrowsing {

namespace {

/// Letters, digits and underscores: what a node of the property tree may be called.
std::string identifierOf(const std::string& name) {
  std::string identifier;
  for (const char c : name) {
    identifier += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return identifier.empty() ? "Layer" : identifier;
}

std::string descriptionOf(const CapabilitiesLayer& layer) {
  return layer.attribution.empty() ? layer.abstract : joined({layer.abstract, layer.attribution}, " -- ");
}

Result<std::string> filePathOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                               const LayerChoices& choices, const TileService& service) {
  const bool areMaps = layer.matrixSets.empty();
  const bool mayFollowTime =
      capabilities.kind == CapabilitiesKind::Wmts || (areMaps && capabilities.kind == CapabilitiesKind::Wms);
  const bool followsTime = mayFollowTime && layer.timeDimension() != nullptr && choices.time.empty();
  if (areMaps && capabilities.kind == CapabilitiesKind::Wms) {
    if (auto document = gdalWmsOfMaps(capabilities, service, followsTime)) {
      return document;
    }
  } else if (!areMaps && !followsTime) {
    if (auto document = gdalWmsOf(service)) {
      return document;
    }
  }
  return writeReference(capabilities, layer, choices);
}

}  // namespace

std::string layersAsset(const std::string& globe, std::span<const PlacedLayer> layers) {
  std::string tables;
  std::string added;
  std::string deleted;
  std::string exported;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const std::string name = layers.size() == 1 ? "layer" : fmt::format("layer{}", i + 1);
    const std::string arguments =
        fmt::format("({}, {}, {})", Value(globe).toLua(), Value(layers[i].group).toLua(), name);
    tables += fmt::format("local {} = {}\n\n", name, layers[i].table.toLua());
    added += "  openspace.globebrowsing.addLayer" + arguments + '\n';
    deleted.insert(0, "  openspace.globebrowsing.deleteLayer" + arguments + '\n');
    exported += fmt::format("asset.export(\"{}\", {})\n", name, name);
  }
  return fmt::format("{}asset.onInitialize(function()\n{}end)\n\nasset.onDeinitialize(function()\n{}end)\n\n{}", tables,
                     added, deleted, exported);
}

Result<LayerAsset> assetOf(const Capabilities& capabilities, const CapabilitiesLayer& layer,
                           const LayerChoices& choices, const AssetPlace& place) {
  auto service = serviceOf(capabilities, layer, choices);
  if (!service) {
    return tl::make_unexpected(std::move(service.error()));
  }
  const auto path = filePathOf(capabilities, layer, choices, *service);
  if (!path) {
    return tl::make_unexpected(path.error());
  }
  Table table;
  // ArcGIS numbers its layers.
  const bool hasName = !layer.identifier.empty() && capabilities.kind != CapabilitiesKind::ArcGis;
  table.fields["Identifier"] = identifierOf(hasName ? layer.identifier : layer.title);
  table.fields["Name"] = layer.title;
  table.fields["Description"] = descriptionOf(layer);
  if (!service->attribution.empty()) {
    table.fields["Attribution"] = service->attribution;
  }
  table.fields["FilePath"] = *path;
  table.fields["Enabled"] = true;
  LayerAsset asset;
  asset.table = Value(std::move(table));
  const PlacedLayer placed{asset.table, place.group};
  asset.text = layersAsset(place.globe, {&placed, 1});
  return asset;
}

}  // namespace meridian::globebrowsing
