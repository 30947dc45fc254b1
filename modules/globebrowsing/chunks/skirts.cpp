#include "globebrowsing/chunks/skirts.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

namespace meridian::globebrowsing {

namespace {

std::uint8_t bitOf(Edge edge) {
  return static_cast<std::uint8_t>(1U << static_cast<unsigned>(edge));
}

bool touchesPole(const Tiling& tiling, const TileIndex& index) {
  return !tiling.neighbour(index, Edge::North) || !tiling.neighbour(index, Edge::South);
}

}  // namespace

SkirtFitter::Slot& SkirtFitter::slotOf(const TileIndex& index) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t place = std::hash<TileIndex>()(index) & mask;
  while (slots_[place].chunk != empty && slots_[place].index != index) {
    place = (place + 1) & mask;
  }
  return slots_[place];
}

void SkirtFitter::fill(NodePool& pool, const Drawn& drawn) {
  // A tree's inner nodes are at most as many as its leaves when each has two children or more; lone ones beside culled
  // siblings may double that, and a table at most half full probes little.
  const std::size_t wanted = std::bit_ceil(std::max<std::size_t>(64, 8 * drawn.chunks.size()));
  if (slots_.size() < wanted) {
    slots_.resize(wanted);
  }
  std::fill(slots_.begin(), slots_.end(), Slot{});
  filled_ = 0;
  for (std::size_t i = 0; i < drawn.chunks.size(); ++i) {
    const double error = drawn.chunks[i].error;
    slotOf(drawn.chunks[i].index) = {drawn.chunks[i].index, static_cast<std::int32_t>(i), error};
    ++filled_;
    for (NodeNumber up = pool[drawn.numbers[i]].parent; up != noNode; up = pool[up].parent) {
      Slot& slot = slotOf(pool[up].index);
      if (slot.chunk != empty) {
        if (slot.error >= error) {
          break;
        }
        slot.error = error;
        continue;
      }
      slot = {pool[up].index, interior, error};
      if (++filled_ * 4 > slots_.size() * 3) {
        // Long lone branches: start again with room for them.
        slots_.resize(2 * slots_.size());
        fill(pool, drawn);
        return;
      }
    }
  }
}

const SkirtFitter::Slot* SkirtFitter::drawnAt(const Tiling& tiling, TileIndex index) {
  const Slot* slot = &slotOf(index);
  if (slot->chunk != empty) {
    return slot;
  }
  for (std::optional<TileIndex> up = tiling.parent(index); up; up = tiling.parent(*up)) {
    slot = &slotOf(*up);
    if (slot->chunk != empty) {
      // Below an inner node, but not drawn: culled.
      return slot->chunk >= 0 ? slot : nullptr;
    }
  }
  return nullptr;
}

void SkirtFitter::fit(const Tiling& tiling, NodePool& pool, const Drawn& drawn) {
  fill(pool, drawn);
  for (std::size_t i = 0; i < drawn.chunks.size(); ++i) {
    SelectedChunk& chunk = drawn.chunks[i];
    ChunkNode& node = pool[drawn.numbers[i]];
    if (!node.hasNeighbours) {
      for (std::size_t edge = 0; edge < allEdges.size(); ++edge) {
        const std::optional<Neighbour> neighbour = tiling.neighbour(node.index, allEdges[edge]);
        node.hasNeighbour[edge] = neighbour.has_value();
        node.neighbours[edge] = neighbour ? neighbour->index : TileIndex{};
        node.neighbourEdges[edge] = neighbour ? neighbour->edge : Edge::West;
        // A tile that tapers to a pole may have fewer vertices along its other edge (chunk_grid::Columns).
        node.sameEdge[edge] = neighbour && std::abs(neighbour->scale) == 1.0 &&
                              touchesPole(tiling, node.index) == touchesPole(tiling, neighbour->index);
      }
      node.hasNeighbours = true;
    }
    for (std::size_t edge = 0; edge < allEdges.size(); ++edge) {
      const Slot* slot = node.hasNeighbour[edge] ? drawnAt(tiling, node.neighbours[edge]) : nullptr;
      if (slot == nullptr) {
        continue;
      }
      const std::uint8_t bit = bitOf(static_cast<Edge>(edge));
      if (slot->chunk == interior) {
        chunk.skirtEdges |= bit;
        // Twice: a chunk's error at 32 segments is at most its error as drawn.
        chunk.skirt = std::max(chunk.skirt, 2.0 * slot->error);
        continue;
      }
      SelectedChunk& other = drawn.chunks[static_cast<std::size_t>(slot->chunk)];
      const bool unequal = other.index.level != chunk.index.level;
      const SurfaceErrors& errors = pool[drawn.numbers[static_cast<std::size_t>(slot->chunk)]].errors;
      const double unlike = std::max(node.errors.unlike, errors.unlike);
      if (!unequal && node.sameEdge[edge] && other.step == chunk.step && unlike == 0.0) {
        continue;
      }
      chunk.skirtEdges |= bit;
      other.skirtEdges |= bitOf(node.neighbourEdges[edge]);
      const double relief = (unequal ? errors.vertical.back() : 0.0) + unlike;
      chunk.skirt = std::max(chunk.skirt, other.error + relief);
      other.skirt = std::max(other.skirt, chunk.error + relief);
    }
  }
  for (SelectedChunk& chunk : drawn.chunks) {
    chunk.skirt += chunk.error + drawn.allowedPixels * drawn.metresPerPixel * chunk.distance;
  }
}

}  // namespace meridian::globebrowsing
