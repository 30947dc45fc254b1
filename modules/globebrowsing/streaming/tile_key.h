#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "globebrowsing/tiling/tile_index.h"

namespace meridian::globebrowsing {

/// Names what a job makes: the tile of one stream. A stream is one provider, or one version of a composition; its
/// number comes from TileStreamer::newStream. 0 is no stream.
struct TileKey {
  std::uint32_t stream = 0;
  TileIndex index;

  auto operator<=>(const TileKey&) const = default;
};

}  // namespace meridian::globebrowsing

template <>
struct std::hash<meridian::globebrowsing::TileKey> {
  std::size_t operator()(const meridian::globebrowsing::TileKey& key) const noexcept {
    // Fibonacci hashing spreads the few stream numbers over the whole word.
    return std::hash<meridian::globebrowsing::TileIndex>()(key.index) ^
           static_cast<std::size_t>(key.stream * 0x9E3779B97F4A7C15ull);
  }
};
