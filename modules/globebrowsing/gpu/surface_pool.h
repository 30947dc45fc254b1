#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

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
  /// What one call draws. (On a software renderer each call with uniforms of its own copies some tens of kilobytes of
  /// state.)
  struct Draws {
    std::vector<GLsizei> counts;
    std::vector<const void*> firstElements;  ///< as OpenGL wants offsets into the element buffer
    std::vector<GLint> firstVertices;

    [[nodiscard]] std::size_t size() const { return counts.size(); }
    void clear();
  };

  explicit SurfacePool(std::uint32_t capacity);

  [[nodiscard]] static constexpr std::size_t bytesPerSlot() {
    return sizeof(SurfaceVertex) * chunk_grid::vertexCount +
           sizeof(NormalImage::Texel) * NormalImage::width * NormalImage::height;
  }

  [[nodiscard]] SlotPool<TileIndex>& slots() { return slots_; }
  [[nodiscard]] const SlotPool<TileIndex>& slots() const { return slots_; }
  void upload(std::uint32_t slot, const ChunkSurface& surface) const;

  /// The vertex array and the element buffer of all densities.
  void bind(GLuint normalUnit) const;
  /// Adds the chunk in that slot to the draws; `step` 0..4, skirts on the edges of `skirtEdges`.
  void add(Draws& draws, std::uint32_t slot, int step, chunk_grid::Columns columns, unsigned skirtEdges) const;
  /// Draws them in one call with the vertex array bound; shaders tell them apart by gl_DrawID.
  static void draw(const Draws& draws);

  /// The vertex layout alone, for warm-up draws on another context.
  static void describeVertices(GLuint vertexArray, GLuint vertexBuffer);
  static constexpr GLenum normalFormat = GL_RGBA8;

 private:
  SlotPool<TileIndex> slots_;
  graphics::Buffer vertices_;
  graphics::Buffer elements_;
  graphics::VertexArray vertexArray_;
  graphics::Texture normals_;
  /// A density with skirts on some edges: where its indices are in elements_.
  struct Elements {
    std::size_t firstByte = 0;
    int count = 0;
  };
  using EdgeSets = std::array<Elements, chunk_grid::edgeSets>;
  std::array<std::array<EdgeSets, chunk_grid::allColumns.size()>, chunk_grid::steps> ranges_{};
};

}  // namespace meridian::globebrowsing
