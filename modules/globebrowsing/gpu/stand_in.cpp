#include "globebrowsing/gpu/stand_in.h"

namespace meridian::globebrowsing {

StandIn findStandIn(TileStreamer& streamer, const Tiling& tiling, const TileKey& wanted) {
  StandIn found;
  TileIndex index = wanted.index;
  while (true) {
    const TileKey key{wanted.stream, index};
    const TileAnswer answer = streamer.peek(key);
    if (answer.state == TileAnswer::State::Ready) {
      streamer.touch(key);
      found.tile = answer.data;
      found.index = index;
      found.coarser = static_cast<unsigned>(wanted.index.level - index.level);
      return found;
    }
    const std::optional<TileIndex> parent = tiling.parent(index);
    if (!parent) {
      return {};
    }
    found.within = found.within.then(tiling.inParent(index));
    index = *parent;
  }
}

void keepRoots(TileStreamer& streamer, const Tiling& tiling, std::uint32_t stream) {
  for (int root = 0; root < tiling.rootCount(); ++root) {
    streamer.touch({stream, {static_cast<std::uint8_t>(root), 0, 0, 0}});
  }
}

}  // namespace meridian::globebrowsing
