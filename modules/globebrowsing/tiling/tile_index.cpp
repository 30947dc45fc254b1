#include "globebrowsing/tiling/tile_index.h"

#include <fmt/format.h>

namespace meridian::globebrowsing {

std::string toString(const TileIndex& index) {
  return fmt::format("{}/{}/{}/{}", index.root, index.level, index.x, index.y);
}

}  // namespace meridian::globebrowsing

std::size_t std::hash<meridian::globebrowsing::TileIndex>::operator()(
    const meridian::globebrowsing::TileIndex& index) const noexcept {
  // x and y fill 30 bits each and the root the four left over, so tiles of one level differ before mixing; the
  // finaliser of splitmix64 spreads neighbours over the buckets, and its increment, once per level, sets levels apart.
  const std::uint64_t root = index.root;
  std::uint64_t bits = (std::uint64_t{index.y} << 32U) | index.x | ((root & 3U) << 30U) | ((root >> 2U) << 62U);
  bits += (std::uint64_t{index.level} + 1) * 0x9e3779b97f4a7c15ULL;
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebULL;
  return static_cast<std::size_t>(bits ^ (bits >> 31U));
}
