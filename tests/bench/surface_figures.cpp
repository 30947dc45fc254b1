#include "surface_figures.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include "globebrowsing/source/tile_layout.h"
#include "globebrowsing/surface/chunk_sampling.h"

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
  const int rows = chunk_grid::segmentsAt(chunk.step);
  const int fine = std::min(4 * rows, ChunkSurface::nodes - 1);
  const int down = fine / rows;
  const int across = fine / chunk_grid::columnsAt(chunk.step, surface.columns());
  const auto placeAt = [&](int column, int row) {
    const glm::dvec2 uv(static_cast<double>(column) / fine, static_cast<double>(row) / fine);
    GeodeticPosition place = tiling.geodetic(chunk.index, uv);
    place.height = surface.heightAt(uv);
    return place;
  };
  const auto exactAt = [&](int column, int row) { return tiling.ellipsoid().cartesian(placeAt(column, row)); };
  const auto drawnAt = [&](int column, int row) {
    GeodeticPosition place = placeAt(column, row);
    place.height += surface.lift(chunk.step);
    return tiling.ellipsoid().cartesian(place);
  };
  double largest = 0.0;
  for (int row = 0; row < fine; row += down) {
    const bool atNorthPole = surface.columns() == chunk_grid::Columns::HalfToNorthPole && row == 0;
    const bool atSouthPole = surface.columns() == chunk_grid::Columns::HalfToSouthPole && row + down == fine;
    for (int column = 0; column < fine; column += across) {
      const glm::dvec3 nw = drawnAt(column, row);
      const glm::dvec3 ne = drawnAt(column + across, row);
      const glm::dvec3 sw = drawnAt(column, row + down);
      const glm::dvec3 se = drawnAt(column + across, row + down);
      for (int j = 0; j <= down; ++j) {
        for (int i = 0; i <= across; ++i) {
          const double a = static_cast<double>(i) / across;
          const double b = static_cast<double>(j) / down;
          const glm::dvec3 drawn = atNorthPole   ? nw + (sw - nw + (se - sw) * a) * b
                                   : atSouthPole ? sw + (nw - sw + (ne - nw) * a) * (1.0 - b)
                                   : a <= b      ? nw + (sw - nw) * b + (se - sw) * a
                                                 : nw + (ne - nw) * a + (se - ne) * b;
          const GeodeticPosition place = tiling.geodetic(
              chunk.index, {static_cast<double>(column + i) / fine, static_cast<double>(row + j) / fine});
          const glm::dvec3 vertical = tiling.ellipsoid().normal(place.latitude, place.longitude);
          const glm::dvec3 exact = drawn + vertical * glm::dot(exactAt(column + i, row + j) - drawn, vertical);
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

/// Where in the picture (-1..1) a ray meets the surface: texel coordinates within the composite that is drawn there.
std::optional<glm::dvec2> texelAt(SettledGlobe& globe, const View& view, const glm::dvec2& clip) {
  const glm::dvec4 ahead = glm::inverse(view.clipFromCamera) * glm::dvec4(clip, 0.5, 1.0);
  const glm::dmat3 modelFromCamera = glm::transpose(glm::dmat3(view.cameraFromModel));
  const auto hit = globe.surface().pick(view.cameraPosition, modelFromCamera * (glm::dvec3(ahead) / ahead.w));
  if (!hit) {
    return std::nullopt;
  }
  const Tiling& tiling = globe.surface().tiling();
  const GeodeticPosition position = tiling.ellipsoid().geodetic(*hit);
  for (const SelectedChunk& chunk : globe.surface().selected()) {
    const TilePlace place = tiling.locate(position.latitude, position.longitude, chunk.index.level);
    if (place.index == chunk.index) {
      const auto drawn =
          globe.surface().tiles().composites().place(CompositeKind::Base, chunk.index, chunk.colourLevel);
      return drawn ? std::optional(glm::dvec2(drawn->transform.z, drawn->transform.w) * place.uv *
                                   double{colourLayout.size()})
                   : std::nullopt;
    }
  }
  return std::nullopt;
}

std::vector<double> texelDensities(SettledGlobe& globe, const View& view) {
  constexpr int across = 12;
  const glm::dvec2 pixel = 2.0 / glm::dvec2(view.size);
  std::vector<double> found;
  for (int row = -across; row <= across; ++row) {
    for (int column = -across; column <= across; ++column) {
      const glm::dvec2 clip = glm::dvec2(column, row) / (across + 0.5);
      const auto here = texelAt(globe, view, clip);
      const auto right = texelAt(globe, view, clip + glm::dvec2(pixel.x, 0.0));
      const auto above = texelAt(globe, view, clip + glm::dvec2(0.0, pixel.y));
      if (here && right && above) {
        const glm::dvec2 a = *right - *here;
        const glm::dvec2 b = *above - *here;
        found.push_back(std::sqrt(std::abs(a.x * b.y - a.y * b.x)));
      }
    }
  }
  if (found.empty()) {
    return {1.0};
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

double quantile(const std::vector<double>& ascending, double part) {
  const auto last = static_cast<double>(ascending.size() - 1);
  return ascending[static_cast<std::size_t>(std::lround(part * last))];
}

SurfaceFigures measureSurface(SettledGlobe& globe, glm::ivec2 size) {
  SurfaceFigures figures;
  const View view = globe.view();
  for (const SelectedChunk& chunk : globe.surface().selected()) {
    if (chunk.views == 0) {
      continue;
    }
    ++figures.chunks;
    if (const ChunkSurface* surface = globe.surface().tiles().surfaces().find(chunk.index)) {
      const auto triangles = [&](unsigned edges) {
        return chunk_grid::indices(chunk.step, surface->columns(), edges).size() / 3;
      };
      const auto nodes = static_cast<std::size_t>(NormalImage::nodesAt(normalLevel(*surface, chunk, view)));
      figures.normals += nodes * nodes;
      figures.triangles += triangles(0);
      figures.skirtTriangles += triangles(chunk.skirtEdges) - triangles(0);
      figures.errorPixels = std::max(figures.errorPixels, errorOf(chunk, *surface, globe.surface().tiling(), view));
    }
  }
  std::size_t dark = 0;
  for (const SelectedChunk& chunk : globe.surface().selected()) {
    const ChunkSurface* surface = globe.surface().tiles().surfaces().find(chunk.index);
    dark += surface != nullptr && !isInDaylight(*surface, view.lightDirection) ? 1 : 0;
  }
  figures.mostlyNight = 2 * dark > globe.surface().selected().size();
  figures.texelDensities = texelDensities(globe, view);
  figures.coveredPixels = coveredPixels(globe, size);
  return figures;
}

}  // namespace meridian::bench
