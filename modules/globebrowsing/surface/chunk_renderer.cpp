#include "globebrowsing/surface/chunk_renderer.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>

#include "globebrowsing/gpu/chunk_blocks.h"

namespace meridian::globebrowsing {

namespace {

constexpr GLuint viewBinding = 0;
constexpr GLuint chunkBinding = 1;
constexpr GLuint compositeUnit = 0;
constexpr GLuint normalUnit = 1;

std::string defines(const ChunkProgramKey& key) {
  return fmt::format(
      "#define SHADING {}\n#define ACCURATE_NORMALS {}\n#define NIGHT {}\n#define OVERLAY {}\n#define EDGES {}\n",
      int{key.shading}, int{key.accurateNormals}, int{key.night}, int{key.overlay}, int{key.edges});
}

void enableBlending() {
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
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

/// Draws one triangle as chunks are drawn, with textures, vertices and a target of its own.
void warmChunks(GLuint program, bool blended) {
  constexpr int size = 24;
  const graphics::Texture composites = graphics::Texture::array2D(GL_RGBA8, size, size, 2, Composer::levelCount);
  const graphics::Texture normals = graphics::Texture::array2D(SurfacePool::normalFormat, size, size, 2);
  const graphics::Sampler sampler = graphics::Sampler::create(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR);
  const graphics::Texture colour = graphics::Texture::image2D(GL_RGBA8, size, size);
  const graphics::Texture depth = graphics::Texture::image2D(GL_DEPTH_COMPONENT32F, size, size);
  const graphics::Framebuffer framebuffer = graphics::Framebuffer::create();
  framebuffer.attach(GL_COLOR_ATTACHMENT0, colour);
  framebuffer.attach(GL_DEPTH_ATTACHMENT, depth);
  std::array<SurfaceVertex, 3> corners{};
  corners[1].offset = {1.0F, 0.0F, 0.0F};
  corners[2].offset = {0.0F, 1.0F, 0.0F};
  const std::array<std::uint16_t, 3> order{0, 1, 2};
  const graphics::Buffer vertices(sizeof(corners), corners.data(), 0);
  const graphics::Buffer elements(sizeof(order), order.data(), 0);
  const graphics::VertexArray vertexArray = graphics::VertexArray::create();
  SurfacePool::describeVertices(vertexArray.id(), vertices.id());
  glVertexArrayElementBuffer(vertexArray.id(), elements.id());
  const ViewBlock view;
  const ChunkBlock chunk;
  const graphics::Buffer viewBlock(sizeof(view), &view, 0);
  const graphics::Buffer chunkBlock(sizeof(chunk), &chunk, 0);

  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glViewport(0, 0, size, size);
  const float far = 0.0F;
  glClearNamedFramebufferfv(framebuffer.id(), GL_DEPTH, 0, &far);
  glEnable(GL_CULL_FACE);
  if (blended) {
    enableBlending();
  }
  glBindTextureUnit(compositeUnit, composites.id());
  glBindSampler(compositeUnit, sampler.id());
  glBindTextureUnit(normalUnit, normals.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, viewBinding, viewBlock.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, chunkBinding, chunkBlock.id());
  glUseProgram(program);
  glBindVertexArray(vertexArray.id());
  glDrawElementsBaseVertex(GL_TRIANGLES, 3, GL_UNSIGNED_SHORT, nullptr, 0);
}

}  // namespace

std::string ChunkProgramKey::text() const {
  return fmt::format("chunks{}{}{}{}{}{}", shading ? " shading" : "", accurateNormals ? " normals" : "",
                     night ? " night" : "", overlay ? " overlay" : "", edges ? " edges" : "",
                     blended ? " blended" : "");
}

ChunkRenderer::ChunkRenderer(graphics::Graphics& graphics)
    : graphics_(graphics),
      uniforms_(std::size_t{128} << 10, static_cast<std::size_t>(graphics.limits().uniformBlockAlignment)) {}

Result<void> ChunkRenderer::setProgram(const ChunkProgramKey& key) {
  if (wanted_ && key == key_) {
    if (ownProgramReady()) {
      drawn_ = wanted_;
      drawnKey_ = key_;
    }
    return {};
  }
  const graphics::Substitutions substitutions{{"defines", defines(key)}};
  Result<graphics::ShaderSource> vertex = graphics_.templates().load("surface/chunk.vert", substitutions);
  if (!vertex) {
    return tl::make_unexpected(vertex.error());
  }
  Result<graphics::ShaderSource> fragment = graphics_.templates().load("surface/chunk.frag", substitutions);
  if (!fragment) {
    return tl::make_unexpected(fragment.error());
  }
  key_ = key;
  const auto warm = [blended = key.blended](GLuint program) { warmChunks(program, blended); };
  wanted_ = graphics_.programs().request({key.text(), *std::move(vertex), *std::move(fragment), warm});
  return {};
}

std::string ChunkRenderer::programError() const {
  const Result<GLuint> built = graphics_.programs().get(wanted_);
  return built ? std::string() : built.error().message();
}

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
  uniforms_.writeAndBind(viewBinding, view);

  if (!bindForDrawing(tiles)) {
    return 0;
  }
  if (drawnKey_.blended) {
    enableBlending();
  }
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

bool ChunkRenderer::bindForDrawing(const GlobeTiles& tiles) const {
  const GLuint program = graphics_.programs().ready(drawn_);
  if (program == 0) {
    return false;
  }
  glUseProgram(program);
  glEnable(GL_CULL_FACE);
  glBindTextureUnit(compositeUnit, tiles.composites().composer().composites());
  glBindSampler(compositeUnit, tiles.composites().composer().sampler());
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

void ChunkRenderer::drawChunk(const SelectedChunk& chunk, const Job& job, GlobeTiles& tiles) {
  const ChunkSurface* surface = tiles.surfaces().find(chunk.index);
  const std::optional<std::uint32_t> slot = tiles.surfaces().slot(chunk.index);
  if (surface == nullptr || !slot) {
    return;
  }
  ChunkBlock block;
  for (std::size_t i = 0; i < block.corners.size(); ++i) {
    block.corners[i] = glm::vec4(glm::vec3(surface->corners()[i] - job.view->cameraPosition), 1.0F);
  }
  const std::array<bool, compositeKindCount> used{true, drawnKey_.night, drawnKey_.overlay};
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
  block.level = static_cast<float>(chunk.index.level);
  uniforms_.writeAndBind(chunkBinding, block);
  if (job.skirts) {
    tiles.surfaces().pool().draw(*slot, chunk.step);
  } else {
    tiles.surfaces().pool().drawGrid(*slot, chunk.step);
  }
}

}  // namespace meridian::globebrowsing
