#pragma once

#include "globebrowsing/chunks/selection.h"
#include "globebrowsing/gpu/composer.h"
#include "globebrowsing/layers/chunk_surface.h"
#include "globebrowsing/surface/surface.h"

namespace meridian::globebrowsing {

/// The level of its normals that the chunk is drawn with: that whose nodes are nearest to a pixel apart.
[[nodiscard]] int normalLevel(const ChunkSurface& surface, const SelectedChunk& chunk, const View& view);

/// Texels across the chunk, of the composites that it draws: they may be ancestors', of which it is a part.
struct TexelsAcross {
  double fewest = 0.0;
  double most = 0.0;
};

/// How its composites are sampled: from one half-size level where that serves all of the chunk, which on a software
/// renderer is a third cheaper than two levels for each pixel, and at a slant sharper.
[[nodiscard]] Composer::Sampling samplingOf(const ChunkSurface& surface, const SelectedChunk& chunk,
                                            const TexelsAcross& texels, const View& view);

}  // namespace meridian::globebrowsing
