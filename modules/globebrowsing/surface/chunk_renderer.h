#pragma once

#include <array>
#include <compare>
#include <span>
#include <string>

#include "globebrowsing/chunks/selection.h"
#include "globebrowsing/gpu/globe_tiles.h"
#include "globebrowsing/gpu/uniform_ring.h"
#include "globebrowsing/surface/surface.h"
#include "host/graphics/graphics.h"

namespace meridian::globebrowsing {

/// What the program that draws chunks depends on, beside the layers, which are composed before.
struct ChunkProgramKey {
  bool shading = true;
  bool accurateNormals = false;
  bool night = false;
  bool overlay = false;
  bool edges = false;
  bool blended = false;  ///< not in the text: drivers make other machine code for it

  [[nodiscard]] std::string text() const;
  bool operator==(const ChunkProgramKey&) const = default;
};

/// Draws selected chunks: one program, two array textures and one vertex array for all, two uniform blocks. Render
/// thread only; a steady frame allocates nothing.
class ChunkRenderer {
 public:
  explicit ChunkRenderer(graphics::Graphics& graphics);

  /// Asks for the program of that key; until it is ready, the last one that was draws. Errors: shader templates.
  [[nodiscard]] Result<void> setProgram(const ChunkProgramKey& key);
  /// Whether the key's own program is ready.
  [[nodiscard]] bool ownProgramReady() const { return graphics_.programs().ready(wanted_) != 0; }
  [[nodiscard]] std::string programError() const;

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
  /// The program, textures and state of draw(), for drawing something else the same way; whether there is a program.
  bool bindForDrawing(const GlobeTiles& tiles) const;
  /// Back to the default state.
  void unbind() const;

 private:
  void drawChunk(const SelectedChunk& chunk, const Job& job, GlobeTiles& tiles);

  graphics::Graphics& graphics_;
  ChunkProgramKey key_;
  ChunkProgramKey drawnKey_;
  graphics::ProgramHandle wanted_;
  graphics::ProgramHandle drawn_;  ///< the last that was ready
  UniformRing uniforms_;
};

}  // namespace meridian::globebrowsing
