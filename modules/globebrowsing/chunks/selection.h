#pragma once

#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "globebrowsing/tiling/tile_index.h"

namespace meridian::globebrowsing {

/// One of the views that a selection serves.
struct SelectionView {
  glm::dvec3 cameraPosition{0.0};  ///< model space, metres
  glm::dmat4 clipFromModel{1.0};   ///< for the four side planes and the near plane (reversed depth, infinite far)
  double pixelsPerRadian = 0.0;
};

/// What decides how fine a tile must be; see evaluators.h.
enum class Evaluator : std::uint8_t { ScreenSpaceError, Distance, ProjectedArea, AvailableData };

/// What a selection aims at. Values out of range are brought into it.
struct SelectionSettings {
  Evaluator evaluator = Evaluator::ScreenSpaceError;
  double scale = 1.0;               ///< texels per pixel aimed at; 2 is sharper and dearer, 0.5 coarser
  double compositeTexels = 512.0;   ///< along a side of a tile
  double maximumErrorPixels = 0.5;  ///< of geometry; above 0
  bool frustumCulling = true;
  bool horizonCulling = true;
  double lowestHeight = 0.0;  ///< metres, at most 0: the least height drawn anywhere on the globe
  /// Whether tiles beside the picture are asked for too, last of all, so that turning round finds them.
  bool prefetch = true;
  int deepestLevel = 30;  ///< 0 draws the roots only
  /// Tiles that one pass may look at. There are at most 2048 shapes in memory; views of films and domes look at some
  /// thousands of tiles. Only data or bodies that are out of all proportion ask for more.
  std::uint32_t mostVisited = 1U << 14U;
};

/// A chunk to draw.
struct SelectedChunk {
  TileIndex index;
  int colourLevel = 0;          ///< of the tile whose composite it draws: its own level or an ancestor's
  int step = 0;                 ///< 0..4: 2, 4, 8, 16, 32 segments a side
  std::uint32_t views = 0;      ///< bit i: visible in view i, of the first 32
  double distance = 0.0;        ///< metres, from the nearest camera to the nearest point of its bounds
  double error = 0.0;           ///< metres, of the surface as drawn
  double skirt = 0.0;           ///< metres: how far its skirts must reach down to close every gap, see skirts.h
  std::uint8_t skirtEdges = 0;  ///< bit of each Edge that needs one: elsewhere the neighbour draws the same vertices
};

/// What the last selection did.
struct SelectionFigures {
  std::uint32_t visited = 0;
  std::uint32_t nodes = 0;  ///< in the tree now
  std::uint32_t culledFrustum = 0;
  std::uint32_t culledHorizon = 0;
  std::uint32_t kicked = 0;   ///< chunks drawn in place of replacements that are incomplete
  bool atTarget = false;      ///< every chunk drawn is complete and what settings ask for with a coarsening that stays
  double coarsening = 1.0;    ///< errors allowed are that many times those of the settings: more than 1 at mostVisited
  std::uint32_t missing = 0;  ///< target chunks that are not complete
  /// Bit i: something that view i sees is not at its target; no bit is set exactly where atTarget.
  std::uint32_t viewsShortOfTarget = 0;
};

}  // namespace meridian::globebrowsing
