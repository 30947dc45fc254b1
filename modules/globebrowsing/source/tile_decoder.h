#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "globebrowsing/network/network_options.h"
#include "globebrowsing/source/source_tile.h"
#include "globebrowsing/source/tile_service.h"
#include "host/api/error.h"

namespace meridian::globebrowsing {

/// A service's tile as colours: RGBA, 8 bits each, not premultiplied, rows from the north.
struct DecodedColours {
  int width = 0;
  int height = 0;
  ByteVector rgba{};  ///< width * height * 4

  /// The service said that there is nothing here.
  [[nodiscard]] bool isEmpty() const { return rgba.empty(); }
};

/// A service's tile as heights: metres, rows from the north; not-a-number where there are no data.
struct DecodedHeights {
  int width = 0;
  int height = 0;
  std::vector<float> metres{};

  [[nodiscard]] bool isEmpty() const { return metres.empty(); }
};

/// Of a tile's sides whatever ImageLimits say.
inline constexpr int longestTileSide = 8192;

/// Decodes the body of an answer to a request for a tile of `service.matrices[matrix]`: JPEG, PNG, WebP, TIFF, GIF,
/// BMP, LERC; which, its first bytes say. Grey, grey with alpha, RGB, RGBA, palettes; 16 bits are brought to 8. With
/// isNoDataTransparent, pixels whose bands are all noData get alpha 0.
///
/// A LERC tile may be one larger than its matrix each way, as those of Esri's elevation caches are: points on the
/// corners of pixels, the last column and row shared with the neighbours. Heights are then those in the middle of the
/// pixels; of colours the last column and row are left out.
///
/// Empty where the service answers with an exception (OGC XML, ArcGIS JSON, a page in HTML) and isExceptionEmpty says
/// what that means. Errors: an exception otherwise, quoted; a format that is not read; damaged or truncated data; of
/// our own making a size other than the matrix's, and what is beyond the limits. No input crashes it. Safe from any
/// thread.
[[nodiscard]] TileResult<DecodedColours> decodeColours(std::span<const std::uint8_t> bytes, const TileService& service,
                                                       std::size_t matrix, const ImageLimits& limits = {});

/// Likewise heights, by service.encoding. Of an Image: band 1 times heightScale plus heightOffset (default: what the
/// raster says itself, else 1 and 0), not-a-number where noData, the raster's own or its mask say so. Of the packed
/// ones: not-a-number where alpha is 0 (PackedFloat: where the float is one, or beyond 1e6 metres).
[[nodiscard]] TileResult<DecodedHeights> decodeHeights(std::span<const std::uint8_t> bytes, const TileService& service,
                                                       std::size_t matrix, const ImageLimits& limits = {});

/// Either of them, for a SourceTileStore: a TileDecoder.
[[nodiscard]] TileResult<SourceTilePointer> decodeTile(const TileService& service, std::size_t matrix, PixelKind kind,
                                                       const Fetched& fetched);
[[nodiscard]] TileResult<SourceTilePointer> decodeTileWithin(const ImageLimits& limits, const TileService& service,
                                                             std::size_t matrix, PixelKind kind,
                                                             const Fetched& fetched);

}  // namespace meridian::globebrowsing
