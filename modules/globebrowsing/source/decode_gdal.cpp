#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include <cpl_vsi.h>
#include <gdal_priv.h>

#include "globebrowsing/source/gdal_runtime.h"
#include "globebrowsing/source/tile_formats.h"

namespace meridian::globebrowsing {

namespace {

constexpr float nothing = std::numeric_limits<float>::quiet_NaN();

/// Bytes as a file that only this object's dataset sees.
class MemoryDataset {
 public:
  MemoryDataset(std::span<const std::uint8_t> bytes, const GdalMessages& messages, const std::string& where)
      : messages_(messages), where_(where) {
    initializeGdal();
    std::array<char, 64> name{};
    std::snprintf(name.data(), name.size(), "/vsimem/meridian_tile_%p", static_cast<void*>(this));
    name_ = name.data();
    // GDAL does not write to it: the dataset is opened for reading.
    VSILFILE* file = VSIFileFromMemBuffer(name_.c_str(), const_cast<GByte*>(bytes.data()), bytes.size(), FALSE);
    if (file == nullptr) {
      return;
    }
    VSIFCloseL(file);
    // Image formats only: others can name files of this machine. So can MRF's own, and it sees a blob of Lerc1 only.
    const std::array<const char*, 7> images{"GTiff", "PNG", "JPEG", "WEBP", "GIF", "BMP", nullptr};
    const std::array<const char*, 2> lerc{"MRF", nullptr};
    const std::array<const char*, 3> lercOptions{"DATATYPE=Float32", "NDV=-3.4028234663852886e+38", nullptr};
    const std::array<const char*, 1> noSiblings{nullptr};
    const bool isLerc = formatOf(bytes) == TileFormat::Lerc1;
    dataset_.reset(GDALDataset::Open(name_.c_str(), GDAL_OF_RASTER, isLerc ? lerc.data() : images.data(),
                                     isLerc ? lercOptions.data() : nullptr, noSiblings.data()));
  }
  ~MemoryDataset() {
    dataset_.reset();
    VSIUnlink(name_.c_str());
  }
  MemoryDataset(const MemoryDataset&) = delete;
  MemoryDataset& operator=(const MemoryDataset&) = delete;

  /// Of a sane size, with real numbers.
  [[nodiscard]] TileResult<GDALDataset*> checked(const ImageLimits& limits) const {
    if (!dataset_ || dataset_->GetRasterCount() < 1) {
      return messages_.failure("the image cannot be read", where_);
    }
    if (auto good = checkTileSize(dataset_->GetRasterXSize(), dataset_->GetRasterYSize(), where_, limits); !good) {
      return tl::make_unexpected(std::move(good.error()));
    }
    for (int i = 1; i <= std::min(dataset_->GetRasterCount(), 4); ++i) {
      GDALRasterBand& band = *dataset_->GetRasterBand(i);
      int width = 0;
      int height = 0;
      band.GetBlockSize(&width, &height);
      const double bytes = 1.0 * width * height * GDALGetDataTypeSizeBytes(band.GetRasterDataType());
      if (GDALDataTypeIsComplex(band.GetRasterDataType()) != 0) {
        return failure("the image's samples are complex", where_);
      }
      if (bytes > 8.0 * limits.pixels) {
        return ownFailure("the image's blocks are too large", where_, "raise MERIDIAN_IMAGE_PIXELS");
      }
    }
    return dataset_.get();
  }

 private:
  const GdalMessages& messages_;
  const std::string& where_;
  std::string name_;
  GDALDatasetUniquePtr dataset_;
};

/// A palette's entries in place of their numbers.
void applyPalette(const GDALColorTable& palette, DecodedImage& image) {
  ByteVector& rgba = image.tile.rgba;
  for (std::size_t at = 0; at < rgba.size(); at += 4) {
    const GDALColorEntry* entry = rgba[at] < palette.GetColorEntryCount() ? palette.GetColorEntry(rgba[at]) : nullptr;
    const auto part = [&](short value) { return static_cast<std::uint8_t>(std::clamp<int>(value, 0, 255)); };
    const bool isThere = entry != nullptr;
    rgba[at] = isThere ? part(entry->c1) : std::uint8_t{0};
    rgba[at + 1] = isThere ? part(entry->c2) : std::uint8_t{0};
    rgba[at + 2] = isThere ? part(entry->c3) : std::uint8_t{0};
    rgba[at + 3] = isThere ? part(entry->c4) : std::uint8_t{0};
  }
  image.hasAlpha = true;
}

}  // namespace

TileResult<DecodedImage> decodeByGdal(std::span<const std::uint8_t> bytes, const std::string& where,
                                      const ImageLimits& limits) {
  const GdalMessages messages;
  const MemoryDataset memory(bytes, messages, where);
  auto dataset = memory.checked(limits);
  if (!dataset) {
    return tl::make_unexpected(std::move(dataset.error()));
  }
  const int width = (*dataset)->GetRasterXSize();
  const int height = (*dataset)->GetRasterYSize();
  const int bands = (*dataset)->GetRasterCount();
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  const bool isWide = (*dataset)->GetRasterBand(1)->GetRasterDataType() == GDT_UInt16;
  DecodedImage image{{width, height, ByteVector(4 * pixels, 255)}, bands == 2 || bands >= 4};
  // Where each of R, G, B, A comes from: grey serves all three.
  const bool isColour = bands >= 3;
  const std::array<int, 4> sources{1, isColour ? 2 : 1, isColour ? 3 : 1, bands == 2 ? 2 : bands >= 4 ? 4 : 0};
  std::vector<std::uint16_t> wide(isWide ? pixels : 0);
  for (std::size_t channel = 0; channel < sources.size(); ++channel) {
    if (sources[channel] == 0) {
      continue;
    }
    GDALRasterBand& band = *(*dataset)->GetRasterBand(sources[channel]);
    void* target = isWide ? static_cast<void*>(wide.data()) : image.tile.rgba.data() + channel;
    const GSpacing pixel = isWide ? 2 : 4;
    if (band.RasterIO(GF_Read, 0, 0, width, height, target, width, height, isWide ? GDT_UInt16 : GDT_Byte, pixel,
                      pixel * width, nullptr) != CE_None ||
        messages.hasError()) {
      return messages.failure("the image is damaged", where);
    }
    for (std::size_t i = 0; i < wide.size(); ++i) {
      image.tile.rgba[4 * i + channel] = static_cast<std::uint8_t>((wide[i] * 255U + 32767U) / 65535U);
    }
  }
  const GDALColorTable* palette = (*dataset)->GetRasterBand(1)->GetColorTable();
  if (bands == 1 && palette != nullptr && !isWide) {
    applyPalette(*palette, image);
  }
  return image;
}

TileResult<DecodedValues> valuesByGdal(std::span<const std::uint8_t> bytes, const std::string& where,
                                       const ImageLimits& limits) {
  const GdalMessages messages;
  const MemoryDataset memory(bytes, messages, where);
  auto dataset = memory.checked(limits);
  if (!dataset) {
    return tl::make_unexpected(std::move(dataset.error()));
  }
  GDALRasterBand& band = *(*dataset)->GetRasterBand(1);
  DecodedValues result;
  result.width = (*dataset)->GetRasterXSize();
  result.height = (*dataset)->GetRasterYSize();
  result.values.resize(static_cast<std::size_t>(result.width) * static_cast<std::size_t>(result.height));
  result.scale = band.GetScale();
  result.offset = band.GetOffset();
  std::vector<std::uint8_t> mask(result.values.size(), 255);
  const bool isRead = band.RasterIO(GF_Read, 0, 0, result.width, result.height, result.values.data(), result.width,
                                    result.height, GDT_Float32, 0, 0, nullptr) == CE_None;
  const bool hasMask = (band.GetMaskFlags() & GMF_ALL_VALID) == 0;
  const bool isMaskRead =
      !hasMask || band.GetMaskBand()->RasterIO(GF_Read, 0, 0, result.width, result.height, mask.data(), result.width,
                                               result.height, GDT_Byte, 0, 0, nullptr) == CE_None;
  if (!isRead || !isMaskRead || messages.hasError()) {
    return messages.failure("the image is damaged", where);
  }
  for (std::size_t i = 0; i < mask.size(); ++i) {
    result.values[i] = mask[i] == 0 ? nothing : result.values[i];
  }
  return result;
}

}  // namespace meridian::globebrowsing
