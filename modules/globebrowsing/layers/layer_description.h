#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "globebrowsing/layers/blend.h"
#include "globebrowsing/layers/layer_group.h"
#include "globebrowsing/providers/provider_registry.h"
#include "host/api/error.h"
#include "host/api/property.h"
#include "host/api/schema.h"

namespace meridian::globebrowsing {

/// The ranges of a layer's numbers, for asset tables and properties alike. Assets go beyond OpenSpace's 0 to 20 for the
/// multiplier: a height map in 8 bits has 40 metres a step.
inline constexpr NumberRange opacityRange{0.0, 1.0};
inline constexpr NumberRange gammaRange{0.0, 5.0};
inline constexpr NumberRange multiplierRange{0.0, 1000.0};
inline constexpr NumberRange offsetRange{-10000.0, 10000.0};

/// A layer's asset table, read.
struct LayerDescription {
  std::string identifier;
  std::string name;
  std::string description;
  std::string attribution;  ///< on one line; empty: what the data say themselves
  LayerType type = LayerType::DefaultTileProvider;
  bool enabled = false;
  std::optional<int> zIndex;
  double opacity = 1.0;
  glm::dvec3 colour{1.0};
  LayerSettings settings;
  Adjustment adjustment = Adjustment::None;
  glm::dvec3 chromaKeyColour{0.0};
  double chromaKeyTolerance = 0.0;
  BlendMode blendMode = BlendMode::Normal;
  ProviderRequest request;                 ///< to make the provider again
  std::shared_ptr<TileProvider> provider;  ///< made, not opened
};

/// The keys that every layer's table may have, beside its provider's.
[[nodiscard]] const Schema& layerSchema();
[[nodiscard]] const Schema& layerSettingsSchema();
[[nodiscard]] const Schema& layerAdjustmentSchema();

/// "unknown key X, did you mean Y".
[[nodiscard]] Error noteOf(const UnknownKey& unknown, const std::string& where);
/// What a layer's table holds that neither layers nor its provider know. Such keys do nothing, but may be misspelt.
[[nodiscard]] std::vector<Error> unknownLayerKeys(const ProviderRequest& request);

/// Reads a layer's table for that group and makes its provider; without input or output. Errors say file, line and key
/// path. `mode` is the blend mode of a table that names none.
[[nodiscard]] Result<LayerDescription> readLayer(const ProviderRequest& request, LayerGroupId group,
                                                 BlendMode mode = BlendMode::Normal);

}  // namespace meridian::globebrowsing
