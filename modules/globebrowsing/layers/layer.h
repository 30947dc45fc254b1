#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <glm/vec3.hpp>

#include "globebrowsing/layers/blend.h"
#include "globebrowsing/layers/layer_description.h"
#include "globebrowsing/layers/layer_group.h"
#include "globebrowsing/layers/structure_key.h"
#include "globebrowsing/providers/tile_provider.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::globebrowsing {

class TileStreamer;

/// What a layer may ask of the globe. Null pointers where nothing is drawn (--validate): providers then stay unopened
/// and layers have no stream.
struct LayerServices {
  WorkerPool* workers = nullptr;
  TileStreamer* streamer = nullptr;
};

/// One layer of a globe: its provider, and its properties below Layers.GROUP.IDENTIFIER. Render thread only.
class Layer final : public PropertyOwner {
 public:
  /// What a change of a property means to the rest.
  enum class Change { Structure, Settings };

  Layer(LayerDescription description, LayerGroupId group, const LayerServices& services,
        std::function<void(const Layer&, Change)> changed);
  ~Layer() override;

  /// What its provider is made from.
  [[nodiscard]] const ProviderRequest& request() const { return request_; }
  [[nodiscard]] LayerGroupId group() const { return group_; }
  [[nodiscard]] int zIndex() const { return zIndex_; }
  void setZIndex(int zIndex) { zIndex_ = zIndex; }
  [[nodiscard]] bool hadZIndex() const { return hadZIndex_; }

  [[nodiscard]] bool isEnabled() const { return enabled.get(); }
  /// Opacity * Fade.
  [[nodiscard]] double effectiveOpacity() const { return opacity.get() * fade.get(); }
  [[nodiscard]] LayerSettings settings() const { return {gamma.get(), multiplier.get(), offset.get()}; }
  [[nodiscard]] BlendMode blend() const { return static_cast<BlendMode>(blendMode.get()); }
  [[nodiscard]] Adjustment adjustment() const { return static_cast<Adjustment>(adjustmentType.get()); }
  [[nodiscard]] Sampling sampling() const { return sampling_; }
  [[nodiscard]] LayerStructure structure() const { return {group_, sampling_, blend(), adjustment()}; }

  [[nodiscard]] const std::shared_ptr<TileProvider>& provider() const { return provider_; }
  /// Of this layer's raw tiles in the TileStreamer; another after Reset, 0 without a streamer.
  [[nodiscard]] std::uint32_t stream() const { return stream_; }
  /// Whether its tiles can be asked for: enabled, and the provider is open.
  [[nodiscard]] bool isReady() const;

  /// Opens the provider when the layer has been enabled, and brings Status and LastError up to date. Every frame;
  /// allocates only when something changed.
  void update();
  /// Whether Remove was triggered; the manager then deletes the layer in its next update.
  [[nodiscard]] bool wantsRemoval() const { return wantsRemoval_; }

  OptionProperty type;
  BoolProperty enabled;
  FloatProperty opacity;
  FloatProperty fade;
  OptionProperty blendMode;
  TriggerProperty reset{{"Reset", "Reset", "Opens the data anew and drops the layer's tiles"}};
  TriggerProperty remove{{"Remove", "Remove", "Deletes the layer from its group"}};
  StringProperty guiDescription;
  StringProperty status{{"Status", "Status", "not opened, opening, ready or failed", true}, "not opened"};
  StringProperty lastError{{"LastError", "Last error", "What went wrong last with this layer's data", true}};
  Vec3Property colour;

  PropertyOwner settingsOwner{"Settings", "Settings", "Applied to values as sign(v) |v|^Gamma Multiplier + Offset"};
  FloatProperty gamma;
  FloatProperty multiplier;
  FloatProperty offset;
  TriggerProperty setDefault{{"SetDefault", "Set default", "Gamma 1, Multiplier 1, Offset 0"}};

  PropertyOwner adjustmentOwner{"Adjustment", "Adjustment", "What is done to colours before the settings"};
  OptionProperty adjustmentType;
  Vec3Property chromaKeyColour;
  FloatProperty chromaKeyTolerance;

 private:
  void addProperties();
  void connectProperties();
  void restart();
  void updateStatus();

  LayerGroupId group_;
  int zIndex_;
  bool hadZIndex_;
  Sampling sampling_;
  ProviderRequest request_;
  std::shared_ptr<TileProvider> provider_;
  LayerServices services_;
  std::uint32_t stream_ = 0;
  std::function<void(const Layer&, Change)> changed_;
  TileProvider::State seenState_ = TileProvider::State::NotOpened;
  const Error* seenError_ = nullptr;
  bool wantsRemoval_ = false;
  bool quiet_ = false;  ///< SetDefault tells once, not three times
};

}  // namespace meridian::globebrowsing
