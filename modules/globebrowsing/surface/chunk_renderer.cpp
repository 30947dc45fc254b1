#include "globebrowsing/surface/chunk_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
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
  prepare(job, tiles);
  if (prepared_.empty()) {
    return 0;
  }
  ViewBlock view;
  // Positions reach the shader relative to the eye, so only the rotation of cameraFromModel is left to apply.
  const glm::dmat4 rotation(glm::dmat3(job.view->cameraFromModel));
  view.clipFromRelative = glm::mat4(job.view->clipFromCamera * rotation);
  view.lightDirection = glm::vec3(job.view->lightDirection);
  view.ambient = static_cast<float>(job.ambient);
  view.opacity = static_cast<float>(job.opacity);
  view.waterReflectance = static_cast<float>(job.waterReflectance);
  if (!isFinite(view)) {
    return 0;
  }
  // Translucent ones are not sorted by what they are drawn with: each may differ from the last.
  const std::size_t batches = programs_.key().blended
                                  ? prepared_.size()
                                  : std::min(prepared_.size(), prepared_.size() / ChunkBlock::most + variantCount);
  uniforms_.reserve(uniforms_.aligned(sizeof(ViewBlock)) + batches * uniforms_.aligned(sizeof(ChunkBlock)));
  uniforms_.writeAndBind(viewBlock, view);

  for (auto first = prepared_.begin(); first != prepared_.end();) {
    const auto alike = [&](const Prepared& prepared) { return prepared.variant == first->variant; };
    const auto most = std::min(static_cast<std::ptrdiff_t>(ChunkBlock::most), prepared_.end() - first);
    const auto last = std::find_if_not(first, first + most, alike);
    if (!bindForDrawing(tiles, first->variant.use, first->variant.sampling)) {
      return 0;
    }
    drawBatch({first, last}, job, tiles);
    first = last;
  }
  unbind();
  return prepared_.size();
}

void ChunkRenderer::prepare(const Job& job, GlobeTiles& tiles) {
  prepared_.clear();
  tiles.composites().beginDrawing();
  for (const SelectedChunk& chunk : job.chunks) {
    const ChunkSurface* surface = tiles.surfaces().find(chunk.index);
    const std::optional<std::uint32_t> slot = tiles.surfaces().slot(chunk.index);
    if ((chunk.views >> job.viewNumber & 1U) == 0 || surface == nullptr || !slot) {
      continue;
    }
    const bool night = programs_.key().night && !isInDaylight(*surface, job.view->lightDirection);
    const Placements composites = place(chunk, night, tiles);
    const bool fades = std::any_of(composites.begin(), composites.end(),
                                   [](const auto& placement) { return placement && placement->otherWeight > 0.0F; });
    const Variant variant{{night, fades}, samplingOf(*surface, chunk, texelsAcross(composites), *job.view)};
    prepared_.push_back({&chunk, surface, *slot, variant, composites});
  }
  // What is translucent is drawn near to far whatever it takes: nothing may shine through the globe itself.
  if (!programs_.key().blended) {
    std::sort(prepared_.begin(), prepared_.end(), [](const Prepared& a, const Prepared& b) {
      return a.variant != b.variant ? a.variant < b.variant : a.chunk < b.chunk;
    });
  }
}

TexelsAcross ChunkRenderer::texelsAcross(const Placements& composites) {
  TexelsAcross texels{std::numeric_limits<double>::infinity(), 0.0};
  for (const auto& placement : composites) {
    if (placement) {
      const double across = double{placement->transform.z} * colourLayout.size();
      texels = {std::min(texels.fewest, across), std::max(texels.most, across)};
    }
  }
  return texels;
}

ChunkRenderer::Placements ChunkRenderer::place(const SelectedChunk& chunk, bool night, GlobeTiles& tiles) const {
  const std::array<bool, compositeKindCount> used{true, night, programs_.key().overlay};
  Placements placements;
  for (const CompositeKind kind : allCompositeKinds) {
    const auto i = static_cast<std::size_t>(kind);
    if (used[i]) {
      placements[i] = tiles.composites().place(kind, chunk.index, chunk.colourLevel);
    }
  }
  return placements;
}

bool ChunkRenderer::bindForDrawing(const GlobeTiles& tiles, const ChunkProgramUse& use,
                                   Composer::Sampling sampling) const {
  const GLuint program = programs_.program(use);
  if (program == 0) {
    return false;
  }
  glUseProgram(program);
  glEnable(GL_CULL_FACE);
  tiles.composites().composer().bindComposites(compositeUnit, sampling);
  if (programs_.key().blended) {
    enableBlending();
  }
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

void ChunkRenderer::drawBatch(std::span<const Prepared> batch, const Job& job, GlobeTiles& tiles) {
  const UniformRing::Block block = uniforms_.take(sizeof(ChunkBlock));
  auto* parameters = reinterpret_cast<ChunkParameters*>(block.bytes);
  draws_.clear();
  for (const Prepared& prepared : batch) {
    *parameters++ = parametersOf(prepared, job);
    tiles.surfaces().pool().add(draws_, prepared.slot, prepared.chunk->step, prepared.surface->columns(),
                                job.skirts ? prepared.chunk->skirtEdges : 0U);
  }
  uniforms_.bind(chunkBlock, block);
  SurfacePool::draw(draws_);
}

ChunkParameters ChunkRenderer::parametersOf(const Prepared& prepared, const Job& job) const {
  const SelectedChunk& chunk = *prepared.chunk;
  const ChunkSurface& surface = *prepared.surface;
  ChunkParameters parameters;
  for (std::size_t i = 0; i < parameters.corners.size(); ++i) {
    parameters.corners[i] = glm::vec4(glm::vec3(surface.corners()[i] - job.view->cameraPosition), 1.0F);
  }
  for (std::size_t i = 0; i < compositeKindCount; ++i) {
    if (const auto& placement = prepared.composites[i]) {
      parameters.composites[i] = placement->transform;
      parameters.layers[static_cast<int>(i)] = static_cast<float>(placement->slot);
      if (placement->otherWeight > 0.0F) {
        parameters.otherLayer = static_cast<float>(placement->otherSlot);
        parameters.otherWeight = placement->otherWeight;
      }
    }
  }
  parameters.layers.w = static_cast<float>(prepared.slot);
  parameters.skirt = static_cast<float>(chunk.skirt);
  parameters.flare = static_cast<float>(skirtFlare * surface.drift(chunk.step));
  parameters.lift = static_cast<float>(surface.lift(chunk.step));
  parameters.level = static_cast<float>(chunk.index.level);
  parameters.normals = NormalImage::transform(normalLevel(surface, chunk, *job.view));
  parameters.normalScale = static_cast<float>(surface.normals().scale());
  return parameters;
}

}  // namespace meridian::globebrowsing
