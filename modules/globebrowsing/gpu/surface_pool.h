#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "globebrowsing/gpu/slot_pool.h"
#include "globebrowsing/layers/chunk_surface.h"
#include "globebrowsing/tiling/tile_index.h"
#include "host/graphics/gl_objects.h"

namespace meridian::globebrowsing {

/// Vertices and normals of resident tiles: one vertex buffer and one array texture, cut into slots of equal size, so
/// that every chunk of every globe size is drawn with the same vertex array and without a texture change.
/// Render thread only.
class SurfacePool {
 public:
  explicit SurfacePool(std::uint32_t capacity);

  [[nodiscard]] static constexpr std::size_t bytesPerSlot() {
    return sizeof(SurfaceVertex) * chunk_grid::vertexCount +
           sizeof(ChunkSurface::NormalOffset) * ChunkSurface::nodes * ChunkSurface::nodes;
  }

  [[nodiscard]] SlotPool<TileIndex>& slots() { return slots_; }
  [[nodiscard]] const SlotPool<TileIndex>& slots() const { return slots_; }
  void upload(std::uint32_t slot, const ChunkSurface& surface) const;

  /// The vertex array and the element buffer of all densities.
  void bind(GLuint normalUnit) const;
  /// Draws the chunk in that slot with the vertex array bound; `step` 0..4.
  void draw(std::uint32_t slot, int step) const;
  /// The same without its skirts.
  void drawGrid(std::uint32_t slot, int step) const;

  /// The vertex layout alone, for warm-up draws on another context.
  static void describeVertices(GLuint vertexArray, GLuint vertexBuffer);
  static constexpr GLenum normalFormat = GL_RGBA8;

 private:
  void drawElements(std::uint32_t slot, int step, int count) const;

  SlotPool<TileIndex> slots_;
  graphics::Buffer vertices_;
  graphics::Buffer elements_;
  graphics::VertexArray vertexArray_;
  graphics::Texture normals_;
  std::array<std::size_t, chunk_grid::steps> firstElement_{};
  std::array<int, chunk_grid::steps> elementCount_{};
};

}  // namespace meridian::globebrowsing
