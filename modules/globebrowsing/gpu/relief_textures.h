#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "globebrowsing/gpu/slot_pool.h"
#include "globebrowsing/layers/relief_tile.h"
#include "globebrowsing/providers/colour_ramp.h"
#include "host/api/property_owner.h"
#include "host/graphics/gl_objects.h"

namespace meridian::globebrowsing {

/// What layers that colour heights are composed from: relief tiles and colour ramps, as shaders/gpu/compose.frag reads
/// them. Relief tiles take memory from when the first is asked for. Render thread only.
class ReliefTextures {
 public:
  explicit ReliefTextures(std::uint32_t capacity);
  [[nodiscard]] static std::size_t bytesPerTile();

  /// The tile's array layer in both textures, uploaded if need be. Nothing when those of this frame fill them.
  [[nodiscard]] std::optional<std::uint32_t> tile(const ReliefTile& tile, std::uint64_t frame);
  /// The ramp's row; likewise.
  [[nodiscard]] std::optional<std::uint32_t> ramp(const std::shared_ptr<const ColourRamp>& ramp, std::uint64_t frame);

  /// Says, once, that this layer's ramp finds no row, and what to do.
  void tellFull(const PropertyOwner& layer);

  /// To units 1 to 3, with samplers.
  void bind() const;
  [[nodiscard]] std::size_t residentBytes() const { return tiles_.used() * bytesPerTile(); }

  /// Textures of the same formats that are of no use but to be bound: by warm-up, and by this until there are others.
  struct Set {
    graphics::Texture heights;  ///< metres
    graphics::Texture normals;  ///< ReliefTile::Normal
    graphics::Texture ramps;    ///< a row each: a stop's colour, its value, the next stop's colour, ...
    void bind(const graphics::Sampler& sampler) const;
  };
  [[nodiscard]] static Set standIn();

 private:
  Set textures_;
  graphics::Sampler sampler_;
  bool hasTiles_ = false;
  bool hasToldFull_ = false;
  SlotPool<std::uint64_t> tiles_;  ///< by ReliefTile::id()
  SlotPool<const ColourRamp*> rampRows_;
  std::vector<std::shared_ptr<const ColourRamp>> ramps_;  ///< by row: no other can have its address meanwhile
};

}  // namespace meridian::globebrowsing
