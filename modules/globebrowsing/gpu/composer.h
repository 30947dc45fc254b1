#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "globebrowsing/gpu/composite_kind.h"
#include "globebrowsing/gpu/composition_programs.h"
#include "globebrowsing/gpu/relief_textures.h"
#include "globebrowsing/gpu/slot_pool.h"
#include "globebrowsing/gpu/uniform_ring.h"
#include "globebrowsing/layers/layer.h"
#include "globebrowsing/providers/raw_tile.h"
#include "globebrowsing/streaming/tile_key.h"
#include "globebrowsing/tiling/tiling.h"
#include "host/graphics/graphics.h"

namespace meridian::globebrowsing {

/// One enabled layer's part in a composite.
struct CompositionPart {
  const Layer* layer = nullptr;
  const ColourTile* tile = nullptr;    ///< null: the layer has nothing there, or needs no tile
  TileKey key;                         ///< of that tile
  UnitSquareTransform transform;       ///< the composite's unit square in that tile's
  const ReliefTile* relief = nullptr;  ///< of layers that colour heights
  double pixelMetres = 0.0;            ///< of the composite; for those
  float opacity = 1.0F;                ///< as which the layer is composed
};

/// Draws composites: the layers of one kind, lowest first and those of each group together, blended once per tile
/// instead of once per fragment (after Kooima; Bladin & Broberg 2016 compose per fragment). A composite is one layer of
/// an array texture, with three half-size levels. Which slot is whose, CompositeStore, its owner, knows. Render thread
/// only.
class Composer {
 public:
  struct Capacity {
    std::uint32_t composites = 0;
    std::uint32_t rawTiles = 0;
    std::uint32_t reliefTiles = 4;  ///< with memory of their own from when the first is needed
  };
  [[nodiscard]] static std::size_t bytesPerComposite();
  [[nodiscard]] static std::size_t bytesPerRawTile();

  /// Errors: shader templates missing or wrong.
  [[nodiscard]] static Result<std::unique_ptr<Composer>> create(graphics::Graphics& graphics, const Capacity& capacity);

  /// How composites are sampled when chunks are drawn.
  struct Sampling {
    enum class Kind : std::uint8_t { OneLevel, Polar, Plain };  ///< in the order of drawing: what is near first
    Kind kind = Kind::Plain;
    std::uint8_t level = 0;  ///< of OneLevel: 0 (full size) to levelCount - 1
    auto operator<=>(const Sampling&) const = default;
  };
  struct Samplers {
    graphics::Sampler plain;
    /// For tiles whose pixels are all well served by the same half-size level: on a software renderer a third cheaper
    /// than choosing two for each pixel and blending them.
    graphics::Sampler oneLevel;
    /// For tiles that taper to a pole. There a pixel spans many texels along u that are all but one point; going by
    /// those would blur along v as well, so at most the second half-size level is used.
    graphics::Sampler polar;
    [[nodiscard]] const graphics::Sampler& of(Sampling::Kind kind) const;
  };
  [[nodiscard]] static Samplers makeSamplers();

  /// The array texture of composites, all levels.
  [[nodiscard]] GLuint composites() const { return composites_.id(); }
  /// Binds the array texture of composites, or one level of it, with its sampler.
  void bindComposites(GLuint unit, Sampling sampling) const;

  [[nodiscard]] CompositionPrograms& programs() { return programs_; }
  [[nodiscard]] const CompositionPrograms& programs() const { return programs_; }

  void beginFrame(std::uint64_t frame);
  void endFrame();
  /// Whether the programs that composing them takes are ready.
  [[nodiscard]] bool canCompose(CompositeKind kind, std::span<const CompositionPart> parts) const;
  /// Composes into that array layer what can be composed. False when the raw tiles of this frame fill their pool: try
  /// in the next frame.
  bool compose(std::uint32_t slot, CompositeKind kind, std::span<const CompositionPart> parts);

  /// Bytes of the raw tiles and relief tiles that are there.
  [[nodiscard]] std::size_t rawTileBytes() const {
    return rawSlots_.used() * bytesPerRawTile() + relief_.residentBytes();
  }
  /// No composite can have more layers with tiles.
  [[nodiscard]] std::uint32_t rawTileCapacity() const { return rawSlots_.capacity(); }

  /// What composing them takes: a fetch per texel and layer, counted twice where tiles are scaled or settings change
  /// them, none where the topmost hides all others, and once more for the half-size levels, at the rates of a software
  /// renderer (300 million a second, measured) or of a modest graphics card.
  [[nodiscard]] double estimatedMilliseconds(std::span<const CompositionPart> parts) const;

  static constexpr int levelCount = 4;

 private:
  Composer(graphics::Graphics& graphics, const Capacity& capacity);
  /// Where the shader finds what a part is made from.
  struct Source {
    float slot = -1.0F;  ///< of the raw or relief tile; below 0: there is nothing
    int ramp = 0;
    int stops = 0;
  };
  /// Nothing when a pool is full.
  std::optional<Source> sourceOf(const CompositionPart& part);
  std::optional<Source> reliefSourceOf(const CompositionPart& part);
  void bindBlocks(CompositeKind kind, std::span<const CompositionPart> parts);
  void drawHalfSizes(std::uint32_t slot);

  bool isSoftware_;
  CompositionPrograms programs_;
  graphics::Texture composites_;
  std::array<graphics::Texture, levelCount> levelViews_;  ///< of composites_, each of one level alone
  graphics::Texture rawTiles_;
  Samplers samplers_;
  graphics::Sampler rawSampler_;
  SlotPool<TileKey> rawSlots_;
  ReliefTextures relief_;
  graphics::Framebuffer framebuffer_;
  graphics::VertexArray emptyVertexArray_;
  UniformRing uniforms_;
  std::vector<Source> sourcesOfParts_;
  std::uint64_t frame_ = 0;
};

}  // namespace meridian::globebrowsing
