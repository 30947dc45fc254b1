#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "globebrowsing/gpu/composer.h"
#include "globebrowsing/gpu/composite_generations.h"
#include "globebrowsing/gpu/composite_key.h"
#include "globebrowsing/gpu/height_composition.h"
#include "globebrowsing/gpu/stand_in.h"
#include "globebrowsing/layers/layer_opacities.h"
#include "globebrowsing/streaming/tile_streamer.h"

namespace meridian::globebrowsing {

/// What a composite was made from, and when.
struct CompositeContents {
  std::uint64_t stamp = 0;  ///< of its generation
  LayerOpacities layers;
  unsigned lack = 0;        ///< Lack::coarser
  std::uint64_t drawn = 0;  ///< the last frame that drew it
};

/// What is to be composed in this frame: asks for the raw tiles of each composite that is wanted, and queues those that
/// have them all. A layer whose tile is late does not hold up the others: an ancestor's tile stands in for it, or the
/// layers below show; such composites are queued where they are better than what there is.
///
/// Knows no slots: CompositeStore, which owns it, tells what there is already. Its invariant: what is queued keeps its
/// raw tiles in memory until the next frame begins. Render thread only; a steady frame allocates nothing.
class CompositeGathering {
 public:
  /// All must outlive it.
  CompositeGathering(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer);

  /// Forgets what was queued.
  void beginFrame();
  /// Every frame: keeps root tiles of these steps in memory, to stand in for others.
  void keepStandIns(const std::vector<LayerStepPointer>& steps);

  struct Request {
    CompositeKey key;
    double priority = 0.0;
    bool isMissing = true;  ///< what is drawn without it is not what it should be
    const CompositeGenerations* generations = nullptr;
    const LayerOpacities* opacities = nullptr;                 ///< of the generations' layers
    LayerOpacity other{};                                      ///< to compose it with instead of that layer's
    const CompositeContents* there = nullptr;                  ///< what there is of that key, if anything
    unsigned mostLack = std::numeric_limits<unsigned>::max();  ///< what lacks more is no gain
  };
  /// Asks for what the composite is made from, and queues it when that is there.
  void request(const Request& request);

  struct Queued {
    CompositeKey key;
    double priority = 0.0;
    bool isMissing = true;
    unsigned lack = 0;  ///< Lack::coarser
    std::size_t firstPart = 0;
    std::size_t partCount = 0;
  };
  [[nodiscard]] bool isQueued(const CompositeKey& key) const;
  /// Greatest priority first.
  [[nodiscard]] std::span<const Queued> sorted();
  [[nodiscard]] std::span<const CompositionPart> parts(const Queued& queued) const {
    return {parts_.data() + queued.firstPart, queued.partCount};
  }

  /// A tile that is drawn, with colours of at most that level.
  struct Drawn {
    TileIndex index;
    int colourLevel = 0;
  };
  /// Asks for raw tiles of the layers' next steps, after all others.
  void fetchAhead(const std::vector<Layer*>& layers, const std::vector<Drawn>& drawn);

  /// The heights that layers colour.
  [[nodiscard]] const HeightComposition& relief() const { return relief_; }

 private:
  Lack gather(const Request& request);
  /// What that layer adds to the composite; asks for it unless it is there, or never will be.
  Lack gatherPart(CompositionPart& part, const LayerStepPointer& step, const Request& request);
  /// Whether a composite of these parts, something of which is late, is better than what there is.
  [[nodiscard]] static bool isGain(const Request& request, unsigned lack, std::span<const CompositionPart> parts);

  std::shared_ptr<const Tiling> tiling_;
  TileStreamer& streamer_;
  HeightComposition relief_;
  std::vector<Queued> queue_;
  std::vector<CompositionPart> parts_;
  std::vector<TileDataPointer> held_;  ///< the raw tiles of parts_
};

}  // namespace meridian::globebrowsing
