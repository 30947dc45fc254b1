#include "globebrowsing/tiling/tile_index.h"

#include <fmt/format.h>

namespace meridian::globebrowsing {

std::string toString(const TileIndex& index) {
  return fmt::format("{}/{}/{}/{}", index.root, index.level, index.x, index.y);
}

}  // namespace meridian::globebrowsing

std::size_t std::hash<meridian::globebrowsing::TileIndex>::operator()(
    const meridian::globebrowsing::TileIndex& index) const noexcept {
  // x and y fill 30 bits each; the finaliser of splitmix64 spreads neighbouring tiles over the buckets.
  std::uint64_t bits = (std::uint64_t{index.root} << 60U) ^ (std::uint64_t{index.level} << 54U) ^
                       (std::uint64_t{index.y} << 27U) ^ index.x;
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebULL;
  return static_cast<std::size_t>(bits ^ (bits >> 31U));
}
