#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "globebrowsing/chunks/selection.h"
#include "globebrowsing/gpu/chunk_blocks.h"
#include "globebrowsing/gpu/globe_tiles.h"
#include "globebrowsing/gpu/uniform_ring.h"
#include "globebrowsing/surface/chunk_programs.h"
#include "globebrowsing/surface/chunk_sampling.h"
#include "globebrowsing/surface/surface.h"
#include "host/graphics/graphics.h"

namespace meridian::globebrowsing {

/// Whether no part of the chunk is dark enough for night layers to show, by the ellipsoid's normals. `light` is the
/// unit direction towards the light, in model space.
[[nodiscard]] bool isInDaylight(const ChunkSurface& surface, const glm::dvec3& light);

/// Draws selected chunks: one program, two array textures and one vertex array for all, and one call for all that are
/// drawn alike. Render thread only; a steady frame allocates nothing.
class ChunkRenderer {
 public:
  explicit ChunkRenderer(graphics::Graphics& graphics);

  [[nodiscard]] ChunkPrograms& programs() { return programs_; }
  [[nodiscard]] const ChunkPrograms& programs() const { return programs_; }

  /// What one globe draws in one view.
  struct Job {
    std::span<const SelectedChunk> chunks;
    const View* view = nullptr;
    std::size_t viewNumber = 0;
    double ambient = 0.0;
    double opacity = 1.0;
    double waterReflectance = 1.0;
    bool skirts = true;
  };
  void beginFrame() { uniforms_.beginFrame(); }
  void endFrame() { uniforms_.endFrame(); }
  /// Draws into the bound framebuffer. How many chunks were drawn.
  std::size_t draw(const Job& job, GlobeTiles& tiles);
  /// A program, textures and state of draw(), for drawing something else the same way;
  /// whether there is a program.
  bool bindForDrawing(const GlobeTiles& tiles, const ChunkProgramUse& use, Composer::Sampling sampling) const;
  /// Back to the default state.
  void unbind() const;

 private:
  /// What draws need different states for: a switch of program, texture or sampler costs as much as several draws.
  struct Variant {
    ChunkProgramUse use;
    Composer::Sampling sampling;
    auto operator<=>(const Variant&) const = default;
  };
  static constexpr std::size_t variantCount = std::size_t{4} * (2 + Composer::levelCount);
  using Placements = std::array<std::optional<CompositeStore::Placement>, compositeKindCount>;
  struct Prepared {
    const SelectedChunk* chunk = nullptr;
    const ChunkSurface* surface = nullptr;
    std::uint32_t slot = 0;
    Variant variant;
    Placements composites;
  };
  /// Finds what is to be drawn, and in which order.
  void prepare(const Job& job, GlobeTiles& tiles);
  [[nodiscard]] static TexelsAcross texelsAcross(const Placements& composites);
  [[nodiscard]] Placements place(const SelectedChunk& chunk, bool night, GlobeTiles& tiles) const;
  /// At most ChunkBlock::most chunks of one variant.
  void drawBatch(std::span<const Prepared> batch, const Job& job, GlobeTiles& tiles);
  [[nodiscard]] ChunkParameters parametersOf(const Prepared& prepared, const Job& job) const;

  ChunkPrograms programs_;
  std::vector<Prepared> prepared_;  ///< while draw() draws; near ones first
  SurfacePool::Draws draws_;        ///< while drawBatch() draws
  UniformRing uniforms_;
};

}  // namespace meridian::globebrowsing
