#include "globebrowsing/gpu/relief_textures.h"

#include <array>
#include <utility>

#include <glm/vec4.hpp>

#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

constexpr GLenum heightFormat = GL_R32F;
constexpr GLenum normalFormat = GL_RG16_SNORM;
constexpr GLenum rampFormat = GL_RGBA32F;
constexpr int rampWidth = 2 * static_cast<int>(ColourRamp::mostStops);
/// As many ramps as are in use at a time; no composite has more layers of this kind.
constexpr int rampCount = 64;

}  // namespace

void ReliefTextures::Set::bind(const graphics::Sampler& sampler) const {
  GLuint unit = 1;
  for (const graphics::Texture* texture : {&heights, &normals, &ramps}) {
    glBindTextureUnit(unit, texture->id());
    glBindSampler(unit, sampler.id());
    ++unit;
  }
}

ReliefTextures::Set ReliefTextures::standIn() {
  constexpr int size = 24;  // no power of two: llvmpipe compiles others for those
  return {graphics::Texture::array2D(heightFormat, size, size, 2),
          graphics::Texture::array2D(normalFormat, size, size, 2),
          graphics::Texture::image2D(rampFormat, rampWidth, rampCount)};
}

ReliefTextures::ReliefTextures(std::uint32_t capacity)
    : textures_(standIn()),
      sampler_(graphics::Sampler::create(GL_LINEAR, GL_LINEAR)),
      tiles_(capacity),
      rampRows_(rampCount),
      ramps_(rampCount) {}

std::size_t ReliefTextures::bytesPerTile() {
  return std::size_t{ReliefTile::size} * ReliefTile::size * (sizeof(float) + sizeof(ReliefTile::Normal));
}

std::optional<std::uint32_t> ReliefTextures::tile(const ReliefTile& tile, std::uint64_t frame) {
  constexpr int size = ReliefTile::size;
  std::optional<std::uint32_t> slot = tiles_.use(tile.id(), frame);
  if (slot) {
    return slot;
  }
  slot = tiles_.take(tile.id(), frame, [](std::uint64_t) {});
  if (!slot) {
    return std::nullopt;
  }
  if (!hasTiles_) {
    hasTiles_ = true;
    const int capacity = static_cast<int>(tiles_.capacity());
    textures_.heights = graphics::Texture::array2D(heightFormat, size, size, capacity);
    textures_.normals = graphics::Texture::array2D(normalFormat, size, size, capacity);
  }
  const auto layer = static_cast<GLint>(*slot);
  glTextureSubImage3D(textures_.heights.id(), 0, 0, 0, layer, size, size, 1, GL_RED, GL_FLOAT, tile.heights().data());
  glTextureSubImage3D(textures_.normals.id(), 0, 0, 0, layer, size, size, 1, GL_RG, GL_SHORT, tile.normals().data());
  return slot;
}

std::optional<std::uint32_t> ReliefTextures::ramp(const std::shared_ptr<const ColourRamp>& ramp, std::uint64_t frame) {
  std::optional<std::uint32_t> row = rampRows_.use(ramp.get(), frame);
  if (row) {
    return row;
  }
  row = rampRows_.take(ramp.get(), frame, [](const ColourRamp*) {});
  if (!row) {
    return std::nullopt;
  }
  ramps_[*row] = ramp;
  std::array<glm::vec4, rampWidth> texels{};
  std::size_t at = 0;
  for (const ColourRamp::Stop& stop : ramp->stops) {
    texels[at++] = glm::vec4(stop.colour);
    texels[at++] = glm::vec4(static_cast<float>(stop.value));
  }
  glTextureSubImage2D(textures_.ramps.id(), 0, 0, static_cast<GLint>(*row), static_cast<GLsizei>(at), 1, GL_RGBA,
                      GL_FLOAT, texels.data());
  return row;
}

void ReliefTextures::tellFull(const PropertyOwner& layer) {
  if (!std::exchange(hasToldFull_, true)) {
    log::warning(
        "{} shows nothing: no more than {} layers with colour ramps are composed at a time; disable some of "
        "the types ColorRelief and Slope",
        layer.uri(), rampCount);
  }
}

void ReliefTextures::bind() const {
  textures_.bind(sampler_);
}

}  // namespace meridian::globebrowsing
