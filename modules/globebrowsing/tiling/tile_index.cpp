#include "globebrowsing/tiling/tile_index.h"

#include <fmt/format.h>

namespace meridian::globebrowsing {

std::string toString(const TileIndex& index) {
  return fmt::format("{}/{}/{}/{}", index.root, index.level, index.x, index.y);
}

}  // namespace meridian::globebrowsing
