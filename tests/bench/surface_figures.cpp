#include "surface_figures.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

namespace meridian::bench {

namespace {

using namespace globebrowsing;

std::size_t coveredPixels(SettledGlobe& globe, glm::ivec2 size) {
  std::vector<float> depth(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, globe.renderer().target().framebuffer());
  glReadPixels(0, 0, size.x, size.y, GL_DEPTH_COMPONENT, GL_FLOAT, depth.data());
  return static_cast<std::size_t>(std::count_if(depth.begin(), depth.end(), [](float d) { return d > 0.0F; }));
}

/// Pixels, if it is in the picture.
std::optional<glm::dvec2> onScreen(const View& view, const glm::dvec3& position) {
  const glm::dvec4 clip = view.clipFromCamera * (view.cameraFromModel * glm::dvec4(position, 1.0));
  if (clip.w <= 0.0 || std::abs(clip.x) > clip.w || std::abs(clip.y) > clip.w) {
    return std::nullopt;
  }
  return glm::dvec2(clip.x, clip.y) / clip.w * 0.5 * glm::dvec2(view.size);
}

/// The largest distance on screen, along the vertical, between the chunk's triangles and the nodes of a grid four times
/// denser. (Along the surface triangles shift nothing but texels, near the poles by as much again.)
double errorOf(const SelectedChunk& chunk, const ChunkSurface& surface, const Tiling& tiling, const View& view) {
  const int segments = chunk_grid::segmentsAt(chunk.step);
  const int fine = std::min(4 * segments, ChunkSurface::nodes - 1);
  const int stride = fine / segments;
  const auto node = [&](int column, int row) {
    const glm::dvec2 uv(static_cast<double>(column) / fine, static_cast<double>(row) / fine);
    GeodeticPosition place = tiling.geodetic(chunk.index, uv);
    place.height = surface.heightAt(uv);
    return tiling.ellipsoid().cartesian(place);
  };
  double largest = 0.0;
  for (int row = 0; row < fine; row += stride) {
    for (int column = 0; column < fine; column += stride) {
      const glm::dvec3 nw = node(column, row);
      const glm::dvec3 ne = node(column + stride, row);
      const glm::dvec3 sw = node(column, row + stride);
      const glm::dvec3 se = node(column + stride, row + stride);
      for (int j = 0; j <= stride; ++j) {
        for (int i = 0; i <= stride; ++i) {
          const double a = static_cast<double>(i) / stride;
          const double b = static_cast<double>(j) / stride;
          const glm::dvec3 drawn = nw + (a <= b ? (sw - nw) * b + (se - sw) * a : (ne - nw) * a + (se - ne) * b);
          const GeodeticPosition place = tiling.geodetic(
              chunk.index, {static_cast<double>(column + i) / fine, static_cast<double>(row + j) / fine});
          const glm::dvec3 vertical = tiling.ellipsoid().normal(place.latitude, place.longitude);
          const glm::dvec3 exact = drawn + vertical * glm::dot(node(column + i, row + j) - drawn, vertical);
          const bool faces = glm::dot(view.cameraPosition - exact, vertical) > 0.0;
          const auto from = onScreen(view, drawn);
          const auto to = onScreen(view, exact);
          if (faces && from && to) {
            largest = std::max(largest, glm::distance(*from, *to));
          }
        }
      }
    }
  }
  return largest;
}

}  // namespace

SurfaceFigures measureSurface(SettledGlobe& globe, glm::ivec2 size) {
  SurfaceFigures figures;
  const View view = globe.view();
  for (const SelectedChunk& chunk : globe.surface().selected()) {
    if (chunk.views == 0) {
      continue;
    }
    const auto segments = static_cast<std::size_t>(chunk_grid::segmentsAt(chunk.step));
    ++figures.chunks;
    figures.triangles += 2 * segments * segments;
    figures.skirtTriangles += 8 * segments;
    if (const ChunkSurface* surface = globe.surface().tiles().surfaces().find(chunk.index)) {
      figures.errorPixels = std::max(figures.errorPixels, errorOf(chunk, *surface, globe.surface().tiling(), view));
    }
  }
  figures.coveredPixels = coveredPixels(globe, size);
  return figures;
}

}  // namespace meridian::bench
