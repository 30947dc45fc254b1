#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "globebrowsing/source/tile_decoder.h"

namespace meridian::globebrowsing {

// One reader a format, for tile_decoder.cpp. `where` is for errors.

/// Lerc1 ("CntZImage") goes through GDAL, whose reader looks where the data end; the LERC library's does not.
enum class TileFormat : std::uint8_t { Jpeg, Png, WebP, Tiff, Gif, Bmp, Lerc, Lerc1, Unknown };
[[nodiscard]] TileFormat formatOf(std::span<const std::uint8_t> bytes);

struct DecodedImage {
  DecodedColours tile;
  bool hasAlpha = false;
};

[[nodiscard]] TileResult<void> checkTileSize(std::int64_t width, std::int64_t height, const std::string& where,
                                             const ImageLimits& limits);
[[nodiscard]] TileResult<DecodedImage> decodeJpeg(std::span<const std::uint8_t> bytes, const std::string& where,
                                                  const ImageLimits& limits = {});
[[nodiscard]] TileResult<DecodedImage> decodePng(std::span<const std::uint8_t> bytes, const std::string& where,
                                                 const ImageLimits& limits = {});
/// Whatever GDAL reads of WebP, TIFF, GIF, BMP, JPEG, PNG and Lerc1.
[[nodiscard]] TileResult<DecodedImage> decodeByGdal(std::span<const std::uint8_t> bytes, const std::string& where,
                                                    const ImageLimits& limits = {});
[[nodiscard]] TileResult<DecodedImage> decodeLerc(std::span<const std::uint8_t> bytes, const std::string& where,
                                                  const ImageLimits& limits = {});

/// Stored values of band 1, not-a-number where there are none by the raster's own account.
struct DecodedValues {
  int width = 0;
  int height = 0;
  std::vector<float> values;
  double scale = 1.0;  ///< the raster's own
  double offset = 0.0;
};
[[nodiscard]] TileResult<DecodedValues> valuesByGdal(std::span<const std::uint8_t> bytes, const std::string& where,
                                                     const ImageLimits& limits = {});
[[nodiscard]] TileResult<DecodedValues> valuesOfLerc(std::span<const std::uint8_t> bytes, const std::string& where,
                                                     const ImageLimits& limits = {});

}  // namespace meridian::globebrowsing
