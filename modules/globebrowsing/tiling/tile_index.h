#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace meridian::globebrowsing {

/// Names one tile of a tiling. x counts columns eastward (or along the face's u), y rows from the north (or the face's
/// v = 0), both from 0 within the root.
struct TileIndex {
  std::uint8_t root = 0;
  std::uint8_t level = 0;
  std::uint32_t x = 0;
  std::uint32_t y = 0;

  auto operator<=>(const TileIndex&) const = default;
};

/// No tiling is deeper: 2^-23 of an Earth radius is under a metre, 8 more levels reach below a centimetre.
inline constexpr int maximumLevel = 30;

/// "2/14/1021/77": root, level, x, y; for messages.
[[nodiscard]] std::string toString(const TileIndex& index);

}  // namespace meridian::globebrowsing

template <>
struct std::hash<meridian::globebrowsing::TileIndex> {
  /// Inline, because a look-up in a table calls it for each tile of a bucket.
  std::size_t operator()(const meridian::globebrowsing::TileIndex& index) const noexcept {
    // x and y fill 30 bits each and the root the four left over, so tiles of one level differ before mixing; the
    // finaliser of splitmix64 spreads neighbours over the buckets, and its increment, once per level, sets levels
    // apart.
    const std::uint64_t root = index.root;
    std::uint64_t bits = (std::uint64_t{index.y} << 32U) | index.x | ((root & 3U) << 30U) | ((root >> 2U) << 62U);
    bits += (std::uint64_t{index.level} + 1) * 0x9e3779b97f4a7c15ULL;
    bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebULL;
    return static_cast<std::size_t>(bits ^ (bits >> 31U));
  }
};
