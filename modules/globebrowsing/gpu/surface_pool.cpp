#include "globebrowsing/gpu/surface_pool.h"

#include <cstddef>
#include <vector>

namespace meridian::globebrowsing {

namespace {

constexpr GLsizeiptr slotBytes = static_cast<GLsizeiptr>(sizeof(SurfaceVertex)) * chunk_grid::vertexCount;

}  // namespace

SurfacePool::SurfacePool(std::uint32_t capacity)
    : slots_(capacity),
      vertices_(slotBytes * static_cast<GLsizeiptr>(capacity), nullptr, GL_DYNAMIC_STORAGE_BIT),
      vertexArray_(graphics::VertexArray::create()),
      normals_(graphics::Texture::array2D(normalFormat, NormalImage::width, NormalImage::height,
                                          static_cast<int>(capacity))) {
  std::vector<std::uint16_t> all;
  for (int step = 0; step < chunk_grid::steps; ++step) {
    for (const chunk_grid::Columns columns : chunk_grid::allColumns) {
      for (unsigned edges = 0; edges < chunk_grid::edgeSets; ++edges) {
        const std::vector<std::uint16_t> indices = chunk_grid::indices(step, columns, edges);
        ranges_[static_cast<std::size_t>(step)][static_cast<std::size_t>(columns)][edges] = {
            all.size() * sizeof(std::uint16_t), static_cast<int>(indices.size())};
        all.insert(all.end(), indices.begin(), indices.end());
      }
    }
  }
  elements_ = graphics::Buffer(static_cast<GLsizeiptr>(all.size() * sizeof(std::uint16_t)), all.data(), 0);
  describeVertices(vertexArray_.id(), vertices_.id());
  glVertexArrayElementBuffer(vertexArray_.id(), elements_.id());
}

void SurfacePool::describeVertices(GLuint vertexArray, GLuint vertexBuffer) {
  glVertexArrayVertexBuffer(vertexArray, 0, vertexBuffer, 0, sizeof(SurfaceVertex));
  glVertexArrayAttribFormat(vertexArray, 0, 4, GL_FLOAT, GL_FALSE, offsetof(SurfaceVertex, offset));
  glVertexArrayAttribFormat(vertexArray, 1, 3, GL_FLOAT, GL_FALSE, offsetof(SurfaceVertex, normal));
  glVertexArrayAttribFormat(vertexArray, 2, 4, GL_UNSIGNED_BYTE, GL_FALSE, offsetof(SurfaceVertex, place));
  for (GLuint attribute = 0; attribute < 3; ++attribute) {
    glVertexArrayAttribBinding(vertexArray, attribute, 0);
    glEnableVertexArrayAttrib(vertexArray, attribute);
  }
}

void SurfacePool::upload(std::uint32_t slot, const ChunkSurface& surface) const {
  vertices_.write(slotBytes * static_cast<GLsizeiptr>(slot), slotBytes, surface.vertices().data());
  glTextureSubImage3D(normals_.id(), 0, 0, 0, static_cast<GLint>(slot), NormalImage::width, NormalImage::height, 1,
                      GL_RGBA, GL_UNSIGNED_BYTE, surface.normals().texels().data());
}

void SurfacePool::bind(GLuint normalUnit) const {
  glBindVertexArray(vertexArray_.id());
  glBindTextureUnit(normalUnit, normals_.id());
}

void SurfacePool::Draws::clear() {
  counts.clear();
  firstElements.clear();
  firstVertices.clear();
}

void SurfacePool::add(Draws& draws, std::uint32_t slot, int step, chunk_grid::Columns columns,
                      unsigned skirtEdges) const {
  const Elements& range = ranges_[static_cast<std::size_t>(step)][static_cast<std::size_t>(columns)][skirtEdges];
  draws.counts.push_back(range.count);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): OpenGL takes the offset as a pointer.
  draws.firstElements.push_back(reinterpret_cast<const void*>(range.firstByte));
  draws.firstVertices.push_back(static_cast<GLint>(slot) * chunk_grid::vertexCount);
}

void SurfacePool::draw(const Draws& draws) {
  glMultiDrawElementsBaseVertex(GL_TRIANGLES, draws.counts.data(), GL_UNSIGNED_SHORT, draws.firstElements.data(),
                                static_cast<GLsizei>(draws.size()), draws.firstVertices.data());
}

}  // namespace meridian::globebrowsing
