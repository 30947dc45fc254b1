#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "globebrowsing/chunks/chunk_bounds.h"
#include "globebrowsing/chunks/culling.h"
#include "globebrowsing/streaming/tile_residency.h"

namespace meridian::globebrowsing {

using NodeNumber = std::int32_t;
inline constexpr NodeNumber noNode = -1;

/// A tile that the chunk tree has visited, with what it remembers from frame to frame.
struct ChunkNode {
  TileIndex index;
  NodeNumber parent = noNode;
  std::array<NodeNumber, 4> children{noNode, noNode, noNode, noNode};
  std::int32_t childCount = 0;   ///< 0 until it was split
  std::int32_t colourLevel = 0;  ///< of the tile whose composite it draws
  std::uint64_t visitedFrame = 0;
  std::uint64_t selectedFrame = 0;
  std::uint64_t belowFrame = 0;  ///< the last frame in which something below it was selected
  ChunkBounds bounds;
  HorizonCap horizonCap;
  double occluderScale = -1.0;  ///< that horizonCap was made for
  unsigned heightVersion = 0;
  bool bounded = false;
  SurfaceErrors errors;  ///< while visitedFrame is the current one and it is not culled
  bool hasNeighbours = false;
  std::array<TileIndex, 4> neighbours{};
  std::array<Edge, 4> neighbourEdges{};  ///< of the neighbours, that lie along this node's
  std::array<bool, 4> sameEdge{};        ///< whether that edge is just as long, not one that holds this node's
  std::array<bool, 4> hasNeighbour{};
};

/// Nodes by number, in blocks that never move. Freed ones are used again first, so a steady tree allocates nothing.
class NodePool {
 public:
  [[nodiscard]] ChunkNode& operator[](NodeNumber number) {
    return (*blocks_[static_cast<std::size_t>(number) / blockSize])[static_cast<std::size_t>(number) % blockSize];
  }

  [[nodiscard]] NodeNumber take(const TileIndex& index, NodeNumber parent) {
    if (free_ == noNode) {
      grow();
    }
    const NodeNumber number = free_;
    ChunkNode& node = (*this)[number];
    free_ = node.parent;
    node = ChunkNode{};
    node.index = index;
    node.parent = parent;
    ++used_;
    return number;
  }

  void give(NodeNumber number) {
    (*this)[number].parent = free_;
    free_ = number;
    --used_;
  }

  [[nodiscard]] std::uint32_t used() const { return used_; }

 private:
  static constexpr std::size_t blockSize = 256;
  using Block = std::array<ChunkNode, blockSize>;

  void grow() {
    const std::size_t first = blocks_.size() * blockSize;
    blocks_.push_back(std::make_unique<Block>());
    for (std::size_t i = blockSize; i > 0; --i) {
      const auto number = static_cast<NodeNumber>(first + i - 1);
      (*this)[number].parent = free_;  // free nodes are chained through their parent
      free_ = number;
    }
  }

  std::vector<std::unique_ptr<Block>> blocks_;
  NodeNumber free_ = noNode;
  std::uint32_t used_ = 0;
};

}  // namespace meridian::globebrowsing
