#pragma once

#include <compare>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "globebrowsing/layers/layer_group.h"

namespace meridian::globebrowsing {

/// All about one enabled layer that the generated program depends on.
struct LayerStructure {
  LayerGroupId group = LayerGroupId::ColorLayers;
  Sampling sampling = Sampling::Tile;
  BlendMode blendMode = BlendMode::Normal;
  Adjustment adjustment = Adjustment::None;

  auto operator<=>(const LayerStructure&) const = default;
};

/// The enabled layers of one group, lowest first, without their identities: equal keys share a program. For the program
/// of several groups, join their keys.
class StructureKey {
 public:
  StructureKey() = default;
  explicit StructureKey(std::vector<LayerStructure> layers) : layers_(std::move(layers)) {}

  [[nodiscard]] const std::vector<LayerStructure>& layers() const { return layers_; }
  [[nodiscard]] bool empty() const { return layers_.empty(); }
  void append(const StructureKey& other);
  /// "ColorLayers:Tile,Normal,None;ColorLayers:SolidColor,Multiply,ChromaKey"; empty for no layers.
  [[nodiscard]] std::string text() const;

  auto operator<=>(const StructureKey&) const = default;

 private:
  std::vector<LayerStructure> layers_;
};

}  // namespace meridian::globebrowsing

template <>
struct std::hash<meridian::globebrowsing::StructureKey> {
  std::size_t operator()(const meridian::globebrowsing::StructureKey& key) const noexcept;
};
