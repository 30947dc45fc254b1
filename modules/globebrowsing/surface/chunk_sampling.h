#pragma once

#include "globebrowsing/chunks/selection.h"
#include "globebrowsing/gpu/composer.h"
#include "globebrowsing/layers/chunk_surface.h"
#include "globebrowsing/surface/surface.h"

namespace meridian::globebrowsing {

/// The level of its normals that the chunk is drawn with, 0 (all nodes) to NormalImage::levels - 1: that whose nodes
/// are nearest to a pixel apart, north to south.
[[nodiscard]] int normalLevel(const ChunkSurface& surface, const SelectedChunk& chunk, const View& view);

/// Texels across the chunk at full size, of the composites that it draws: they may be ancestors', of which it is a
/// part.
struct TexelsAcross {
  double fewest = 0.0;
  double most = 0.0;
};

/// How its composites are sampled: from one half-size level where that serves all of the chunk, which on a software
/// renderer is a third cheaper than two levels for each pixel, and at a slant sharper. Without composites, and for a
/// camera that is not finite, any.
[[nodiscard]] Composer::Sampling samplingOf(const ChunkSurface& surface, const SelectedChunk& chunk,
                                            const TexelsAcross& texels, const View& view);

}  // namespace meridian::globebrowsing
