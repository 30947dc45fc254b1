#include "globebrowsing/tiling/tiling.h"

#include <cassert>

namespace meridian::globebrowsing {

AncestorPlace ancestorAt(const Tiling& tiling, const TileIndex& index, int level) {
  assert(level >= 0 && level <= index.level);
  AncestorPlace place{index, {}};
  while (place.index.level > level) {
    place.transform = place.transform.then(tiling.inParent(place.index));
    place.index = *tiling.parent(place.index);
  }
  return place;
}

}  // namespace meridian::globebrowsing
