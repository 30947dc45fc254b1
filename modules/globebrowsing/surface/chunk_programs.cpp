#include "globebrowsing/surface/chunk_programs.h"

#include <array>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "globebrowsing/gpu/chunk_blocks.h"
#include "globebrowsing/gpu/composer.h"
#include "globebrowsing/gpu/surface_pool.h"

namespace meridian::globebrowsing {

namespace {

std::string defines(const ChunkProgramKey& key) {
  return fmt::format(
      "#define SHADING {}\n#define ACCURATE_NORMALS {}\n#define NIGHT {}\n#define OVERLAY {}\n#define EDGES {}\n",
      int{key.shading}, int{key.accurateNormals}, int{key.night}, int{key.overlay}, int{key.edges});
}

/// Draws a triangle as chunks are drawn, with each sampler, and textures, vertices and a target of its own.
void warmChunks(GLuint program, bool blended) {
  constexpr int size = 24;
  const graphics::Texture composites = graphics::Texture::array2D(GL_RGBA8, size, size, 2, Composer::levelCount);
  const graphics::Texture normals = graphics::Texture::array2D(SurfacePool::normalFormat, size, size, 2);
  const Composer::Samplers samplers = Composer::makeSamplers();
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
    chunk_bindings::enableBlending();
  }
  glBindTextureUnit(chunk_bindings::compositeUnit, composites.id());
  glBindTextureUnit(chunk_bindings::normalUnit, normals.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, chunk_bindings::viewBlock, viewBlock.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, chunk_bindings::chunkBlock, chunkBlock.id());
  glUseProgram(program);
  glBindVertexArray(vertexArray.id());
  for (const graphics::Sampler* sampler : {&samplers.plain, &samplers.magnified, &samplers.polar}) {
    glBindSampler(chunk_bindings::compositeUnit, sampler->id());
    SurfacePool::Draws draws;
    draws.counts = {3, 3};
    draws.firstElements = {nullptr, nullptr};
    draws.firstVertices = {0, 0};
    SurfacePool::draw(draws);
  }
}

}  // namespace

void chunk_bindings::enableBlending() {
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

std::string ChunkProgramKey::text() const {
  return fmt::format("chunks{}{}{}{}{}{}", shading ? " shading" : "", accurateNormals ? " normals" : "",
                     night ? " night" : "", overlay ? " overlay" : "", edges ? " edges" : "",
                     blended ? " blended" : "");
}

bool ChunkPrograms::isReady(const Pair& pair) const {
  return graphics_.programs().ready(pair.full) != 0 && graphics_.programs().ready(pair.daylight) != 0;
}

Result<graphics::ProgramHandle> ChunkPrograms::request(const ChunkProgramKey& key) {
  const graphics::Substitutions substitutions{{"defines", defines(key)}};
  Result<graphics::ShaderSource> vertex = graphics_.templates().load("surface/chunk.vert", substitutions);
  if (!vertex) {
    return tl::make_unexpected(vertex.error());
  }
  Result<graphics::ShaderSource> fragment = graphics_.templates().load("surface/chunk.frag", substitutions);
  if (!fragment) {
    return tl::make_unexpected(fragment.error());
  }
  const auto warm = [blended = key.blended](GLuint program) { warmChunks(program, blended); };
  return graphics_.programs().request({key.text(), *std::move(vertex), *std::move(fragment), warm});
}

Result<void> ChunkPrograms::set(const ChunkProgramKey& key) {
  if (!wanted_.full || !(key == wanted_.key)) {
    ChunkProgramKey lit = key;
    lit.night = false;
    Result<graphics::ProgramHandle> full = request(key);
    Result<graphics::ProgramHandle> daylight = key.night ? request(lit) : full;
    if (!full || !daylight) {
      return tl::make_unexpected(full ? daylight.error() : full.error());
    }
    wanted_ = {key, *std::move(full), *std::move(daylight)};
  }
  if (ready()) {
    drawn_ = wanted_;
  }
  return {};
}

std::string ChunkPrograms::error() const {
  for (const graphics::ProgramHandle* handle : {&wanted_.full, &wanted_.daylight}) {
    if (const Result<GLuint> built = graphics_.programs().get(*handle); !built) {
      return built.error().message();
    }
  }
  return {};
}

}  // namespace meridian::globebrowsing
