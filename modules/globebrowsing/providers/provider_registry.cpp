#include "globebrowsing/providers/provider_registry.h"

#include <algorithm>
#include <array>

#include "globebrowsing/providers/default_tile_provider.h"
#include "globebrowsing/providers/graticule_tile_provider.h"
#include "globebrowsing/providers/image_sequence_tile_provider.h"
#include "globebrowsing/providers/relief_provider.h"
#include "globebrowsing/providers/single_image_provider.h"
#include "globebrowsing/providers/size_reference_tile_provider.h"
#include "globebrowsing/providers/solid_colour_provider.h"
#include "globebrowsing/providers/temporal_document.h"
#include "globebrowsing/providers/temporal_tile_provider.h"
#include "globebrowsing/providers/tile_index_tile_provider.h"
#include "globebrowsing/providers/tile_provider_by_date.h"
#include "globebrowsing/providers/tile_provider_by_index.h"
#include "globebrowsing/providers/tile_provider_by_level.h"
#include "globebrowsing/source/service_description.h"

namespace meridian::globebrowsing {

namespace {

std::string namesOfProviders() {
  std::string names;
  for (const ProviderType& type : providerTypes()) {
    names.append(names.empty() ? "" : ", ").append(name(type.type));
  }
  return names;
}

template <class Provider>
ProviderType typeOf(LayerType type, std::string description) {
  return {type, std::move(description), &Provider::schema(), &Provider::make};
}

const ProviderType* find(LayerType type) {
  const std::span<const ProviderType> types = providerTypes();
  const auto found = std::find_if(types.begin(), types.end(), [type](const auto& one) { return one.type == type; });
  return found == types.end() ? nullptr : &*found;
}

}  // namespace

std::span<const ProviderType> providerTypes() {
  static const std::array types{
      typeOf<DefaultTileProvider>(LayerType::DefaultTileProvider, "any georeferenced raster"),
      typeOf<SingleImageProvider>(LayerType::SingleImageProvider, "the whole of one image in every tile"),
      typeOf<ImageSequenceTileProvider>(LayerType::ImageSequenceTileProvider, "one image of a folder at a time"),
      typeOf<SizeReferenceTileProvider>(LayerType::SizeReferenceTileProvider, "in each tile how wide it is"),
      typeOf<TemporalTileProvider>(LayerType::TemporalTileProvider, "another raster for each time"),
      typeOf<TileIndexTileProvider>(LayerType::TileIndexTileProvider, "in each tile its index"),
      typeOf<TileProviderByDate>(LayerType::TileProviderByDate, "a provider for each stretch of time"),
      typeOf<TileProviderByIndex>(LayerType::TileProviderByIndex, "a provider for most tiles, others for some"),
      typeOf<TileProviderByLevel>(LayerType::TileProviderByLevel, "a provider for each range of levels"),
      typeOf<SolidColourProvider>(LayerType::SolidColor, "one colour everywhere"),
      typeOf<GraticuleTileProvider>(LayerType::GraticuleTileProvider, "parallels and meridians"),
      ProviderType{LayerType::ColorRelief, "heights by a colour ramp", &RampProvider::schema(),
                   &RampProvider::makeColourRelief},
      typeOf<HillshadeProvider>(LayerType::Hillshade, "relief in a light of its own"),
      ProviderType{LayerType::Slope, "the slope by a colour ramp", &RampProvider::schema(), &RampProvider::makeSlope},
      typeOf<IsolinesProvider>(LayerType::Isolines, "lines of equal height")};
  return types;
}

const Schema& providerSchema(LayerType type) {
  return *find(type)->schema;
}

std::string placeOf(const ProviderRequest& request, std::string_view key) {
  std::string place = request.where;
  place.append(place.empty() || request.path.empty() ? "" : ": ").append(request.path);
  return place.append(request.path.empty() || key.empty() ? "" : ".").append(key);
}

Result<LayerType> layerTypeOf(const ProviderRequest& request) {
  // Older assets hide a temporal layer in the text of its FilePath.
  const Value* filePath = request.table.find("FilePath");
  if (filePath != nullptr && filePath->string() != nullptr && isTemporalDocument(*filePath->string())) {
    return LayerType::TemporalTileProvider;
  }
  const Value* value = request.table.find("Type");
  if (value == nullptr || value->isNil()) {
    const bool isTemporal = filePath != nullptr && filePath->string() != nullptr && mayHaveTimes(*filePath->string());
    return isTemporal ? LayerType::TemporalTileProvider : LayerType::DefaultTileProvider;
  }
  const std::string* typeName = value->string();
  if (typeName == nullptr) {
    return failure("expected a string, found " + std::string(kindName(value->kind())), placeOf(request, "Type"),
                   "use one of: " + namesOfProviders());
  }
  const std::optional<LayerType> type = layerTypeFromName(*typeName);
  if (!type) {
    return failure("unknown layer type \"" + *typeName + '"', placeOf(request, "Type"),
                   "use one of: " + namesOfProviders());
  }
  if (find(*type) == nullptr) {
    const std::string_view why = *type == LayerType::VideoTileProvider    ? " are not available: no videos are played"
                                 : *type == LayerType::SpoutImageProvider ? " are not available: Spout is for Windows"
                                                                          : " are not supported";
    return failure("layers of type " + std::string(name(*type)) + std::string(why), placeOf(request, "Type"),
                   "use one of: " + namesOfProviders());
  }
  return *type;
}

Result<std::shared_ptr<TileProvider>> makeProvider(const ProviderRequest& request) {
  const Result<LayerType> type = layerTypeOf(request);
  if (!type) {
    return tl::make_unexpected(type.error());
  }
  const ProviderType& provider = *find(*type);
  if (Result<void> valid = provider.schema->validate(request.table, request.where, request.path); !valid) {
    return tl::make_unexpected(std::move(valid.error()));
  }
  return provider.make(request);
}

}  // namespace meridian::globebrowsing
