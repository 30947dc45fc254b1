#include "globebrowsing/surface/chunk_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "globebrowsing/gpu/chunk_blocks.h"
#include "globebrowsing/source/tile_layout.h"

namespace meridian::globebrowsing {

namespace {

using namespace chunk_bindings;

/// The night layers begin to show where the light is that low over the horizon (chunk.frag).
const double leastDaylight = std::asin(0.2);

/// A skirt's foot is moved away from the middle of its chunk, which at the corners is halfway along the edge.
constexpr double skirtFlare = 1.5;

/// Tiles that touch a pole taper to nothing; in the others the wider edge is at most about twice the narrower.
constexpr double polarTaper = 0.9;

/// Whether a chunk is sampled as polar tiles are. One that is shown much smaller than its composite needs all levels.
bool isPolar(const ChunkSurface& surface, const SelectedChunk& chunk, const View& view) {
  constexpr double mostTexelsPerPixel = 3.0;
  const double meridian = glm::distance(surface.corners()[0], surface.corners()[2]);
  return std::abs(surface.taper()) > polarTaper &&
         colourLayout.interior * chunk.distance < mostTexelsPerPixel * meridian * view.pixelsPerRadian;
}

/// A camera that is not a number never reaches the GPU.
bool isFinite(const ViewBlock& view) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(view.clipFromRelative[column][row])) {
        return false;
      }
    }
  }
  const glm::vec3& light = view.lightDirection;
  return std::isfinite(light.x) && std::isfinite(light.y) && std::isfinite(light.z);
}

}  // namespace

bool isInDaylight(const ChunkSurface& surface, const glm::dvec3& light) {
  const ChunkSurface::NormalCone& cone = surface.normalCone();
  const double fromLight = std::acos(std::clamp(glm::dot(cone.axis, light), -1.0, 1.0));
  return fromLight + cone.angle < std::numbers::pi / 2.0 - leastDaylight;
}

ChunkRenderer::ChunkRenderer(graphics::Graphics& graphics)
    : programs_(graphics),
      uniforms_(std::size_t{128} << 10, static_cast<std::size_t>(graphics.limits().uniformBlockAlignment)) {}

std::size_t ChunkRenderer::draw(const Job& job, GlobeTiles& tiles) {
  const auto isVisible = [&](const SelectedChunk& chunk) { return (chunk.views >> job.viewNumber & 1U) != 0; };
  if (std::none_of(job.chunks.begin(), job.chunks.end(), isVisible)) {
    return 0;
  }
  ViewBlock view;
  // Positions reach the shader relative to the eye, so only the rotation of cameraFromModel is left to apply.
  const glm::dmat4 rotation(glm::dmat3(job.view->cameraFromModel));
  view.clipFromRelative = glm::mat4(job.view->clipFromCamera * rotation);
  view.lightDirection = glm::vec3(job.view->lightDirection);
  view.ambient = static_cast<float>(job.ambient);
  view.opacity = static_cast<float>(job.opacity);
  if (!isFinite(view)) {
    return 0;
  }
  uniforms_.reserve(uniforms_.aligned(sizeof(ViewBlock)) + job.chunks.size() * uniforms_.aligned(sizeof(ChunkBlock)));
  uniforms_.writeAndBind(viewBlock, view);

  if (!bindForDrawing(tiles, true)) {
    return 0;
  }
  if (programs_.key().blended) {
    enableBlending();
  }
  inUse_ = programs_.full();
  polar_ = false;
  std::size_t drawn = 0;
  for (const SelectedChunk& chunk : job.chunks) {
    if (isVisible(chunk)) {
      drawChunk(chunk, job, tiles);
      ++drawn;
    }
  }
  unbind();
  return drawn;
}

bool ChunkRenderer::bindForDrawing(const GlobeTiles& tiles, bool night) const {
  const GLuint program = night ? programs_.full() : programs_.daylight();
  if (program == 0) {
    return false;
  }
  glUseProgram(program);
  glEnable(GL_CULL_FACE);
  glBindTextureUnit(compositeUnit, tiles.composites().composer().composites());
  glBindSampler(compositeUnit, tiles.composites().composer().samplers().plain.id());
  tiles.surfaces().pool().bind(normalUnit);
  return true;
}

void ChunkRenderer::unbind() const {
  glBindVertexArray(0);
  glBindSampler(compositeUnit, 0);
  glDisable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ZERO);
  glDisable(GL_CULL_FACE);
  glUseProgram(0);
}

void ChunkRenderer::useProgram(GLuint program) {
  if (program != inUse_) {
    glUseProgram(program);
    inUse_ = program;
  }
}

void ChunkRenderer::useSampler(const GlobeTiles& tiles, bool polar) {
  if (polar != polar_) {
    const Composer::Samplers& samplers = tiles.composites().composer().samplers();
    glBindSampler(compositeUnit, polar ? samplers.polar.id() : samplers.plain.id());
    polar_ = polar;
  }
}

void ChunkRenderer::drawChunk(const SelectedChunk& chunk, const Job& job, GlobeTiles& tiles) {
  const ChunkSurface* surface = tiles.surfaces().find(chunk.index);
  const std::optional<std::uint32_t> slot = tiles.surfaces().slot(chunk.index);
  if (surface == nullptr || !slot) {
    return;
  }
  const bool lit = isInDaylight(*surface, job.view->lightDirection);
  useSampler(tiles, isPolar(*surface, chunk, *job.view));
  useProgram(lit ? programs_.daylight() : programs_.full());
  ChunkBlock block;
  for (std::size_t i = 0; i < block.corners.size(); ++i) {
    block.corners[i] = glm::vec4(glm::vec3(surface->corners()[i] - job.view->cameraPosition), 1.0F);
  }
  const std::array<bool, compositeKindCount> used{true, programs_.key().night && !lit, programs_.key().overlay};
  for (const CompositeKind kind : allCompositeKinds) {
    const auto i = static_cast<std::size_t>(kind);
    if (!used[i]) {
      continue;
    }
    if (const auto placement = tiles.composites().place(kind, chunk.index, chunk.colourLevel)) {
      block.composites[i] = placement->transform;
      block.layers[static_cast<int>(i)] = static_cast<float>(placement->slot);
    }
  }
  block.layers.w = static_cast<float>(*slot);
  block.skirt = static_cast<float>(chunk.skirt);
  block.flare = static_cast<float>(skirtFlare * surface->drift(chunk.step));
  block.lift = static_cast<float>(surface->lift(chunk.step));
  block.level = static_cast<float>(chunk.index.level);
  block.normalScale = static_cast<float>(surface->normalScale());
  uniforms_.writeAndBind(chunkBlock, block);
  tiles.surfaces().pool().draw(*slot, chunk.step, surface->columns(), job.skirts ? chunk.skirtEdges : 0U);
}

}  // namespace meridian::globebrowsing
