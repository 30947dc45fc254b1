#include "globebrowsing/surface/chunk_programs.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "globebrowsing/gpu/chunk_blocks.h"
#include "globebrowsing/gpu/composer.h"
#include "globebrowsing/gpu/surface_pool.h"

namespace meridian::globebrowsing {

namespace {

std::string defines(const ChunkProgramKey& key) {
  return fmt::format(
      "#define SHADING {}\n#define ACCURATE_NORMALS {}\n#define NIGHT {}\n#define OVERLAY {}\n#define WATER {}\n"
      "#define EDGES {}\n#define FADE {}\n#define FADE_BASE 1\n#define FADE_NIGHT 2\n#define FADE_OVERLAY 3\n",
      int{key.shading}, int{key.accurateNormals}, int{key.night}, int{key.overlay}, int{key.water}, int{key.edges},
      key.fade ? static_cast<int>(*key.fade) + 1 : 0);
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
  glBindTextureUnit(chunk_bindings::normalUnit, normals.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, chunk_bindings::viewBlock, viewBlock.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, chunk_bindings::chunkBlock, chunkBlock.id());
  glUseProgram(program);
  glBindVertexArray(vertexArray.id());
  // The driver tells a view of the first level from one of another, and from all.
  const auto levelView = [&](int level) {
    return graphics::Texture::view(composites, GL_TEXTURE_2D_ARRAY, GL_RGBA8, level, 1);
  };
  const graphics::Texture first = levelView(0);
  const graphics::Texture second = levelView(1);
  const std::array<std::pair<const graphics::Sampler*, const graphics::Texture*>, 4> samplings{
      {{&samplers.plain, &composites},
       {&samplers.polar, &composites},
       {&samplers.oneLevel, &first},
       {&samplers.oneLevel, &second}}};
  for (const auto& [sampler, texture] : samplings) {
    glBindSampler(chunk_bindings::compositeUnit, sampler->id());
    glBindTextureUnit(chunk_bindings::compositeUnit, texture->id());
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
  constexpr std::array<std::string_view, compositeKindCount> fades{" fading base", " fading night", " fading overlay"};
  return fmt::format("chunks{}{}{}{}{}{}{}{}", shading ? " shading" : "", accurateNormals ? " normals" : "",
                     night ? " night" : "", overlay ? " overlay" : "", water ? " water" : "", edges ? " edges" : "",
                     fade ? fades[static_cast<std::size_t>(*fade)] : "", blended ? " blended" : "");
}

bool ChunkPrograms::isReady(const Set& set) const {
  return std::all_of(set.programs.begin(), set.programs.end(), [this](const graphics::ProgramHandle& program) {
    return graphics_.programs().ready(program) != 0;
  });
}

Result<graphics::ProgramHandle> ChunkPrograms::request(ChunkProgramKey key, const ChunkProgramUse& use,
                                                       Urgency urgency) {
  key.night = key.night && use.night;
  if (!use.fades || (key.fade == CompositeKind::Night && !key.night)) {
    key.fade.reset();
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
  const auto warm = [blended = key.blended](GLuint program) { warmChunks(program, blended); };
  return graphics_.programs().request({key.text(), *std::move(vertex), *std::move(fragment), warm}, urgency);
}

Result<ChunkPrograms::Set> ChunkPrograms::requestAll(const ChunkProgramKey& key, Urgency urgency) {
  Set set{key, {}};
  for (const bool fades : {false, true}) {
    for (const bool night : {true, false}) {
      const ChunkProgramUse use{night, fades};
      Result<graphics::ProgramHandle> program = request(key, use, urgency);
      if (!program) {
        return tl::make_unexpected(program.error());
      }
      set.programs[place(use)] = *std::move(program);
    }
  }
  return set;
}

Result<void> ChunkPrograms::set(const ChunkProgramKey& key) {
  if (!wanted_.programs.front() || !(key == wanted_.key)) {
    Result<Set> set = requestAll(key, Urgency::Now);
    if (!set) {
      return tl::make_unexpected(set.error());
    }
    wanted_ = *std::move(set);
  }
  drawsWanted_ = isReady(wanted_);
  if (drawsWanted_) {
    drawn_ = wanted_;
  }
  return {};
}

void ChunkPrograms::prepareFades() {
  const ChunkProgramKey plain = unfaded(drawn_.key);
  preparedKey_ = plain;
  prepared_.clear();
  for (const CompositeKind kind : allCompositeKinds) {
    const bool isInUse = kind == CompositeKind::Base || (kind == CompositeKind::Night ? plain.night : plain.overlay);
    ChunkProgramKey key = plain;
    key.fade = kind;
    if (isInUse) {
      // The same templates made the programs that draw, so there is no error.
      prepared_.push_back(requestAll(key, Urgency::Later).value_or(Set{}));
    }
  }
}

std::string ChunkPrograms::error() const {
  for (const graphics::ProgramHandle& program : wanted_.programs) {
    if (const Result<GLuint> built = graphics_.programs().get(program); !built) {
      return built.error().message();
    }
  }
  return {};
}

}  // namespace meridian::globebrowsing
