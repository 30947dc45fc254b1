#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <glm/vec3.hpp>

#include "globebrowsing/layers/blend.h"
#include "globebrowsing/layers/data_properties.h"
#include "globebrowsing/layers/layer_description.h"
#include "globebrowsing/layers/layer_group.h"
#include "globebrowsing/layers/step_player.h"
#include "globebrowsing/layers/structure_key.h"
#include "globebrowsing/providers/path_tokens.h"
#include "globebrowsing/providers/relief_style.h"
#include "globebrowsing/providers/tile_provider.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::globebrowsing {

class SourceTileStore;
class TileStreamer;

/// What a layer may ask of the globe. Null pointers where nothing is drawn (--validate): providers then stay unopened
/// and layers have no stream.
struct LayerServices {
  WorkerPool* workers = nullptr;
  TileStreamer* streamer = nullptr;
  std::shared_ptr<SourceTileStore> sourceTiles{};  ///< of map services
  HeightLimits heightLimits{};                     ///< of the globe
  TokenFolder tokenFolder{};  ///< of the path tokens in tables and properties; empty: there are none
};

/// One layer of a globe: its provider, and its properties below Layers.GROUP.IDENTIFIER. Render thread only.
class Layer final : public PropertyOwner {
 public:
  /// What a change of a property means to the rest.
  enum class Change { Structure, Settings, Opacity };

  Layer(LayerDescription description, LayerGroupId group, const LayerServices& services,
        std::function<void(Layer&, Change)> changed);
  ~Layer() override;

  /// The table that makes the layer as it is now: its own, with what was set since, and paths that hold anywhere.
  [[nodiscard]] Value table() const;
  /// Whether a user added it, rather than an asset.
  [[nodiscard]] bool isUsers() const { return isUsers_; }
  void setUsers() { isUsers_ = true; }

  /// What its provider is made from.
  [[nodiscard]] const ProviderRequest& request() const { return request_; }
  [[nodiscard]] LayerGroupId group() const { return group_; }
  [[nodiscard]] int zIndex() const { return zIndex_; }
  void setZIndex(int zIndex) { zIndex_ = zIndex; }
  /// To a place among the others that it keeps when it is written.
  void moveTo(int zIndex) {
    zIndex_ = zIndex;
    wasMoved_ = true;
  }
  [[nodiscard]] bool hadZIndex() const { return hadZIndex_; }

  [[nodiscard]] bool isEnabled() const { return enabled.get(); }
  /// Opacity * Fade.
  [[nodiscard]] double effectiveOpacity() const { return opacity.get() * fade.get(); }
  /// Names all that composites of the layer depend on but its opacity, and no other layer of its globe.
  [[nodiscard]] std::uint64_t version() const { return version_; }
  void setVersion(std::uint64_t version) { version_ = version; }
  [[nodiscard]] LayerSettings settings() const { return {gamma.get(), multiplier.get(), offset.get()}; }
  [[nodiscard]] BlendMode blend() const { return static_cast<BlendMode>(blendMode.get()); }
  [[nodiscard]] Adjustment adjustment() const { return static_cast<Adjustment>(adjustmentType.get()); }
  [[nodiscard]] Sampling sampling() const { return sampling_; }
  /// How it colours the composed heights; null for other layers.
  [[nodiscard]] const ReliefStyle* relief() const { return provider_->relief(); }
  /// Of a SolidColor layer, or of isolines.
  [[nodiscard]] glm::dvec3 ownColour() const { return relief() != nullptr ? relief()->colour : colour.get(); }
  [[nodiscard]] LayerStructure structure() const { return {group_, sampling_, blend(), adjustment()}; }

  /// Whether at opacity 1 its tiles are shown as they are: nothing mixes them with what is below or changes colours.
  [[nodiscard]] bool showsTilesUnchanged() const {
    return sampling_ == Sampling::Tile && blend() == BlendMode::Normal && adjustment() == Adjustment::None &&
           settings().isIdentity();
  }

  /// What the layer's table describes. Ask for tiles at step().
  [[nodiscard]] const std::shared_ptr<TileProvider>& provider() const { return provider_; }
  /// The tiles to show: those of the provider, or of its step at the time of the last update. Another after Reset and
  /// with each step; null while the first step is being opened.
  [[nodiscard]] const LayerStepPointer& step() const { return step_; }
  /// Where steps are interpolated, what step() is mixed with now, and how much of that there is, 0 to 1. Null where the
  /// picture is step()'s alone.
  [[nodiscard]] const LayerStepPointer& otherStep() const { return player_.other(); }
  [[nodiscard]] double otherWeight() const { return player_.otherWeight(); }
  /// Steps whose tiles are worth fetching although nobody sees them yet, nearest first.
  [[nodiscard]] const std::vector<LayerStepPointer>& ahead() const { return player_.ahead(); }
  /// Of step()'s tiles in the TileStreamer; 0 without a streamer or step.
  [[nodiscard]] std::uint32_t stream() const { return step_ ? step_->stream() : 0; }
  /// Whether its tiles can be asked for: enabled, and step()'s provider is open.
  [[nodiscard]] bool isReady() const;
  /// Whether it has nothing to show yet because its data are being opened, by what the last update() saw.
  [[nodiscard]] bool isOpening() const;
  /// The same, or it shows an earlier step because the present one is being opened, or one alone because the one to mix
  /// it with is.
  [[nodiscard]] bool awaitsData() const { return isOpening() || player_.awaits(); }

  /// Opens the provider when the layer has been enabled, goes to the step of that time, and brings Status and LastError
  /// up to date. Every frame; allocates only when something changed.
  void update(const Time& now);
  /// Opens the data anew, as Reset does, in the next update; only if opening them failed, or tiles of what the layer
  /// shows or is about to show.
  void retryFailed();
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
  StringProperty attribution;
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
  void attachProvider();
  void detachProvider();
  /// Makes the provider anew from such a request, which becomes the layer's; on an error it keeps what it has.
  void restart(ProviderRequest request);
  void play(const Time& now);
  void updateStatus();
  void updateRelief();
  void updateAttribution();
  void noteWaiting();

  LayerGroupId group_;
  std::uint64_t version_ = 0;
  int zIndex_;
  bool hadZIndex_;
  bool wasMoved_ = false;
  Sampling sampling_;
  ProviderRequest request_;
  bool wantsRestart_ = false;  ///< not at once: whoever sets many properties holds those of the provider
  DataProperties data_;
  std::shared_ptr<TileProvider> provider_;
  LayerServices services_;
  StepPlayer player_;
  LayerStepPointer step_;
  std::function<void(Layer&, Change)> changed_;
  TileProvider::State seenState_ = TileProvider::State::NotOpened;
  const Error* seenError_ = nullptr;
  const bool hasOwnAttribution_;
  std::string seenFailure_;  ///< of tiles that wait
  std::string seenProblem_;  ///< of its ReliefStyle
  int framesUntilLook_ = 0;
  bool wantsRemoval_ = false;
  bool isUsers_ = false;
  bool quiet_ = false;  ///< SetDefault tells once, not three times
};

}  // namespace meridian::globebrowsing
