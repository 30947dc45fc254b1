#pragma once

#include "settled_globe.h"
#include "surface_figures.h"

namespace meridian::bench {

/// The least that a frame can cost: its own number of triangles over its own number of pixels, in one draw, with its
/// own program, array textures, texel densities, target, depth format and blit. Its normals come from one image that
/// has as many as the frame's chunks have together: the same few over and over would never leave the processor's cache.
class FloorDraw {
 public:
  FloorDraw(SettledGlobe& globe, glm::ivec2 size, const SurfaceFigures& figures);

  /// Draws it and waits for it; milliseconds.
  double frame();

 private:
  void makeGrid(const SurfaceFigures& figures);
  void makeBlocks(const SurfaceFigures& figures);

  SettledGlobe& globe_;
  glm::ivec2 size_;
  graphics::Buffer vertices_;
  graphics::Buffer elements_;
  graphics::VertexArray vertexArray_;
  graphics::Texture normals_;
  graphics::Buffer viewBlock_;
  graphics::Buffer chunkBlock_;
  int elementCount_ = 0;
  bool night_ = false;
  globebrowsing::Composer::Sampling sampling_;
};

}  // namespace meridian::bench
