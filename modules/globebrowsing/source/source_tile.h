#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "globebrowsing/network/fetcher.h"
#include "globebrowsing/source/raster_reader.h"
#include "globebrowsing/source/tile_service.h"

namespace meridian::globebrowsing {

enum class PixelKind : std::uint8_t { Colours, Heights };

/// A decoded tile of a service; of its pixels, those of one kind.
struct SourceTile {
  int width = 0;
  int height = 0;
  std::vector<Rgba> colours{};
  std::vector<float> heights{};  ///< metres; not-a-number where there are none

  [[nodiscard]] const std::vector<Rgba>& pixels(const Rgba*) const { return colours; }
  [[nodiscard]] const std::vector<float>& pixels(const float*) const { return heights; }
  [[nodiscard]] std::size_t bytes() const {
    return sizeof(*this) + colours.size() * sizeof(Rgba) + heights.size() * sizeof(float);
  }
};
using SourceTilePointer = std::shared_ptr<const SourceTile>;

/// An answer's body (never null) for a tile of service.matrices[matrix] -> pixels; null when it says that there is
/// nothing. On a worker.
using TileDecoder =
    std::function<Result<SourceTilePointer>(const TileService&, std::size_t matrix, PixelKind, const Fetched&)>;

}  // namespace meridian::globebrowsing
