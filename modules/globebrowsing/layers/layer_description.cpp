#include "globebrowsing/layers/layer_description.h"

#include <algorithm>
#include <utility>

#include "globebrowsing/providers/tiles_table.h"
#include "globebrowsing/source/service_text.h"

namespace meridian::globebrowsing {

namespace {

using Type = Schema::Type;

std::optional<double> numberAt(const Value& table, std::string_view key) {
  const Value* value = table.find(key);
  return value == nullptr ? std::nullopt : value->number();
}

std::string stringAt(const Value& table, std::string_view key) {
  const Value* value = table.find(key);
  return value == nullptr || value->string() == nullptr ? std::string() : *value->string();
}

std::optional<glm::dvec3> vectorAt(const Value& table, std::string_view key) {
  const Value* value = table.find(key);
  const auto numbers = value == nullptr ? std::nullopt : value->numbers(3);
  return numbers ? std::optional(glm::dvec3((*numbers)[0], (*numbers)[1], (*numbers)[2])) : std::nullopt;
}

Schema::Field numberField(std::string key, std::string description, const NumberRange& range) {
  return {std::move(key), Type::Number, std::move(description), false, range.minimum, range.maximum};
}

/// The sub-table of that key if it is there and fits the schema; null if it is not there.
Result<const Value*> subTable(const ProviderRequest& request, const std::string& key, const Schema& schema) {
  const Value* value = request.table.find(key);
  if (value == nullptr || value->isNil()) {
    return nullptr;
  }
  const std::string path = request.path.empty() ? key : request.path + '.' + key;
  return schema.validate(*value, request.where, path).map([value] { return value; });
}

Result<void> readSettings(const ProviderRequest& request, LayerDescription& layer) {
  return subTable(request, "Settings", layerSettingsSchema()).map([&](const Value* table) {
    if (table != nullptr) {
      layer.settings = {numberAt(*table, "Gamma").value_or(1.0), numberAt(*table, "Multiplier").value_or(1.0),
                        numberAt(*table, "Offset").value_or(0.0)};
    }
  });
}

Result<void> readAdjustment(const ProviderRequest& request, LayerDescription& layer) {
  return subTable(request, "Adjustment", layerAdjustmentSchema()).map([&](const Value* table) {
    if (table != nullptr) {
      layer.adjustment = adjustmentFromName(stringAt(*table, "Type")).value_or(Adjustment::None);
      layer.chromaKeyColour = vectorAt(*table, "ChromaKeyColor").value_or(layer.chromaKeyColour);
      layer.chromaKeyTolerance = numberAt(*table, "ChromaKeyTolerance").value_or(layer.chromaKeyTolerance);
    }
  });
}

void readCommon(const Value& table, BlendMode mode, LayerDescription& layer) {
  layer.identifier = stringAt(table, "Identifier");
  layer.name = stringAt(table, "Name");
  layer.description = stringAt(table, "Description");
  layer.attribution = creditText(stringAt(table, "Attribution"));
  if (const Value* enabled = table.find("Enabled")) {
    layer.enabled = enabled->boolean().value_or(false);
  }
  if (const auto zIndex = numberAt(table, "ZIndex")) {
    layer.zIndex = static_cast<int>(*zIndex);
  }
  layer.opacity = numberAt(table, "Opacity").value_or(layer.opacity);
  layer.colour = vectorAt(table, "Color").value_or(layer.colour);
  layer.blendMode = blendModeFromName(stringAt(table, "BlendMode")).value_or(mode);
}

}  // namespace

const Schema& layerSchema() {
  static const Schema schema({
      {"Identifier", Type::Identifier, "the layer's name in scripts, unique in its group", true},
      {"Name", Type::String, "the layer's name for people"},
      {"Description", Type::String, "what the layer shows, for people"},
      {"Attribution", Type::String, "whom its data are to be credited to, in place of what they say themselves"},
      {"Type", Type::String, "where the layer's data come from; DefaultTileProvider when absent"},
      {"Enabled", Type::Boolean, "whether the layer is shown from the start"},
      {"ZIndex", Type::Integer, "the drawing order: higher is later, on top", false, 1.0, 2147483647.0},
      numberField("Opacity", "0 is invisible, 1 opaque", opacityRange),
      {"Color", Type::Vector3, "red, green and blue of a SolidColor layer", false, 0.0, 1.0},
      {"Settings", Type::Table, "Gamma, Multiplier and Offset of the layer's values"},
      {"Adjustment", Type::Table, "what is done to the layer's colours before its settings"},
      {"BlendMode", Type::String, "how the layer is put onto those below", false, {}, {}, blendModeNames()},
  });
  return schema;
}

const Schema& layerSettingsSchema() {
  static const Schema schema({numberField("Gamma", "exponent of a value's magnitude", gammaRange),
                              numberField("Multiplier", "factor, after the exponent", multiplierRange),
                              numberField("Offset", "added at last", offsetRange)});
  return schema;
}

const Schema& layerAdjustmentSchema() {
  static const Schema schema({
      {"Type", Type::String, "which adjustment", false, {}, {}, {"None", "ChromaKey", "TransferFunction"}},
      {"ChromaKeyColor", Type::Vector3, "the colour that becomes transparent", false, 0.0, 1.0},
      {"ChromaKeyTolerance", Type::Number, "how far from it colours still do, in 0..1", false, 0.0, 1.0},
  });
  return schema;
}

Error noteOf(const UnknownKey& unknown, const std::string& where) {
  return {"unknown key " + unknown.key + (unknown.meant.empty() ? "" : ", did you mean " + unknown.meant), where};
}

std::vector<Error> unknownLayerKeys(const ProviderRequest& request) {
  // Those that did something once or do so in OpenSpace, those that the host adds, and older names of others.
  static constexpr std::string_view ignored[] = {"PadTiles",        "Fallback",          "GlobeName",
                                                 "LayerGroupID",    "CacheSettings",     "PerformPreProcessing",
                                                 "DefaultProvider", "IndexTileProviders"};
  std::vector<Error> notes;
  const std::span<const ProviderType> types = providerTypes();
  const Result<LayerType> type = layerTypeOf(request);
  const auto provider =
      std::find_if(types.begin(), types.end(), [&](const auto& one) { return type && one.type == *type; });
  if (provider != types.end()) {
    // Their steps are rasters with the keys of the layer.
    const bool hasRasters = *type == LayerType::TemporalTileProvider || *type == LayerType::ImageSequenceTileProvider;
    const Schema& raster = hasRasters ? providerSchema(LayerType::DefaultTileProvider) : *provider->schema;
    for (const UnknownKey& unknown : unknownKeys(request.table, {&layerSchema(), provider->schema, &raster}, ignored)) {
      notes.push_back(noteOf(unknown, placeOf(request, {})));
    }
    for (const UnknownTilesKey& unknown : unknownTilesKeys(request)) {
      notes.push_back(noteOf(unknown.key, unknown.where));
    }
  }
  return notes;
}

Result<LayerDescription> readLayer(const ProviderRequest& request, LayerGroupId group, BlendMode mode) {
  LayerDescription layer;
  layer.request = request;
  const auto checkType = [&] { return layerTypeOf(request).map([&](LayerType type) { layer.type = type; }); };
  const auto checkProvider = [&]() -> Result<void> {
    Result<std::shared_ptr<TileProvider>> provider = makeProvider(request);
    if (!provider) {
      return tl::make_unexpected(std::move(provider.error()));
    }
    if (group == LayerGroupId::HeightLayers && !(*provider)->hasTiles()) {
      return failure("a layer of type " + std::string(globebrowsing::name(layer.type)) + " has no heights",
                     placeOf(request, "Type"), "put it into a group of colours");
    }
    layer.provider = std::move(*provider);
    return {};
  };
  return layerSchema()
      .validate(request.table, request.where, request.path)
      .and_then(checkType)
      .and_then([&] { return readSettings(request, layer); })
      .and_then([&] { return readAdjustment(request, layer); })
      .and_then(checkProvider)
      .map([&] {
        readCommon(request.table, mode, layer);
        return std::move(layer);
      });
}

}  // namespace meridian::globebrowsing
