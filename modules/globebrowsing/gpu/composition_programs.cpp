#include "globebrowsing/gpu/composition_programs.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "globebrowsing/gpu/relief_textures.h"
#include "globebrowsing/layers/layer_fields.h"
#include "globebrowsing/layers/layer_glsl.h"

namespace meridian::globebrowsing {

namespace {

using namespace composition_bindings;

std::string unrolled(const StructureKey& key) {
  std::string body;
  for (std::size_t i = 0; i < key.layers().size(); ++i) {
    const LayerStructure& layer = key.layers()[i];
    body += fmt::format("    {0} = composePart({0}, {1}, sampling{2}, blendMode{3}, adjustment{4});\n",
                        layer.group == LayerGroupId::WaterMasks ? "water" : "result", i, name(layer.sampling),
                        name(layer.blendMode), name(layer.adjustment));
  }
  return body;
}

constexpr std::string_view loopBody =
    "    for (int i = 0; i < part.count; ++i) {\n"
    "        vec4 below = i < part.waterFrom ? result : water;\n"
    "        below = composePart(below, i, layers[i].sampling, layers[i].blendMode, layers[i].adjustment);\n"
    "        result = i < part.waterFrom ? below : result;\n"
    "        water = i < part.waterFrom ? water : below;\n"
    "    }\n";

/// Draws once as Composer does, into textures of its own that are not powers of two either.
void warmComposition(GLuint program, std::size_t layers) {
  constexpr int size = 24;
  const graphics::Texture raw = graphics::Texture::array2D(colourFormat, size, size, 2);
  const graphics::Texture target = graphics::Texture::array2D(colourFormat, size, size, 2, 2);
  const graphics::Sampler sampler = graphics::Sampler::create(GL_LINEAR, GL_LINEAR);
  const ReliefTextures::Set relief = ReliefTextures::standIn();
  const graphics::Framebuffer framebuffer = graphics::Framebuffer::create();
  framebuffer.attachLayer(GL_COLOR_ATTACHMENT0, target, 0);
  const std::vector<std::byte> zeros(sizeof(PlacementHead) + layers * (sizeof(Placement) + layerFields().stride()));
  const graphics::Buffer blocks(static_cast<GLsizeiptr>(zeros.size()), zeros.data(), 0);
  const graphics::VertexArray vertexArray = graphics::VertexArray::create();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glViewport(0, 0, size, size);
  glDisable(GL_DEPTH_TEST);
  glBindTextureUnit(0, raw.id());
  glBindSampler(0, sampler.id());
  relief.bind(sampler);
  glBindBufferBase(GL_UNIFORM_BUFFER, layerBlock, blocks.id());
  glBindBufferBase(GL_UNIFORM_BUFFER, placementBlock, blocks.id());
  glUseProgram(program);
  glBindVertexArray(vertexArray.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void warmHalfSize(GLuint program) {
  constexpr int size = 24;
  const graphics::Texture target = graphics::Texture::array2D(colourFormat, size, size, 2, 2);
  const graphics::Texture view = graphics::Texture::view(target, GL_TEXTURE_2D_ARRAY, colourFormat, 0, 1);
  const graphics::Framebuffer framebuffer = graphics::Framebuffer::create();
  framebuffer.attachLayer(GL_COLOR_ATTACHMENT0, target, 0, 1);
  const graphics::VertexArray vertexArray = graphics::VertexArray::create();
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
  glViewport(0, 0, size / 2, size / 2);
  glDisable(GL_DEPTH_TEST);
  glBindTextureUnit(0, view.id());
  glUseProgram(program);
  glBindVertexArray(vertexArray.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace

CompositionPrograms::CompositionPrograms(graphics::Graphics& graphics)
    : graphics_(graphics), loops_(!graphics.limits().software) {}

Result<void> CompositionPrograms::request() {
  Result<graphics::ProgramDescription> loop = describe("compose/loop", loopLayers, std::string(loopBody), Parts::Any);
  Result<graphics::ShaderSource> vertex = graphics_.templates().load("gpu/fill.vert");
  Result<graphics::ShaderSource> fragment = graphics_.templates().load("gpu/half_size.frag");
  for (const Error* error :
       {loop ? nullptr : &loop.error(), vertex ? nullptr : &vertex.error(), fragment ? nullptr : &fragment.error()}) {
    if (error != nullptr) {
      return tl::make_unexpected(*error);
    }
  }
  halfSize_ = graphics_.programs().request({"compose/half size", *vertex, *fragment, warmHalfSize});
  loopDescription_ = *std::move(loop);
  setLooping(loops_);
  return {};
}

void CompositionPrograms::setLooping(bool loops) {
  loops_ = loops;
  if (loops && !loop_) {
    loop_ = graphics_.programs().request(loopDescription_);
  }
}

Result<graphics::ProgramDescription> CompositionPrograms::describe(std::string key, std::size_t layers,
                                                                   std::string body, Parts parts) const {
  const int count = std::max(1, static_cast<int>(layers));
  const graphics::Substitutions substitutions{
      {"structs", glslStruct(layerFields(), "Layer")},
      {"constants", glslLayerConstants()},
      {"layers", glslLayerBlock({"Layer", "LayerBlock", "layers", layerBlock, count})},
      {"count", fmt::format("{}", count)},
      {"unchanged", parts == Parts::Unchanged ? "true" : "false"},
      {"body", std::move(body)}};
  Result<graphics::ShaderSource> vertex = graphics_.templates().load("gpu/fill.vert");
  if (!vertex) {
    return tl::make_unexpected(vertex.error());
  }
  return graphics_.templates().load("gpu/compose.frag", substitutions).map([&](graphics::ShaderSource fragment) {
    const auto warm = [count](GLuint program) { warmComposition(program, static_cast<std::size_t>(count)); };
    return graphics::ProgramDescription{std::move(key), std::move(*vertex), std::move(fragment), warm};
  });
}

graphics::ProgramHandle CompositionPrograms::request(const StructureKey& key, Parts parts) {
  using Urgency = graphics::ProgramCache::Urgency;
  const bool isFaster = parts == Parts::Unchanged;
  // The templates were read once without error, and a structure adds nothing that can be missing.
  Result<graphics::ProgramDescription> description =
      describe((isFaster ? "compose unchanged/" : "compose/") + key.text(), key.layers().size(), unrolled(key), parts);
  return description ? graphics_.programs().request(*std::move(description), isFaster ? Urgency::Later : Urgency::Now)
                     : graphics::ProgramHandle();
}

void CompositionPrograms::setStructure(CompositeKind kind, const StructureKey& key) {
  Kind& own = kinds_[static_cast<std::size_t>(kind)];
  if (!own.requested || own.key != key) {
    own = {key, request(key, Parts::Any), request(key, Parts::Unchanged), true};
  }
}

GLuint CompositionPrograms::program(CompositeKind kind, bool areUnchanged) const {
  const Kind& own = kinds_[static_cast<std::size_t>(kind)];
  if (halfSize() == 0) {
    return 0;
  }
  if (const GLuint exact = graphics_.programs().ready(own.program)) {
    const GLuint faster = areUnchanged ? graphics_.programs().ready(own.unchanged) : 0;
    return faster != 0 ? faster : exact;
  }
  return mayLoop(own) ? graphics_.programs().ready(loop_) : 0;
}

bool CompositionPrograms::isOwnReady(CompositeKind kind) const {
  const Kind& own = kinds_[static_cast<std::size_t>(kind)];
  return halfSize() != 0 && graphics_.programs().ready(own.program) != 0;
}

bool CompositionPrograms::isOwnPending(CompositeKind kind) const {
  const Kind& own = kinds_[static_cast<std::size_t>(kind)];
  return !isOwnReady(kind) && !graphics_.programs().hasFailed(own.program);
}

bool CompositionPrograms::hasFailed(CompositeKind kind) const {
  const graphics::ProgramCache& cache = graphics_.programs();
  const Kind& own = kinds_[static_cast<std::size_t>(kind)];
  return cache.hasFailed(halfSize_) || (cache.hasFailed(own.program) && (!mayLoop(own) || cache.hasFailed(loop_)));
}

std::string CompositionPrograms::error(CompositeKind kind) const {
  if (!hasFailed(kind)) {
    return {};
  }
  const graphics::ProgramCache& cache = graphics_.programs();
  const Kind& own = kinds_[static_cast<std::size_t>(kind)];
  return cache.get(cache.hasFailed(halfSize_) ? halfSize_ : own.program).error().message();
}

}  // namespace meridian::globebrowsing
