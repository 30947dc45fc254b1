#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "globebrowsing/gpu/composite_kind.h"
#include "globebrowsing/layers/layer_manager.h"
#include "globebrowsing/layers/layer_step.h"

namespace meridian::globebrowsing {

/// The enabled layers of one kind of composites, each at one of its steps in time: together a generation. When a layer
/// goes on to another step, a next generation is composed beside the one that is shown, and when it covers the view
/// they are exchanged. A step on the way is finished even if time has gone on. Between two steps of a layer that
/// interpolates, the two generations are a pair, and a mixture of them is drawn.
///
/// Knows nothing of tiles or slots: CompositeStore, which owns one for each kind, composes, and says when the next
/// generation covers the view or has no room. Its invariant: both generations have a step, or null, for each layer,
/// unless there is no next one. Render thread only; allocates only when layers or steps change.
class CompositeGenerations {
 public:
  struct Generation {
    std::vector<LayerStepPointer> steps;  ///< by layer; null where it has none yet
    std::uint8_t side = 0;                ///< of its composites' keys
    std::uint64_t since = 0;              ///< composites with an earlier stamp show other steps
    std::uint64_t stamp = 0;              ///< composites with an earlier stamp are to be composed anew
  };
  /// Of `next`, as long as it is mixed with what is shown, or is going to be.
  struct Pair {
    bool isPair = false;   ///< both are of the same tiles, those that either needs
    bool isMixed = false;  ///< it covers the view: both are drawn
    bool isHeld = false;   ///< time is between the two: they are not exchanged
    double weight = 0.0;   ///< how much of `next` is seen, 0 to 1
  };

  /// Every frame: takes the kind's enabled layers. `reliefStream` is that of the heights that layers may colour.
  void update(CompositeKind kind, const LayerManager& layers, std::uint32_t reliefStream);
  /// Whether a next generation may begin, once what was wanted of the shown one is there, or drawn.
  struct Leave {
    bool toMix = true;       ///< to be mixed with what is shown
    bool toExchange = true;  ///< to take its place
  };
  /// Then: goes on to other steps. `mixes`: two steps of this kind may be mixed.
  void follow(bool mixes, const Leave& mayBegin);
  /// The pool has no room for the next generation.
  void setCrowded() { crowded_ = true; }
  [[nodiscard]] bool isCrowded() const { return crowded_; }
  /// The next generation covers what is drawn, or has no room. `isFilled`: what is shown is drawn and complete.
  void endNext(bool isFilled);

  /// Whether layers or settings have changed since the last update().
  [[nodiscard]] bool isOutdated(CompositeKind kind, const LayerManager& layers) const;
  /// Lowest first.
  [[nodiscard]] const std::vector<Layer*>& layers() const { return layers_; }
  [[nodiscard]] const StructureKey& key() const { return key_; }
  [[nodiscard]] const Generation& shown() const { return shown_; }
  [[nodiscard]] const Generation& next() const { return next_; }
  /// Whether `next` is being composed, or mixed with what is shown.
  [[nodiscard]] bool hasNext() const { return hasNext_; }
  [[nodiscard]] bool isNext(std::uint8_t side) const { return hasNext_ && side == next_.side; }
  /// That to which composites of such keys belong.
  [[nodiscard]] const Generation& of(std::uint8_t side) const { return isNext(side) ? next_ : shown_; }
  [[nodiscard]] const Pair& pair() const { return pair_; }
  /// The topmost layer that is between two steps that can be mixed; null without one.
  [[nodiscard]] const Layer* interpolated() const { return interpolated_ ? layers_[*interpolated_] : nullptr; }
  /// Whether tiles of some layer change with time.
  [[nodiscard]] bool hasSteps() const { return hasSteps_; }
  /// Grows with all that decides which tiles have composites.
  [[nodiscard]] std::uint64_t changes() const { return changes_; }

 private:
  void takeSteps();
  void takeSteps(Generation& generation);
  void updateInterpolated();
  /// The step of that layer that is to be shown; `other`: where it is interpolated, the one to mix with that.
  [[nodiscard]] const LayerStepPointer& stepOf(std::size_t layer, bool other) const;
  /// Whether a generation is of these steps.
  [[nodiscard]] bool isOf(const Generation& generation, bool other) const;
  void setSteps(Generation& generation, bool other);
  void keepPair();
  void beginNext(bool isBetween, const Leave& mayBegin);
  void weighPair(bool isBetween);
  void dropNext();
  void exchange();

  std::uint64_t version_ = 0;  ///< of the groups' settings
  std::vector<Layer*> layers_;
  StructureKey key_;
  std::uint32_t reliefStream_ = 0;  ///< that composites were last made from, if any of the layers colours heights
  Generation shown_;
  Generation next_;
  Pair pair_;
  std::optional<std::size_t> interpolated_;
  std::optional<std::uint64_t> crowdedStep_;  ///< of such a layer, for whose other step the pool has no room
  bool hasNext_ = false;
  bool crowded_ = false;
  bool hasSteps_ = false;
  std::uint64_t lastStamp_ = 0;
  std::uint64_t changes_ = 0;
};

}  // namespace meridian::globebrowsing
