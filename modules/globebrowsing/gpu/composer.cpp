#include "globebrowsing/gpu/composer.h"

#include <algorithm>
#include <cstring>

#include <glm/vec4.hpp>

#include "globebrowsing/layers/layer_fields.h"
#include "globebrowsing/source/tile_layout.h"

namespace meridian::globebrowsing {

namespace {

using namespace composition_bindings;

constexpr int side = colourLayout.size();

/// OpenSpace starts the base from the same grey; night and overlays start from nothing.
glm::vec4 background(CompositeKind kind) {
  return kind == CompositeKind::Base ? glm::vec4(0.3F, 0.3F, 0.3F, 1.0F) : glm::vec4(0.0F);
}

/// Pixel of the composite -> texture coordinate of the raw tile, borders of both included.
glm::vec4 pixelTransform(const UnitSquareTransform& transform) {
  const double interior = colourLayout.interior;
  const double border = colourLayout.border;
  const glm::dvec2 offset = (border + interior * transform.offset - border * transform.scale) / double{side};
  const glm::dvec2 scale = transform.scale / double{side};
  return glm::vec4(glm::vec2(offset), glm::vec2(scale));
}

/// Where a layer's opacity lies among its fields.
std::size_t opacityOffset() {
  const auto& fields = layerFields().fields();
  return std::find_if(fields.begin(), fields.end(), [](const LayerField& field) { return field.name == "opacity"; })
      ->offset;
}

/// How many of the parts are no water masks; those come last.
int waterFrom(std::span<const CompositionPart> parts) {
  const auto first = std::find_if(parts.begin(), parts.end(), [](const CompositionPart& part) {
    return part.layer->group() == LayerGroupId::WaterMasks;
  });
  return static_cast<int>(first - parts.begin());
}

/// Puts the frame's framebuffer, viewport and depth test back.
class TargetRestorer {
 public:
  TargetRestorer() {
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer_);
    glGetIntegerv(GL_VIEWPORT, viewport_.data());
    glDisable(GL_DEPTH_TEST);
  }
  TargetRestorer(const TargetRestorer&) = delete;
  TargetRestorer& operator=(const TargetRestorer&) = delete;
  ~TargetRestorer() {
    glEnable(GL_DEPTH_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(framebuffer_));
    glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
    for (GLuint unit = 0; unit < 4; ++unit) {
      glBindSampler(unit, 0);
    }
    glBindVertexArray(0);
    glUseProgram(0);
  }

 private:
  GLint framebuffer_ = 0;
  std::array<GLint, 4> viewport_{};
};

/// Whether the topmost layer hides all others: then the composite is its tile, and nothing needs blending.
bool isHidingAll(std::span<const CompositionPart> parts) {
  if (parts.empty() || parts.back().tile == nullptr) {
    return false;
  }
  const CompositionPart& top = parts.back();
  return top.tile->isOpaque() && top.transform == UnitSquareTransform{} && top.opacity == 1.0F &&
         top.layer->group() != LayerGroupId::WaterMasks && top.layer->showsTilesUnchanged();
}

/// Whether each is what its tile shows there, texel for texel, if mixed with what is below.
bool areUnchanged(std::span<const CompositionPart> parts) {
  return std::all_of(parts.begin(), parts.end(), [](const CompositionPart& part) {
    return part.layer->settings().isIdentity() && (part.tile == nullptr || part.transform == UnitSquareTransform{});
  });
}

void upload(const graphics::Texture& array, std::uint32_t slot, const ColourTile& tile) {
  glTextureSubImage3D(array.id(), 0, 0, 0, static_cast<GLint>(slot), side, side, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                      tile.pixels().rgba.data());
}

}  // namespace

Composer::Samplers Composer::makeSamplers() {
  Samplers made{graphics::Sampler::create(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR),
                graphics::Sampler::create(GL_LINEAR, GL_LINEAR),
                graphics::Sampler::create(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR)};
  glSamplerParameterf(made.polar.id(), GL_TEXTURE_MAX_LOD, 2.0F);
  return made;
}

const graphics::Sampler& Composer::Samplers::of(Sampling::Kind kind) const {
  switch (kind) {
    case Sampling::Kind::OneLevel:
      return oneLevel;
    case Sampling::Kind::Polar:
      return polar;
    case Sampling::Kind::Plain:
      break;
  }
  return plain;
}

void Composer::bindComposites(GLuint unit, Sampling sampling) const {
  const bool all = sampling.kind != Sampling::Kind::OneLevel;
  glBindTextureUnit(unit, all ? composites_.id() : levelViews_[sampling.level].id());
  glBindSampler(unit, samplers_.of(sampling.kind).id());
}

std::size_t Composer::bytesPerRawTile() {
  return std::size_t{4} * side * side;
}

std::size_t Composer::bytesPerComposite() {
  std::size_t bytes = 0;
  for (int level = 0; level < levelCount; ++level) {
    bytes += bytesPerRawTile() >> (2 * level);
  }
  return bytes;
}

double Composer::estimatedMilliseconds(std::span<const CompositionPart> parts) const {
  const double texelsPerMillisecond = isSoftware_ ? 3e5 : 1e7;
  const std::size_t perPart = isHidingAll(parts) ? 0 : areUnchanged(parts) ? 1 : 2;
  const std::size_t fetches = perPart * parts.size() + 1;
  return static_cast<double>(fetches) * side * side / texelsPerMillisecond;
}

Result<std::unique_ptr<Composer>> Composer::create(graphics::Graphics& graphics, const Capacity& capacity) {
  std::unique_ptr<Composer> composer(new Composer(graphics, capacity));
  return composer->programs_.request().map([&] { return std::move(composer); });
}

Composer::Composer(graphics::Graphics& graphics, const Capacity& capacity)
    : isSoftware_(graphics.limits().software),
      programs_(graphics),
      composites_(
          graphics::Texture::array2D(colourFormat, side, side, static_cast<int>(capacity.composites), levelCount)),
      rawTiles_(graphics::Texture::array2D(colourFormat, side, side, static_cast<int>(capacity.rawTiles))),
      samplers_(makeSamplers()),
      rawSampler_(graphics::Sampler::create(GL_LINEAR, GL_LINEAR)),
      rawSlots_(capacity.rawTiles),
      relief_(capacity.reliefTiles),
      framebuffer_(graphics::Framebuffer::create()),
      emptyVertexArray_(graphics::VertexArray::create()),
      uniforms_(std::size_t{64} << 10, static_cast<std::size_t>(graphics.limits().uniformBlockAlignment)) {
  for (int level = 0; level < levelCount; ++level) {
    levelViews_[static_cast<std::size_t>(level)] =
        graphics::Texture::view(composites_, GL_TEXTURE_2D_ARRAY, colourFormat, level, 1);
  }
}

void Composer::beginFrame(std::uint64_t frame) {
  frame_ = frame;
  uniforms_.beginFrame();
}

void Composer::endFrame() {
  uniforms_.endFrame();
}

std::optional<Composer::Source> Composer::reliefSourceOf(const CompositionPart& part) {
  const ReliefStyle& style = *part.layer->relief();
  const bool needsRamp = style.kind == ReliefKind::ColorRelief || style.kind == ReliefKind::Slope;
  Source source;
  if (part.relief == nullptr || (needsRamp && style.ramp == nullptr)) {
    return source;
  }
  if (needsRamp) {
    const std::optional<std::uint32_t> row = relief_.ramp(style.ramp, frame_);
    if (!row) {
      relief_.tellFull(*part.layer);
      return source;  // more ramps at a time than fit will not be fewer in the next frame
    }
    source.ramp = static_cast<int>(*row);
    source.stops = static_cast<int>(style.ramp->stops.size());
  }
  const std::optional<std::uint32_t> slot = relief_.tile(*part.relief, frame_);
  if (!slot) {
    return std::nullopt;
  }
  source.slot = static_cast<float>(*slot);
  return source;
}

std::optional<Composer::Source> Composer::sourceOf(const CompositionPart& part) {
  if (isRelief(part.layer->sampling())) {
    return reliefSourceOf(part);
  }
  if (part.tile == nullptr || !part.tile->pixels().anyOpaque) {
    return Source{};
  }
  std::optional<std::uint32_t> slot = rawSlots_.use(part.key, frame_);
  if (!slot) {
    slot = rawSlots_.take(part.key, frame_, [](const TileKey&) {});
    if (!slot) {
      return std::nullopt;
    }
    upload(rawTiles_, *slot, *part.tile);
  }
  return Source{static_cast<float>(*slot)};
}

void Composer::bindBlocks(CompositeKind kind, std::span<const CompositionPart> parts) {
  const std::size_t count =
      programs_.isOwnReady(kind) ? std::max<std::size_t>(parts.size(), 1) : CompositionPrograms::loopLayers;
  const std::size_t stride = layerFields().stride();
  const std::size_t placementBytes = sizeof(PlacementHead) + count * sizeof(Placement);
  uniforms_.reserve(uniforms_.aligned(count * stride) + uniforms_.aligned(placementBytes));
  const UniformRing::Block settings = uniforms_.take(count * stride);
  const UniformRing::Block placements = uniforms_.take(placementBytes);
  const PlacementHead head{background(kind), static_cast<int>(parts.size()), waterFrom(parts), {}};
  std::memcpy(placements.bytes, &head, sizeof(head));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    layerFields().write(*parts[i].layer, {settings.bytes + i * stride, stride});
    std::memcpy(settings.bytes + i * stride + opacityOffset(), &parts[i].opacity, sizeof(float));
    const Source& source = sourcesOfParts_[i];
    const Placement placement{pixelTransform(parts[i].transform), source.slot, static_cast<float>(parts[i].pixelMetres),
                              source.ramp, source.stops};
    std::memcpy(placements.bytes + sizeof(head) + i * sizeof(placement), &placement, sizeof(placement));
  }
  uniforms_.bind(layerBlock, settings);
  uniforms_.bind(placementBlock, placements);
}

bool Composer::canCompose(CompositeKind kind, std::span<const CompositionPart> parts) const {
  return isHidingAll(parts) ? programs_.halfSize() != 0 : programs_.program(kind) != 0;
}

bool Composer::compose(std::uint32_t slot, CompositeKind kind, std::span<const CompositionPart> parts) {
  if (isHidingAll(parts)) {
    upload(composites_, slot, *parts.back().tile);
    const TargetRestorer restorer;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glBindVertexArray(emptyVertexArray_.id());
    drawHalfSizes(slot);
    return true;
  }
  sourcesOfParts_.clear();
  for (const CompositionPart& part : parts) {
    const std::optional<Source> source = sourceOf(part);
    if (!source) {
      return false;
    }
    sourcesOfParts_.push_back(*source);
  }
  const TargetRestorer restorer;
  bindBlocks(kind, parts);
  framebuffer_.attachLayer(GL_COLOR_ATTACHMENT0, composites_, static_cast<int>(slot));
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
  glViewport(0, 0, side, side);
  glUseProgram(programs_.program(kind, areUnchanged(parts)));
  glBindTextureUnit(0, rawTiles_.id());
  glBindSampler(0, rawSampler_.id());
  relief_.bind();
  glBindVertexArray(emptyVertexArray_.id());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  drawHalfSizes(slot);
  return true;
}

void Composer::drawHalfSizes(std::uint32_t slot) {
  const GLuint program = programs_.halfSize();
  glUseProgram(program);
  glBindSampler(0, 0);
  glProgramUniform1i(program, 0, static_cast<GLint>(slot));
  for (int level = 1; level < levelCount; ++level) {
    framebuffer_.attachLayer(GL_COLOR_ATTACHMENT0, composites_, static_cast<int>(slot), level);
    glViewport(0, 0, side >> level, side >> level);
    glBindTextureUnit(0, levelViews_[static_cast<std::size_t>(level - 1)].id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
}

}  // namespace meridian::globebrowsing
