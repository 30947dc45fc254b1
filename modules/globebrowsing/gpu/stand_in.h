#pragma once

#include "globebrowsing/streaming/tile_streamer.h"
#include "globebrowsing/tiling/tiling.h"

namespace meridian::globebrowsing {

/// What a composition is still without.
struct Lack {
  /// Of a layer of which there is nothing at all.
  static constexpr unsigned everything = 64;

  unsigned coarser = 0;    ///< by how many levels its parts are coarser than they should be, all together
  bool comesSoon = false;  ///< some of it is worth waiting for

  Lack& operator+=(const Lack& other) {
    coarser += other.coarser;
    comesSoon = comesSoon || other.comesSoon;
    return *this;
  }
};

/// What is drawn in place of a raw tile: that of its nearest ancestor, or itself, that is in memory.
struct StandIn {
  const TileDataPointer* tile = nullptr;  ///< null without any; good until the streamer's endFrame
  TileIndex index;
  UnitSquareTransform within;  ///< of the wanted tile in the stand-in
  unsigned coarser = Lack::everything;
};
[[nodiscard]] StandIn findStandIn(TileStreamer& streamer, const Tiling& tiling, const TileKey& wanted);

/// Every frame: keeps the stream's root tiles in memory, so that there is a stand-in wherever the layer ever showed.
void keepRoots(TileStreamer& streamer, const Tiling& tiling, std::uint32_t stream);

}  // namespace meridian::globebrowsing
