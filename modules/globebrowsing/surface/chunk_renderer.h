#pragma once

#include <span>

#include "globebrowsing/chunks/selection.h"
#include "globebrowsing/gpu/globe_tiles.h"
#include "globebrowsing/gpu/uniform_ring.h"
#include "globebrowsing/surface/chunk_programs.h"
#include "globebrowsing/surface/surface.h"
#include "host/graphics/graphics.h"

namespace meridian::globebrowsing {

/// Whether no part of the chunk is dark enough for night layers to show, by the ellipsoid's normals. `light` is the
/// unit direction towards the light, in model space.
[[nodiscard]] bool isInDaylight(const ChunkSurface& surface, const glm::dvec3& light);

/// Draws selected chunks: one program, two array textures and one vertex array for all, two uniform blocks. Render
/// thread only; a steady frame allocates nothing.
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
    bool skirts = true;
  };
  void beginFrame() { uniforms_.beginFrame(); }
  void endFrame() { uniforms_.endFrame(); }
  /// Draws into the bound framebuffer. How many chunks were drawn.
  std::size_t draw(const Job& job, GlobeTiles& tiles);
  /// A program (with or without night layers), textures and state of draw(), for drawing something else the same way;
  /// whether there is a program.
  bool bindForDrawing(const GlobeTiles& tiles, bool night) const;
  /// Back to the default state.
  void unbind() const;

 private:
  void useProgram(GLuint program);
  void useSampler(const GlobeTiles& tiles, bool polar);
  void drawChunk(const SelectedChunk& chunk, const Job& job, GlobeTiles& tiles);

  ChunkPrograms programs_;
  GLuint inUse_ = 0;    ///< program, while draw() draws
  bool polar_ = false;  ///< sampler, likewise
  UniformRing uniforms_;
};

}  // namespace meridian::globebrowsing
