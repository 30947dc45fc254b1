#pragma once

#include <memory>
#include <string>

#include "globebrowsing/gpu/composite_store.h"
#include "globebrowsing/gpu/surface_store.h"
#include "globebrowsing/streaming/tile_residency.h"

namespace meridian::globebrowsing {

/// What of a globe is in memory: tells the chunk tree, and gives the renderer what to draw. Render thread only.
class GlobeTiles final : public TileResidency {
 public:
  struct Options {
    std::size_t texturePoolBytes = std::size_t{512} << 20;
    /// At least as many as one composite has layers with tiles, whatever that takes.
    std::uint32_t leastRawTiles = 8;
    bool operator==(const Options&) const = default;
  };
  /// Tiling, layers and streamer must outlive it. Errors: shader templates missing or wrong.
  [[nodiscard]] static Result<std::unique_ptr<GlobeTiles>> create(graphics::Graphics& graphics,
                                                                  std::shared_ptr<const Tiling> tiling,
                                                                  LayerManager& layers, TileStreamer& streamer,
                                                                  const Options& options);

  void beginFrame(std::uint64_t frame);
  /// Uploads and composes under the frame's budgets. After selection.
  void process(graphics::UploadBudget& uploads, double compositionMilliseconds);

  void want(const TileIndex& index, int colourLevel, double priority, std::uint32_t views) override;
  void renewShape(const TileIndex& index, double priority, std::uint32_t views) override;
  void keep(const TileIndex& index, int colourLevel) override;
  [[nodiscard]] State state(const TileIndex& index, int colourLevel) const override;
  [[nodiscard]] HeightRange heightRange(const TileIndex& index) const override;
  [[nodiscard]] unsigned heightVersion(const TileIndex& index) const override;
  [[nodiscard]] SurfaceErrors surfaceErrors(const TileIndex& index) const override;
  [[nodiscard]] bool hasFinerColours(const TileIndex& index) const override { return composites_.hasFiner(index); }

  [[nodiscard]] const SurfaceStore& surfaces() const { return surfaces_; }
  [[nodiscard]] CompositeStore& composites() { return composites_; }
  [[nodiscard]] const CompositeStore& composites() const { return composites_; }
  /// Bytes of all that is in the texture pool.
  [[nodiscard]] std::size_t residentBytes() const { return surfaces_.residentBytes() + composites_.residentBytes(); }
  /// Whether the pool is too small for the view: what is missing then stays missing.
  [[nodiscard]] bool full() const { return surfaces_.full() || composites_.full(); }
  /// Whether shapes and colours of all tiles that were wanted in this frame are there, if only without what is late.
  [[nodiscard]] bool filled() const { return absent_ == 0; }
  /// What the tiles that were wanted in this frame for one of these views (a bit each) still lack, or an empty string.
  [[nodiscard]] std::string waitingFor(std::uint32_t views) const;

 private:
  GlobeTiles(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
             std::unique_ptr<Composer> composer, std::uint32_t surfaces, std::uint32_t composites);

  std::shared_ptr<const Tiling> tiling_;
  SurfaceStore surfaces_;
  CompositeStore composites_;
  std::size_t stale_ = 0;         ///< tiles wanted in this frame that are not current
  std::uint32_t staleViews_ = 0;  ///< for which they were wanted
  std::size_t absent_ = 0;        ///< and those of which shape or colours are not there at all
};

}  // namespace meridian::globebrowsing
