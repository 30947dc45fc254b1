#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "globebrowsing/gpu/opening_wait.h"
#include "globebrowsing/gpu/stand_in.h"
#include "globebrowsing/layers/layer_manager.h"
#include "globebrowsing/source/tile_layout.h"
#include "globebrowsing/streaming/tile_streamer.h"

namespace meridian::globebrowsing {

/// Tiles made of the heights of all height layers, in one layout: asks for the raw heights of every enabled layer, and
/// has a worker compose them and make the tile. When heights change (a layer toggled, a setting), all tiles are others.
/// What is late is left out, or an ancestor's heights stand in for it, or those that the layer showed before its data
/// were opened anew; who goes on asking has the tile made anew when more has come.
/// Render thread only; a steady frame allocates nothing.
class HeightComposition {
 public:
  /// From composed heights; on a worker.
  using Make = TileDataPointer (*)(const Tiling& tiling, const TileIndex& index, std::vector<float>&& heights);

  /// All must outlive it. `layout` is heightLayout or reliefLayout.
  HeightComposition(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
                    const TileLayout& layout, Make make);
  HeightComposition(const HeightComposition&) = delete;
  HeightComposition& operator=(const HeightComposition&) = delete;
  ~HeightComposition();

  void beginFrame();
  /// Of the tiles as the layers are at present; another whenever heights have changed.
  [[nodiscard]] std::uint32_t stream() const { return stream_; }
  /// The tile, or asks for what it lacks. Pending also while height layers are being opened, and, if the caller
  /// `showsEarlier` heights meanwhile, for as long as a layer's next step in time is late.
  [[nodiscard]] TileAnswer request(const TileIndex& index, double priority, bool showsEarlier);
  /// By how much the tile of request() is not what it should be; 0 when nothing was late.
  [[nodiscard]] unsigned lack(const TileIndex& index) const;
  /// Whether some enabled height layer has finer data within the tile than the tile shows. No input or output.
  [[nodiscard]] bool hasFiner(const TileIndex& index) const;

 private:
  /// One layer's heights, of the tile or an ancestor; null without any.
  struct Gathered {
    const TileDataPointer* tile = nullptr;
    UnitSquareTransform within;
  };

  /// What a layer showed, to stand in for what is late of what it shows now.
  struct Shown {
    std::string uri;          ///< of the layer: where one was that is gone another may lie
    LayerStepPointer step;    ///< that gave heights last
    LayerStepPointer former;  ///< and the one before it, until all that was asked of `step` has come
  };

  [[nodiscard]] const std::vector<Layer*>& enabled() const {
    return layers_.group(LayerGroupId::HeightLayers).enabledLayers();
  }
  /// For other layers.
  void takeLayers();
  [[nodiscard]] std::uint32_t streamOf(const LayerStep& step) const;
  /// What an enabled layer showed before its present step; null where there is nothing to go back to.
  [[nodiscard]] const LayerStep* formerOf(std::size_t layer) const;
  /// Where an enabled layer's tiles come from: its step, or as long as that is being opened formerOf; may be null.
  [[nodiscard]] const LayerStep* sourceOf(std::size_t layer) const;
  /// Looks for the raw heights of all layers, asks for those that are missing, and tells what they are.
  Lack gather(const TileIndex& index, double priority, bool showsEarlier);
  /// The same of one enabled layer that is ready.
  Lack gatherLayer(std::size_t layer, const TileIndex& index, double priority, bool showsEarlier);

  std::shared_ptr<const Tiling> tiling_;
  LayerManager& layers_;
  TileStreamer& streamer_;
  TileLayout layout_;
  Make make_;
  mutable std::unordered_map<TileIndex, bool> finer_;  ///< what hasFiner found; asked for every frame
  std::unordered_map<TileIndex, unsigned> lacks_;      ///< of tiles that were made while something was late
  std::vector<Gathered> gathered_;                     ///< by enabled height layer, of the tile being looked at
  std::vector<Shown> shown_;                           ///< by enabled height layer
  OpeningWait opening_;
  std::uint64_t version_ = 0;  ///< of the height layers
  std::uint32_t stream_ = 0;
};

}  // namespace meridian::globebrowsing
