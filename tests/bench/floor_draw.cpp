#include "floor_draw.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "globebrowsing/gpu/chunk_blocks.h"
#include "globebrowsing/source/tile_layout.h"

namespace meridian::bench {

namespace {

using namespace globebrowsing;
using Clock = std::chrono::steady_clock;

/// As SurfaceVertex, but its place is in floats, because it runs over more than one tile.
struct FloorVertex {
  std::array<float, 3> clip{};
  float height = 0.0F;
  std::array<float, 3> normal{0.0F, 0.0F, 1.0F};
  std::array<float, 3> place{};
};

/// 0..1..0..1: goes over the same tile forth and back, one texel a pixel, without leaving it.
double fold(double tiles) {
  const double turn = std::fmod(tiles, 2.0);
  return turn <= 1.0 ? turn : 2.0 - turn;
}

}  // namespace

FloorDraw::FloorDraw(SettledGlobe& globe, glm::ivec2 size, const SurfaceFigures& figures)
    : globe_(globe),
      size_(size),
      vertexArray_(graphics::VertexArray::create()),
      night_(figures.mostlyNight),
      sampling_{quantile(figures.texelDensities, 0.5) <= 1.0 ? Composer::Sampling::Kind::OneLevel
                                                             : Composer::Sampling::Kind::Plain} {
  makeGrid(figures);
  makeBlocks(figures);
}

void FloorDraw::makeGrid(const SurfaceFigures& figures) {
  const double share = std::sqrt(static_cast<double>(figures.coveredPixels) / (static_cast<double>(size_.x) * size_.y));
  const glm::dvec2 extent = glm::dvec2(size_) * share;
  const double cells = static_cast<double>(figures.triangles + figures.skirtTriangles) / 2.0;
  const int columns = std::max(1, static_cast<int>(std::lround(std::sqrt(cells * extent.x / extent.y))));
  const int rows = std::max(1, static_cast<int>(std::lround(cells / columns)));
  std::vector<FloorVertex> vertices;
  std::vector<std::uint32_t> elements;
  const auto addRow = [&](int row, double density) {
    for (int column = 0; column <= columns; ++column) {
      const glm::dvec2 part(static_cast<double>(column) / columns, static_cast<double>(row) / rows);
      const glm::dvec2 tiles = part * extent * density / double{colourLayout.interior};
      vertices.push_back(
          {{static_cast<float>((2.0 * part.x - 1.0) * share), static_cast<float>((2.0 * part.y - 1.0) * share), 0.5F},
           0.0F,
           {0.0F, 0.0F, 1.0F},
           {static_cast<float>(32.0 * fold(tiles.x)), static_cast<float>(32.0 * fold(tiles.y)), 0.0F}});
    }
  };
  // Each row of cells has the texel density of its share of the frame's pixels: half-size levels are blended where the
  // density lies between two, so one density for all would cost another.
  for (int row = 0; row < rows; ++row) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const double density = quantile(figures.texelDensities, (row + 0.5) / rows);
    addRow(row, density);
    addRow(row + 1, density);
    for (auto column = first; column < first + static_cast<std::uint32_t>(columns); ++column) {
      const auto above = column + static_cast<std::uint32_t>(columns) + 1;
      elements.insert(elements.end(), {column, column + 1, above + 1, column, above + 1, above});
    }
  }
  elementCount_ = static_cast<int>(elements.size());
  vertices_ = graphics::Buffer(static_cast<GLsizeiptr>(vertices.size() * sizeof(FloorVertex)), vertices.data(), 0);
  elements_ = graphics::Buffer(static_cast<GLsizeiptr>(elements.size() * sizeof(std::uint32_t)), elements.data(), 0);
  const GLuint array = vertexArray_.id();
  glVertexArrayVertexBuffer(array, 0, vertices_.id(), 0, sizeof(FloorVertex));
  glVertexArrayElementBuffer(array, elements_.id());
  glVertexArrayAttribFormat(array, 0, 4, GL_FLOAT, GL_FALSE, offsetof(FloorVertex, clip));
  glVertexArrayAttribFormat(array, 1, 3, GL_FLOAT, GL_FALSE, offsetof(FloorVertex, normal));
  glVertexArrayAttribFormat(array, 2, 3, GL_FLOAT, GL_FALSE, offsetof(FloorVertex, place));
  for (GLuint attribute = 0; attribute < 3; ++attribute) {
    glVertexArrayAttribBinding(array, attribute, 0);
    glEnableVertexArrayAttrib(array, attribute);
  }
}

void FloorDraw::makeBlocks(const SurfaceFigures& figures) {
  ViewBlock view;
  view.lightDirection = {0.0F, 0.6F, 0.8F};
  view.ambient = 0.05F;
  viewBlock_ = graphics::Buffer(sizeof(view), &view, 0);
  ChunkBlock block;
  ChunkParameters& chunk = block.chunks[0];
  // No corners: the vertices are in clip space already.
  chunk.corners.fill(glm::vec4(0.0F));
  const SelectedChunk& nearest = globe_.surface().selected().front();
  for (const CompositeKind kind : allCompositeKinds) {
    if (const auto placement = globe_.surface().tiles().composites().place(kind, nearest.index, nearest.colourLevel)) {
      const float border = static_cast<float>(colourLayout.border) / static_cast<float>(colourLayout.size());
      const float interior = static_cast<float>(colourLayout.interior) / static_cast<float>(colourLayout.size());
      chunk.composites[static_cast<std::size_t>(kind)] = {border, border, interior, interior};
      chunk.layers[static_cast<int>(kind)] = static_cast<float>(placement->slot);
    }
  }
  constexpr double mostTexels = 4096.0;
  const double normals = std::clamp(std::ceil(std::sqrt(static_cast<double>(figures.normals))), 1.0, mostTexels);
  normals_ =
      graphics::Texture::array2D(SurfacePool::normalFormat, static_cast<int>(normals), static_cast<int>(normals), 1);
  const std::vector<std::uint8_t> flat(static_cast<std::size_t>(4.0 * normals * normals), 128);
  glTextureSubImage3D(normals_.id(), 0, 0, 0, 0, static_cast<int>(normals), static_cast<int>(normals), 1, GL_RGBA,
                      GL_UNSIGNED_BYTE, flat.data());
  // All of it, or what a tile's unit square spans at the frame's density, if the pixels fold over several.
  const double pixels = std::sqrt(static_cast<double>(figures.coveredPixels));
  const double tiles = pixels * quantile(figures.texelDensities, 0.5) / double{colourLayout.interior};
  const auto share = static_cast<float>(1.0 / std::max(tiles, 1e-3));
  chunk.normals = {0.0F, 0.0F, share, share};
  chunk.layers.w = 0.0F;
  chunkBlock_ = graphics::Buffer(sizeof(block), &block, 0);
}

double FloorDraw::frame() {
  const auto start = Clock::now();
  app::SceneRenderer& renderer = globe_.renderer();
  renderer.beginFrame();
  renderer.target().bind();
  renderer.target().clear({0.0F, 0.0F, 0.0F, 1.0F});
  globe_.surface().renderer().bindForDrawing(globe_.surface().tiles(), {night_, false}, sampling_);
  glBindVertexArray(vertexArray_.id());
  glBindTextureUnit(chunk_bindings::normalUnit, normals_.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, viewBlock_.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, chunkBlock_.id());
  glDrawElements(GL_TRIANGLES, elementCount_, GL_UNSIGNED_INT, nullptr);
  globe_.surface().renderer().unbind();
  globe_.blit();
  renderer.endFrame();
  renderer.waitForFrame();
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace meridian::bench
