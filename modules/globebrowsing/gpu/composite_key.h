#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "globebrowsing/gpu/composite_kind.h"
#include "globebrowsing/tiling/tile_index.h"

namespace meridian::globebrowsing {

/// Names a composite.
struct CompositeKey {
  CompositeKind kind = CompositeKind::Base;
  TileIndex index;
  std::uint8_t side = 0;  ///< 0 or 1: composites of two times lie side by side; fadeSide: the other end of a fade
  static constexpr std::uint8_t fadeSide = 2;
  bool operator==(const CompositeKey&) const = default;
};

}  // namespace meridian::globebrowsing

template <>
struct std::hash<meridian::globebrowsing::CompositeKey> {
  std::size_t operator()(const meridian::globebrowsing::CompositeKey& key) const noexcept {
    return std::hash<meridian::globebrowsing::TileIndex>()(key.index) * 9 + 3 * static_cast<std::size_t>(key.kind) +
           key.side;
  }
};
