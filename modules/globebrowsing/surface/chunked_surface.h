#pragma once

#include <memory>
#include <string>
#include <vector>

#include "globebrowsing/chunks/chunk_tree.h"
#include "globebrowsing/gpu/globe_tiles.h"
#include "globebrowsing/surface/chunk_renderer.h"
#include "globebrowsing/surface/surface.h"

namespace meridian::globebrowsing {

/// A globe as chunks of a tiling: selects them, keeps their tiles, draws them (Bladin & Broberg 2016, chapter 3).
class ChunkedSurface final : public Surface {
 public:
  /// What it stands on; all outlive it.
  struct Parts {
    graphics::Graphics* graphics = nullptr;
    LayerManager* layers = nullptr;
    TileStreamer* streamer = nullptr;
    std::shared_ptr<const Tiling> tiling;
  };
  /// Errors: shader templates missing or wrong.
  [[nodiscard]] static Result<std::unique_ptr<ChunkedSurface>> create(Parts parts, const GlobeTiles::Options& options);

  void setShown() override { tiles_->composites().setShown(); }
  void update(const FrameContext& frame, const SurfaceSettings& settings) override;
  void draw(const FrameContext& frame, std::size_t view) override;
  [[nodiscard]] Settled settled(std::size_t view) const override;
  [[nodiscard]] bool filled() const override;
  [[nodiscard]] std::size_t residentBytes() const override { return tiles_->residentBytes(); }
  [[nodiscard]] double heightAt(double latitude, double longitude) const override;
  [[nodiscard]] std::optional<glm::dvec3> pick(const glm::dvec3& origin, const glm::dvec3& direction) const override;

  [[nodiscard]] std::span<const SelectedChunk> selected() const { return tree_.selected(); }
  [[nodiscard]] const SelectionFigures& figures() const { return tree_.figures(); }
  /// For benchmarks, which draw the same by other means.
  [[nodiscard]] const Tiling& tiling() const { return *parts_.tiling; }
  [[nodiscard]] ChunkRenderer& renderer() { return renderer_; }
  [[nodiscard]] GlobeTiles& tiles() { return *tiles_; }

 private:
  ChunkedSurface(Parts parts, std::unique_ptr<GlobeTiles> tiles);
  void select(const FrameContext& frame, const SurfaceSettings& settings);
  void tellWhenFull();
  void tellWhenCoarse();

  Parts parts_;
  std::unique_ptr<GlobeTiles> tiles_;
  ChunkRenderer renderer_;
  ChunkTree tree_;
  std::vector<SelectionView> views_;
  SurfaceSettings settings_;
  std::string programTrouble_;
  bool frameOpen_ = false;
  bool toldCoarse_ = false;
  int fullFrames_ = 0;  ///< in a row, with a pool too small for the view
};

}  // namespace meridian::globebrowsing
