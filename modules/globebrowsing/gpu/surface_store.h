#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "globebrowsing/gpu/height_composition.h"
#include "globebrowsing/gpu/surface_pool.h"
#include "globebrowsing/layers/chunk_surface.h"
#include "globebrowsing/layers/layer_manager.h"
#include "globebrowsing/streaming/tile_streamer.h"
#include "host/graphics/upload_budget.h"

namespace meridian::globebrowsing {

/// The shapes of tiles: asks for the raw heights of every enabled height layer, has them composed into ChunkSurfaces on
/// workers, and uploads those. When heights change (a layer toggled, a setting) the surfaces of before stay until the
/// new ones are there. What is made without a layer that is late is made anew when more has come. Render thread only; a
/// steady frame allocates nothing.
class SurfaceStore {
 public:
  /// All must outlive the store.
  SurfaceStore(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
               std::uint32_t capacity);

  void beginFrame(std::uint64_t frame);
  /// Asks for what the tile's surface lacks. Returns whether nothing is lacking: it is resident and current.
  bool want(const TileIndex& index, double priority);
  /// Keeps the tile's surface from being evicted in this frame.
  void keep(const TileIndex& index);
  /// Uploads what has arrived, greatest priority first.
  void upload(graphics::UploadBudget& budget);

  /// The resident surface, current or not; null without one.
  [[nodiscard]] const ChunkSurface* find(const TileIndex& index) const;
  /// find(), but null also where that is outdated and nobody used it in the last frame: such a surface is not drawn.
  [[nodiscard]] const ChunkSurface* findInForce(const TileIndex& index) const;
  /// Whether find() shows earlier heights, or lacks what was late.
  [[nodiscard]] bool isOutdated(const TileIndex& index) const;
  /// The slot of find() in pool().
  [[nodiscard]] std::optional<std::uint32_t> slot(const TileIndex& index) const { return pool_.slots().peek(index); }
  [[nodiscard]] const SurfacePool& pool() const { return pool_; }
  /// The surface of the tile or of its nearest ancestor that has one.
  struct Nearest {
    const ChunkSurface* surface = nullptr;  ///< null when not even the root has one
    int level = 0;
    unsigned stamp = 0;     ///< of its arrival: equal stamps mean the same surface; 0 for none
    bool isUnlike = false;  ///< it lacks what is late, or shows earlier heights: neighbours may be made from other data
  };
  [[nodiscard]] Nearest nearest(const TileIndex& index) const;
  /// The heights of the tile, or of its nearest ancestor of which any are known. They stay known when the surface makes
  /// room for another: tiles that are culled by their own heights, but not by an ancestor's, would else be wanted again
  /// as soon as they are gone, and take each other's place in a full pool for ever.
  struct KnownRange {
    HeightRange range;
    int level = -1;      ///< -1: not even the root's are known
    unsigned stamp = 0;  ///< equal stamps mean equal heights; 0 for none
  };
  [[nodiscard]] KnownRange nearestRange(const TileIndex& index) const;
  /// Whether some enabled height layer has finer data within the tile than its surface shows. No input or output.
  [[nodiscard]] bool hasFinerHeights(const TileIndex& index) const { return heights_.hasFiner(index); }
  /// No resident surface is deeper.
  [[nodiscard]] int deepestLevel() const { return deepest_; }
  /// The least height of any resident surface, at most 0.
  [[nodiscard]] double lowestHeight() const { return lowest_; }
  /// The greatest, at least 0.
  [[nodiscard]] double highestHeight() const { return highest_; }
  /// Whether the last upload() had more surfaces to hold than the pool can: what is missing then stays missing.
  [[nodiscard]] bool full() const { return full_; }
  /// Bytes of the surfaces that are there.
  [[nodiscard]] std::size_t residentBytes() const { return pool_.slots().used() * SurfacePool::bytesPerSlot(); }
  /// Height layers whose data are being opened, or an empty string.
  [[nodiscard]] std::string waitingFor() const;

 private:
  /// Ranges of tiles long gone are dropped when there are that many.
  static constexpr std::size_t mostEvicted = 1 << 15;
  struct Resident {
    std::shared_ptr<const ChunkSurface> surface;
    std::uint32_t stream = 0;
    unsigned stamp = 0;
    unsigned lack = 0;  ///< HeightComposition::lack, as it was made
  };
  [[nodiscard]] bool isOutdated(const Resident& resident) const {
    return resident.stream != heights_.stream() || resident.lack > 0;
  }
  struct Arrival {
    TileIndex index;
    double priority = 0.0;
    TileDataPointer data;
    unsigned lack = 0;
  };

  /// False when the pool is full.
  bool place(const Arrival& arrival);
  void evict(const TileIndex& index);

  std::shared_ptr<const Tiling> tiling_;
  LayerManager& layers_;
  HeightComposition heights_;
  SurfacePool pool_;
  std::unordered_map<TileIndex, Resident> resident_;
  std::unordered_map<TileIndex, KnownRange> evicted_;  ///< of the present heights, and complete
  std::size_t outdated_ = 0;                           ///< residents
  std::vector<Arrival> arrivals_;
  std::uint64_t frame_ = 0;
  unsigned lastStamp_ = 0;
  bool full_ = false;
  int deepest_ = 0;
  double lowest_ = 0.0;
  double highest_ = 0.0;
};

}  // namespace meridian::globebrowsing
