#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>

#include <Lerc_c_api.h>

#include "globebrowsing/source/tile_formats.h"

namespace meridian::globebrowsing {

namespace {

struct Blob {
  int width = 0;
  int height = 0;
  int bands = 0;
  int depth = 0;  ///< values of a pixel that lie together
  bool hasMask = false;
  std::vector<double> values{};         ///< band by band
  std::vector<std::uint8_t> isThere{};  ///< of a pixel, the same for all bands
};

TileResult<Blob> decode(std::span<const std::uint8_t> bytes, const std::string& where, const ImageLimits& limits) {
  // version, type, depth, columns, rows, bands, valid pixels, blob size, masks
  std::array<unsigned int, 9> info{};
  std::array<double, 3> range{};
  const auto size = static_cast<unsigned int>(std::min<std::size_t>(bytes.size(), std::numeric_limits<int>::max()));
  if (lerc_getBlobInfo(bytes.data(), size, info.data(), range.data(), info.size(), range.size()) != 0) {
    return failure("the LERC blob is damaged", where);
  }
  if (auto good = checkTileSize(info[3], info[4], where, limits); !good) {
    return tl::make_unexpected(std::move(good.error()));
  }
  const std::uint64_t pixels = std::uint64_t{info[3]} * info[4];
  const std::uint64_t values = pixels * info[2] * info[5];
  if (info[2] < 1 || info[5] < 1 || info[2] > 16 || info[5] > 16) {
    return failure("the LERC blob has too many bands", where);
  }
  if (values > 4 * static_cast<std::uint64_t>(limits.pixels)) {
    return ownFailure("the LERC blob has too many bands for its size", where, "raise MERIDIAN_IMAGE_PIXELS");
  }
  Blob blob{static_cast<int>(info[3]), static_cast<int>(info[4]), static_cast<int>(info[5]), static_cast<int>(info[2])};
  blob.hasMask = info[8] > 0;
  blob.values.resize(values);
  std::vector<std::uint8_t> masks(pixels * std::max(1U, std::min(info[8], info[5])));
  if (lerc_decodeToDouble(bytes.data(), size, static_cast<int>(std::min(info[8], info[5])),
                          blob.hasMask ? masks.data() : nullptr, blob.depth, blob.width, blob.height, blob.bands,
                          blob.values.data()) != 0) {
    return failure("the LERC blob is damaged", where);
  }
  blob.isThere.assign(pixels, 1);
  if (blob.hasMask) {
    std::copy_n(masks.begin(), pixels, blob.isThere.begin());
  }
  return blob;
}

/// The library throws nothing by its interface, and lets its allocations fail through it.
TileResult<Blob> decodeSafely(std::span<const std::uint8_t> bytes, const std::string& where,
                              const ImageLimits& limits) {
  try {
    return decode(bytes, where, limits);
  } catch (const std::exception& exception) {
    return failure(std::string("the LERC blob cannot be decoded (") + exception.what() + ")", where);
  }
}

}  // namespace

TileResult<DecodedValues> valuesOfLerc(std::span<const std::uint8_t> bytes, const std::string& where,
                                       const ImageLimits& limits) {
  auto blob = decodeSafely(bytes, where, limits);
  if (!blob) {
    return tl::make_unexpected(std::move(blob.error()));
  }
  DecodedValues result{blob->width, blob->height, std::vector<float>(blob->isThere.size())};
  for (std::size_t i = 0; i < result.values.size(); ++i) {
    result.values[i] = blob->isThere[i] != 0
                           ? static_cast<float>(blob->values[i * static_cast<std::size_t>(blob->depth)])
                           : std::numeric_limits<float>::quiet_NaN();
  }
  return result;
}

TileResult<DecodedImage> decodeLerc(std::span<const std::uint8_t> bytes, const std::string& where,
                                    const ImageLimits& limits) {
  auto blob = decodeSafely(bytes, where, limits);
  if (!blob) {
    return tl::make_unexpected(std::move(blob.error()));
  }
  const std::size_t pixels = blob->isThere.size();
  const auto depth = static_cast<std::size_t>(blob->depth);
  const std::size_t channels = depth > 1 ? depth : static_cast<std::size_t>(blob->bands);
  DecodedImage image{{blob->width, blob->height, ByteVector(pixels * 4, 255)},
                     blob->hasMask || channels == 2 || channels == 4};
  const auto value = [&](std::size_t pixel, std::size_t channel) {
    const double stored = depth > 1 ? blob->values[pixel * depth + channel] : blob->values[channel * pixels + pixel];
    return static_cast<std::uint8_t>(std::lround(std::clamp(std::isnan(stored) ? 0.0 : stored, 0.0, 255.0)));
  };
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    std::uint8_t* rgba = image.tile.rgba.data() + 4 * pixel;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      rgba[channel] = value(pixel, channels >= 3 ? channel : 0);
    }
    rgba[3] = blob->isThere[pixel] == 0 ? std::uint8_t{0}
              : channels == 2           ? value(pixel, 1)
              : channels >= 4           ? value(pixel, 3)
                                        : std::uint8_t{255};
  }
  return image;
}

}  // namespace meridian::globebrowsing
