#include "globebrowsing/source/tile_decoder.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "globebrowsing/source/service_exception.h"
#include "globebrowsing/source/tile_formats.h"

namespace meridian::globebrowsing {

namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

bool startsWith(std::span<const std::uint8_t> bytes, std::string_view begin, std::size_t at = 0) {
  return bytes.size() >= at + begin.size() &&
         std::equal(begin.begin(), begin.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                    [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

/// What there is in place of an image: nothing, as agreed, or an error.
template <class Tile>
TileResult<Tile> withoutImage(std::span<const std::uint8_t> bytes, const TileService& service) {
  if (bytes.empty()) {
    return Tile{};  // some servers say 200 and nothing where others say 204 or 404
  }
  if (const auto said = exceptionText(bytes)) {
    if (service.isExceptionEmpty) {
      return Tile{};
    }
    return failure("the service says: " + *said, service.where);
  }
  return failure(fmt::format("the tile begins with {:02X} {:02X}, which is no image format that is read here", bytes[0],
                             bytes.size() > 1 ? bytes[1] : 0),
                 service.where);
}

TileResult<DecodedImage> decodeImage(std::span<const std::uint8_t> bytes, TileFormat format, const std::string& where,
                                     const ImageLimits& limits) {
  switch (format) {
    case TileFormat::Jpeg:
      return decodeJpeg(bytes, where, limits);
    case TileFormat::Png:
      return decodePng(bytes, where, limits);
    case TileFormat::Lerc:
      return decodeLerc(bytes, where, limits);
    default:
      return decodeByGdal(bytes, where, limits);
  }
}

template <class Image>
TileResult<void> checkMatrix(const Image& image, const TileService& service, std::size_t matrix) {
  assert(matrix < service.matrices.size());
  const TileMatrix& expected = service.matrices[matrix];
  if (image.width != expected.tileWidth || image.height != expected.tileHeight) {
    const bool isSquare = image.width == image.height;
    return ownFailure(fmt::format("the tile has {} x {} pixels in place of {} x {}", image.width, image.height,
                                  expected.tileWidth, expected.tileHeight),
                      service.where,
                      service.isSizeGiven && isSquare
                          ? fmt::format("write Tiles = {{ PixelSize = {} }} in the layer", image.width)
                          : "correct the description's block or tile size");
  }
  return {};
}

/// Whether a tile has the one column and row more that an ArcGIS elevation cache does not announce.
template <class Image>
bool sharesEdges(const Image& image, TileFormat format, const TileMatrix& matrix) {
  return (format == TileFormat::Lerc || format == TileFormat::Lerc1) && image.width == matrix.tileWidth + 1 &&
         image.height == matrix.tileHeight + 1;
}

/// Esri's own client puts the first of 257 samples on the west edge of the tile and the last on the east edge
/// (ElevationTile of the ArcGIS API for JavaScript), and interpolates between them. A matrix has pixels, whose values
/// are those in their middles: there that interpolation is the mean of four. To leave the last ones out instead would
/// move everything half a pixel to the southeast. Next to a hole the mean is of those that are there.
DecodedHeights inMiddles(const DecodedHeights& corners) {
  DecodedHeights tile{corners.width - 1, corners.height - 1, {}};
  const auto across = static_cast<std::size_t>(corners.width);
  tile.metres.reserve(static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height));
  for (std::size_t row = 0; row + 1 < static_cast<std::size_t>(corners.height); ++row) {
    for (std::size_t column = 0; column + 1 < across; ++column) {
      const float* corner = corners.metres.data() + row * across + column;
      float sum = 0.0F;
      int count = 0;
      for (const float value : {corner[0], corner[1], corner[across], corner[across + 1]}) {
        sum += std::isnan(value) ? 0.0F : value;
        count += std::isnan(value) ? 0 : 1;
      }
      tile.metres.push_back(count == 0 ? nothing : sum / static_cast<float>(count));
    }
  }
  return tile;
}

DecodedColours withoutLast(const DecodedColours& shared) {
  DecodedColours tile{shared.width - 1, shared.height - 1, {}};
  const std::size_t bytes = 4 * static_cast<std::size_t>(tile.width);
  for (int row = 0; row < tile.height; ++row) {
    const std::uint8_t* first = shared.rgba.data() + static_cast<std::size_t>(row) * (bytes + 4);
    tile.rgba.insert(tile.rgba.end(), first, first + bytes);
  }
  return tile;
}

void makeNoDataTransparent(DecodedImage& image, const TileService& service) {
  const bool alphaIsABand = image.hasAlpha && (service.bands == 2 || service.bands == 4);
  if (!service.isNoDataTransparent || !service.noData || alphaIsABand || *service.noData < 0.0 ||
      *service.noData > 255.0 || *service.noData != std::floor(*service.noData)) {
    return;
  }
  const auto absent = static_cast<std::uint8_t>(*service.noData);
  ByteVector& rgba = image.tile.rgba;
  for (std::size_t at = 0; at < rgba.size(); at += 4) {
    if (rgba[at] == absent && rgba[at + 1] == absent && rgba[at + 2] == absent) {
      rgba[at + 3] = 0;
    }
  }
}

float unpacked(const std::uint8_t* rgba, TileEncoding encoding) {
  const std::uint32_t r = rgba[0];
  const std::uint32_t g = rgba[1];
  const std::uint32_t b = rgba[2];
  const std::uint32_t a = rgba[3];
  if (encoding == TileEncoding::PackedFloat) {
    const auto metres = std::bit_cast<float>((r << 24) | (g << 16) | (b << 8) | a);
    return std::abs(metres) <= 1e6F ? metres : nothing;
  }
  if (a == 0) {
    return nothing;
  }
  if (encoding == TileEncoding::MapboxRgb) {
    return static_cast<float>(-10000.0 + 0.1 * static_cast<double>((r << 16) | (g << 8) | b));
  }
  return static_cast<float>(256.0 * r + g + b / 256.0 - 32768.0);
}

/// Values of band 1; eight bits come from our own, faster readers.
TileResult<DecodedValues> decodeValues(std::span<const std::uint8_t> bytes, TileFormat format, const std::string& where,
                                       const ImageLimits& limits) {
  constexpr std::size_t bitDepthOfPng = 24;
  constexpr std::size_t colourTypeOfPng = 25;
  if (format == TileFormat::Lerc) {
    return valuesOfLerc(bytes, where, limits);
  }
  const bool isPlain = format == TileFormat::Jpeg || (format == TileFormat::Png && bytes.size() > colourTypeOfPng &&
                                                      bytes[bitDepthOfPng] == 8 && bytes[colourTypeOfPng] != 3);
  if (!isPlain) {
    return valuesByGdal(bytes, where, limits);
  }
  auto image = decodeImage(bytes, format, where, limits);
  if (!image) {
    return tl::make_unexpected(std::move(image.error()));
  }
  const DecodedColours& tile = image->tile;
  DecodedValues result{tile.width, tile.height, std::vector<float>(tile.rgba.size() / 4)};
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    result.values[i] = tile.rgba[4 * i + 3] == 0 ? nothing : static_cast<float>(tile.rgba[4 * i]);
  }
  return result;
}

TileResult<DecodedHeights> heightsOfValues(std::span<const std::uint8_t> bytes, TileFormat format,
                                           const TileService& service, const ImageLimits& limits) {
  auto values = decodeValues(bytes, format, service.where, limits);
  if (!values) {
    return tl::make_unexpected(std::move(values.error()));
  }
  const double scale = service.heightScale.value_or(values->scale);
  const double offset = service.heightOffset.value_or(values->offset);
  const float absent = service.noData ? static_cast<float>(*service.noData) : nothing;
  DecodedHeights tile{values->width, values->height, std::move(values->values)};
  for (float& value : tile.metres) {
    value = value == absent || !std::isfinite(value) ? nothing : static_cast<float>(value * scale + offset);
  }
  return tile;
}

TileResult<DecodedHeights> heightsOfPacked(std::span<const std::uint8_t> bytes, TileFormat format,
                                           const TileService& service, const ImageLimits& limits) {
  auto image = decodeImage(bytes, format, service.where, limits);
  if (!image) {
    return tl::make_unexpected(std::move(image.error()));
  }
  DecodedHeights tile{image->tile.width, image->tile.height, std::vector<float>(image->tile.rgba.size() / 4)};
  const double scale = service.heightScale.value_or(1.0);
  const double offset = service.heightOffset.value_or(0.0);
  for (std::size_t i = 0; i < tile.metres.size(); ++i) {
    const float metres = unpacked(image->tile.rgba.data() + 4 * i, service.encoding);
    const bool isAbsent = service.noData && metres == static_cast<float>(*service.noData);
    tile.metres[i] = isAbsent ? nothing : static_cast<float>(metres * scale + offset);
  }
  return tile;
}

}  // namespace

TileFormat formatOf(std::span<const std::uint8_t> bytes) {
  using namespace std::string_view_literals;
  if (startsWith(bytes, "\xFF\xD8\xFF"sv)) {
    return TileFormat::Jpeg;
  }
  if (startsWith(bytes, "\x89PNG\r\n\x1A\n"sv)) {
    return TileFormat::Png;
  }
  if (startsWith(bytes, "RIFF"sv) && startsWith(bytes, "WEBP"sv, 8)) {
    return TileFormat::WebP;
  }
  if (startsWith(bytes, "II*\0"sv) || startsWith(bytes, "MM\0*"sv) || startsWith(bytes, "II+\0"sv) ||
      startsWith(bytes, "MM\0+"sv)) {
    return TileFormat::Tiff;
  }
  if (startsWith(bytes, "Lerc2 "sv)) {
    return TileFormat::Lerc;
  }
  if (startsWith(bytes, "CntZImage "sv)) {
    return TileFormat::Lerc1;
  }
  if (startsWith(bytes, "GIF8"sv)) {
    return TileFormat::Gif;
  }
  return startsWith(bytes, "BM"sv) ? TileFormat::Bmp : TileFormat::Unknown;
}

TileResult<void> checkTileSize(std::int64_t width, std::int64_t height, const std::string& where,
                               const ImageLimits& limits) {
  if (width < 1 || height < 1 || width > limits.side || height > limits.side || width * height > limits.pixels) {
    // No limit can be set to more than the longest side allows.
    const bool isOurs = width >= 1 && height >= 1 && std::max(width, height) <= longestTileSide;
    Error error{fmt::format("the tile announces {} x {} pixels, more than are decoded", width, height), where,
                "ask for smaller tiles, or raise MERIDIAN_IMAGE_SIDE or MERIDIAN_IMAGE_PIXELS"};
    return tl::make_unexpected(TileError(std::move(error), isOurs));
  }
  return {};
}

TileResult<DecodedColours> decodeColours(std::span<const std::uint8_t> bytes, const TileService& service,
                                         std::size_t matrix, const ImageLimits& limits) {
  const TileFormat format = formatOf(bytes);
  if (format == TileFormat::Unknown) {
    return withoutImage<DecodedColours>(bytes, service);
  }
  auto image = decodeImage(bytes, format, service.where, limits);
  if (!image) {
    return tl::make_unexpected(std::move(image.error()));
  }
  if (sharesEdges(image->tile, format, service.matrices[matrix])) {
    image->tile = withoutLast(image->tile);
  }
  if (auto fits = checkMatrix(image->tile, service, matrix); !fits) {
    return tl::make_unexpected(std::move(fits.error()));
  }
  makeNoDataTransparent(*image, service);
  return std::move(image->tile);
}

TileResult<DecodedHeights> decodeHeights(std::span<const std::uint8_t> bytes, const TileService& service,
                                         std::size_t matrix, const ImageLimits& limits) {
  const TileFormat format = formatOf(bytes);
  if (format == TileFormat::Unknown) {
    return withoutImage<DecodedHeights>(bytes, service);
  }
  auto tile = service.encoding == TileEncoding::Image ? heightsOfValues(bytes, format, service, limits)
                                                      : heightsOfPacked(bytes, format, service, limits);
  if (!tile) {
    return tile;
  }
  if (sharesEdges(*tile, format, service.matrices[matrix])) {
    tile = inMiddles(*tile);
  }
  if (auto fits = checkMatrix(*tile, service, matrix); !fits) {
    return tl::make_unexpected(std::move(fits.error()));
  }
  return tile;
}

TileResult<SourceTilePointer> decodeTile(const TileService& service, std::size_t matrix, PixelKind kind,
                                         const Fetched& fetched) {
  return decodeTileWithin({}, service, matrix, kind, fetched);
}

TileResult<SourceTilePointer> decodeTileWithin(const ImageLimits& limits, const TileService& service,
                                               std::size_t matrix, PixelKind kind, const Fetched& fetched) {
  const auto published = [](auto& decoded, auto&& pixels) -> SourceTilePointer {
    if (decoded.isEmpty()) {
      return nullptr;
    }
    auto tile = std::make_shared<SourceTile>();
    tile->width = decoded.width;
    tile->height = decoded.height;
    pixels(*tile);
    return tile;
  };
  if (kind == PixelKind::Heights) {
    return decodeHeights(*fetched.body, service, matrix, limits).map([&](DecodedHeights decoded) {
      return published(decoded, [&](SourceTile& tile) { tile.heights = std::move(decoded.metres); });
    });
  }
  return decodeColours(*fetched.body, service, matrix, limits).map([&](DecodedColours decoded) {
    return published(decoded, [&](SourceTile& tile) { tile.rgba = std::move(decoded.rgba); });
  });
}

}  // namespace meridian::globebrowsing
