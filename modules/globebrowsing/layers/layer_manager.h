#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "globebrowsing/layers/layer.h"
#include "globebrowsing/layers/layer_group.h"
#include "globebrowsing/layers/structure_key.h"
#include "host/api/error.h"
#include "host/api/property_owner.h"
#include "host/api/value.h"

namespace meridian::globebrowsing {

/// The layers of one group in drawing order, lowest first: sorted by their z, equal ones in the order of adding.
class LayerGroup final : public PropertyOwner {
 public:
  explicit LayerGroup(LayerGroupId group);
  ~LayerGroup() override;

  [[nodiscard]] LayerGroupId id() const { return id_; }
  [[nodiscard]] const std::vector<std::unique_ptr<Layer>>& layers() const { return layers_; }
  /// Enabled layers, lowest first. Good until the next change of the structure.
  [[nodiscard]] const std::vector<Layer*>& enabledLayers() const { return enabled_; }
  [[nodiscard]] Layer* find(std::string_view identifier) const;

  /// Of the enabled layers.
  [[nodiscard]] const StructureKey& structureKey() const { return key_; }
  /// Grows when the enabled layers, their order, or what the program depends on changes: look at structureKey().
  [[nodiscard]] std::uint64_t structureVersion() const { return structureVersion_; }
  /// Grows when the group's tiles must be composed anew: with the structure, and with any setting of an enabled layer,
  /// an enabled layer's data becoming readable, or its Reset. Opacities of colours count as nothing here, for they
  /// may change in every frame: whoever composes colours looks at them in every frame.
  [[nodiscard]] std::uint64_t settingsVersion() const { return settingsVersion_; }

  /// Errors: an identifier that the group has. A layer without ZIndex takes the last layer's z if that had none given
  /// either, else one more; the first takes 1.
  Result<Layer*> add(LayerDescription description, const LayerServices& services);
  /// Errors: no such layer.
  Result<void> remove(std::string_view identifier);
  /// To that place among all layers of the group (clamped), taking the z of the neighbour whose place it takes. Errors:
  /// no such layer.
  Result<void> move(std::string_view identifier, int position);
  /// Every frame, with the scene's time: layers' updates, removals.
  void update(const Time& now);

  BoolProperty blendTileLevels{
      {"BlendTileLevels", "Blend tile levels", "Whether neighbouring levels of detail are blended into each other"},
      true};

 private:
  [[nodiscard]] std::vector<std::unique_ptr<Layer>>::const_iterator place(std::string_view identifier) const;
  [[nodiscard]] Error noSuchLayer(std::string_view layer) const;
  void changed(Layer& layer, Layer::Change change);
  [[nodiscard]] bool isToggled(const Layer& layer) const;
  [[nodiscard]] std::uint64_t nextLayerVersion();
  void restructure();

  LayerGroupId id_;
  std::vector<std::unique_ptr<Layer>> layers_;
  std::vector<Layer*> enabled_;
  StructureKey key_;
  std::uint64_t structureVersion_ = 1;
  std::uint64_t settingsVersion_ = 1;
  std::uint64_t lastLayerVersion_ = 0;
};

/// How messages call a layer: "ColorLayers.Blue", or by its number in the group, from 1, where its table has no
/// Identifier: "ColorLayers[3]".
[[nodiscard]] std::string layerName(std::string_view group, const Value& table, std::size_t number);

/// A layer that was left out.
struct RefusedLayer {
  std::string name;  ///< as layerName tells; of a whole group: its name
  Error error;
};

/// All layers of a globe: the owner `Layers`. Render thread only.
class LayerManager final : public PropertyOwner {
 public:
  /// The services outlive the manager.
  explicit LayerManager(const LayerServices& services = {});

  /// An asset's `Layers`: groups by name, each a list of layer tables. What is wrong is left out and told; the rest
  /// loads. `path` is the table's key path ("Renderable.Layers"); that of a layer is followed by its layerName.
  std::vector<RefusedLayer> load(const Value& layers, const std::string& where, const std::string& path,
                                 const std::string& folder);

  /// Group by any of its names. Errors: an unknown group, a table that fails validation, an identifier in use.
  Result<Layer*> addLayer(std::string_view group, const ProviderRequest& request);
  Result<void> deleteLayer(std::string_view group, std::string_view identifier);
  Result<void> moveLayer(std::string_view group, std::string_view identifier, int position);

  [[nodiscard]] LayerGroup& group(LayerGroupId id) { return *groups_[static_cast<std::size_t>(id)]; }
  [[nodiscard]] const LayerGroup& group(LayerGroupId id) const { return *groups_[static_cast<std::size_t>(id)]; }
  [[nodiscard]] std::size_t layerCount() const;

  /// Has all layers that failed, or whose tiles did, open their data anew in the next update.
  void retryFailed();
  /// Once a frame, with the scene's time, before anything asks for versions.
  void update(const Time& now = {});
  /// The sum of the groups' versions: grows when any of them does.
  [[nodiscard]] std::uint64_t structureVersion() const;
  [[nodiscard]] std::uint64_t settingsVersion(LayerGroupId id) const { return group(id).settingsVersion(); }

 private:
  LayerServices services_;
  std::array<std::unique_ptr<LayerGroup>, layerGroupCount> groups_;
};

}  // namespace meridian::globebrowsing
