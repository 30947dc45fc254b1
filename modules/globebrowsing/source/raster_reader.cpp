#include "globebrowsing/source/raster_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "globebrowsing/source/gdal_runtime.h"

namespace meridian::globebrowsing {

namespace {

GDALRasterBand* bandAt(GDALDataset& dataset, int band, int overview) {
  GDALRasterBand* full = dataset.GetRasterBand(band);
  return overview < 0 || full == nullptr ? full : full->GetOverview(overview);
}

std::optional<double> noDataOf(GDALRasterBand& band) {
  int has = 0;
  const double value = band.GetNoDataValue(&has);
  return has != 0 ? std::optional(value) : std::nullopt;
}

/// A mask other than the nodata value, which is applied as the pixels are read.
bool hasOwnMask(GDALRasterBand& band) {
  return (band.GetMaskFlags() & (GMF_ALL_VALID | GMF_NODATA | GMF_ALPHA)) == 0;
}

/// The values that become 0 and 255.
std::optional<std::array<double, 2>> rangeOf(GDALRasterBand& band) {
  if (const char* bits = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE")) {
    const double n = std::atof(bits);
    if (n >= 1 && n <= 32) {
      return std::array{0.0, std::exp2(n) - 1};
    }
  }
  const char* least = band.GetMetadataItem("STATISTICS_MINIMUM");
  const char* greatest = band.GetMetadataItem("STATISTICS_MAXIMUM");
  if (least != nullptr && greatest != nullptr) {
    return std::array{std::atof(least), std::atof(greatest)};
  }
  if (band.GetRasterDataType() == GDT_UInt16) {
    return std::array{0.0, 65535.0};
  }
  std::array<double, 2> range{};
  if (band.ComputeRasterMinMax(TRUE, range.data()) != CE_None) {
    return std::nullopt;
  }
  return range;
}

void chooseBands(GDALDataset& dataset, ColourRule& rule) {
  const int count = dataset.GetRasterCount();
  std::array<int, 4> named{};
  for (int band = 1; band <= count; ++band) {
    switch (dataset.GetRasterBand(band)->GetColorInterpretation()) {
      case GCI_RedBand:
        named[0] = band;
        break;
      case GCI_GreenBand:
        named[1] = band;
        break;
      case GCI_BlueBand:
        named[2] = band;
        break;
      case GCI_AlphaBand:
        named[3] = band;
        break;
      default:
        break;
    }
  }
  rule.alphaBand = named[3];
  if (named[0] != 0 && named[1] != 0 && named[2] != 0) {
    rule.bands = {named[0], named[1], named[2]};
  } else if (count >= 3 && (named[3] == 0 || named[3] > 3)) {
    rule.bands = {1, 2, 3};
  } else {
    const int grey = named[3] == 1 && count > 1 ? 2 : 1;
    rule.bands = {grey, grey, grey};
  }
  if (rule.alphaBand == rule.bands[0]) {
    rule.alphaBand = 0;
  }
}

void readPalette(GDALRasterBand& band, ColourRule& rule) {
  const GDALColorTable* table = band.GetColorTable();
  if (table == nullptr || !rule.isGrey()) {
    return;
  }
  rule.palette.resize(static_cast<std::size_t>(std::clamp(table->GetColorEntryCount(), 0, 65536)));
  for (std::size_t i = 0; i < rule.palette.size(); ++i) {
    GDALColorEntry entry{};
    table->GetColorEntryAsRGB(static_cast<int>(i), &entry);
    const auto byte = [](short value) { return static_cast<std::uint8_t>(std::clamp<int>(value, 0, 255)); };
    rule.palette[i] = {byte(entry.c1), byte(entry.c2), byte(entry.c3), byte(entry.c4)};
  }
}

std::string lost(const GDALDataset& /*dataset*/) {
  return "the raster cannot be read";
}

}  // namespace

Result<ColourRule> colourRule(GDALDataset& dataset, const std::string& where) {
  GdalMessages messages;
  ColourRule rule;
  chooseBands(dataset, rule);
  GDALRasterBand& first = *dataset.GetRasterBand(rule.bands[0]);
  readPalette(first, rule);
  rule.hasMask = rule.alphaBand == 0 && hasOwnMask(first);
  for (std::size_t i = 0; i < 3; ++i) {
    GDALRasterBand& band = *dataset.GetRasterBand(rule.bands[i]);
    rule.noData[i] = noDataOf(band);
    rule.isByte = rule.isByte && band.GetRasterDataType() == GDT_Byte;
  }
  if (rule.isByte || !rule.palette.empty()) {
    return rule;
  }
  std::array<double, 2> common{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
  for (std::size_t i = 0; i < (rule.isGrey() ? 1U : 3U); ++i) {
    const auto range = rangeOf(*dataset.GetRasterBand(rule.bands[i]));
    if (!range) {
      return messages.failure("the range of the raster's values cannot be found", where);
    }
    common = {std::min(common[0], (*range)[0]), std::max(common[1], (*range)[1])};
  }
  // One range for all three, so that hues stay.
  const double scale = common[1] > common[0] ? 255.0 / (common[1] - common[0]) : 1.0;
  rule.scale = {scale, scale, scale, scale};
  rule.offset.fill(-common[0] * scale);
  if (rule.alphaBand != 0) {
    const GDALDataType type = dataset.GetRasterBand(rule.alphaBand)->GetRasterDataType();
    rule.scale[3] = type == GDT_Byte ? 1.0 : type == GDT_UInt16 ? 255.0 / 65535.0 : scale;
    rule.offset[3] = 0.0;
  }
  return rule;
}

HeightRule heightRule(GDALDataset& dataset, const RasterDescription& description) {
  GdalMessages messages;
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  HeightRule rule;
  rule.noData = noDataOf(band);
  rule.hasMask = hasOwnMask(band);
  const GDALDataType type = band.GetRasterDataType();
  rule.isWide = type != GDT_Byte && type != GDT_UInt16 && type != GDT_Int16 && type != GDT_Float32;
  double unit = 1.0;
  const std::string name = band.GetUnitType();
  if (EQUAL(name.c_str(), "km") || EQUAL(name.c_str(), "kilometers") || EQUAL(name.c_str(), "kilometres")) {
    unit = 1000.0;
  } else if (EQUAL(name.c_str(), "ft") || EQUAL(name.c_str(), "foot") || EQUAL(name.c_str(), "feet")) {
    unit = 0.3048;
  }
  rule.scale = description.heightScale.value_or(band.GetScale() * unit);
  rule.offset = description.heightOffset.value_or(band.GetOffset() * unit);
  double datum = 0.0;
  if (const OGRSpatialReference* crs = dataset.GetSpatialRef(); crs != nullptr && !description.heightOffset) {
    const double radius = crs->GetSemiMajor();
    datum = std::abs(rule.offset - radius) < 0.01 * radius ? radius : 0.0;
  }
  rule.offset -= description.heightDatum.value_or(datum);
  return rule;
}

Result<void> readPixels(GDALDataset& dataset, const ColourRule& rule, int overview, const PixelWindow& window,
                        Rgba* out, const std::string& where) {
  GdalMessages messages;
  const std::size_t count = static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
  const auto read = [&](GDALRasterBand* band, void* into, GDALDataType type, int pixelBytes) {
    return band != nullptr &&
           band->RasterIO(GF_Read, window.x, window.y, window.width, window.height, into, window.width, window.height,
                          type, pixelBytes, GSpacing{pixelBytes} * window.width, nullptr) == CE_None;
  };
  const bool isDirect = rule.isByte && rule.palette.empty();
  const std::size_t channels = rule.isGrey() ? 1 : 3;
  std::vector<std::uint8_t> absent(count, 1);
  std::vector<double> wide(isDirect ? 0 : count);
  if (isDirect && channels == 3 && overview < 0) {
    std::array<int, 3> bands = rule.bands;
    if (dataset.RasterIO(GF_Read, window.x, window.y, window.width, window.height, out->data(), window.width,
                         window.height, GDT_Byte, 3, bands.data(), 4, GSpacing{4} * window.width, 1,
                         nullptr) != CE_None) {
      return messages.failure(lost(dataset), where, "check that the file is complete");
    }
  }
  for (std::size_t c = 0; c < channels; ++c) {
    GDALRasterBand* band = bandAt(dataset, rule.bands[c], overview);
    const std::optional<double>& noData = rule.noData[c];
    if (isDirect) {
      if ((channels == 1 || overview >= 0) && !read(band, out->data() + c, GDT_Byte, 4)) {
        return messages.failure(lost(dataset), where, "check that the file is complete");
      }
      for (std::size_t i = 0; i < count; ++i) {
        absent[i] = static_cast<std::uint8_t>(absent[i] & (noData && out[i][c] == *noData ? 1U : 0U));
      }
      continue;
    }
    if (!read(band, wide.data(), GDT_Float64, 8)) {
      return messages.failure(lost(dataset), where, "check that the file is complete");
    }
    for (std::size_t i = 0; i < count; ++i) {
      const bool none = std::isnan(wide[i]) ||
                        (noData && (wide[i] == *noData || static_cast<float>(wide[i]) == static_cast<float>(*noData)));
      absent[i] = static_cast<std::uint8_t>(absent[i] & (none ? 1U : 0U));
      if (!rule.palette.empty()) {
        const bool known = wide[i] >= 0 && wide[i] < static_cast<double>(rule.palette.size());
        out[i] = known ? rule.palette[static_cast<std::size_t>(wide[i])] : Rgba{};
      } else {
        const double value = none ? 0.0 : std::clamp(wide[i] * rule.scale[c] + rule.offset[c], 0.0, 255.0);
        out[i][c] = static_cast<std::uint8_t>(std::lround(value));
      }
    }
  }
  if (rule.palette.empty()) {
    for (std::size_t i = 0; i < count; ++i) {
      if (channels == 1) {
        out[i][1] = out[i][2] = out[i][0];
      }
      out[i][3] = absent[i] != 0 ? 0 : 255;
    }
  } else {
    for (std::size_t i = 0; i < count; ++i) {
      out[i][3] = absent[i] != 0 ? 0 : out[i][3];
    }
  }
  GDALRasterBand* alpha = rule.alphaBand != 0 ? bandAt(dataset, rule.alphaBand, overview) : nullptr;
  if (rule.hasMask) {
    GDALRasterBand* band = bandAt(dataset, rule.bands[0], overview);
    alpha = band != nullptr ? band->GetMaskBand() : nullptr;
  }
  if (alpha != nullptr) {
    wide.resize(count);
    if (!read(alpha, wide.data(), GDT_Float64, 8)) {
      return messages.failure(lost(dataset), where, "check that the file is complete");
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double value = rule.hasMask ? (wide[i] != 0 ? 255.0 : 0.0) : wide[i] * rule.scale[3] + rule.offset[3];
      out[i][3] = std::min(out[i][3], static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0))));
    }
  }
  return {};
}

Result<void> readPixels(GDALDataset& dataset, const HeightRule& rule, int overview, const PixelWindow& window,
                        float* out, const std::string& where) {
  GdalMessages messages;
  const std::size_t count = static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
  GDALRasterBand* band = bandAt(dataset, 1, overview);
  const auto read = [&](GDALRasterBand* from, void* into, GDALDataType type) {
    return from != nullptr && from->RasterIO(GF_Read, window.x, window.y, window.width, window.height, into,
                                             window.width, window.height, type, 0, 0, nullptr) == CE_None;
  };
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  if (rule.isWide) {
    std::vector<double> wide(count);
    if (!read(band, wide.data(), GDT_Float64)) {
      return messages.failure(lost(dataset), where, "check that the file is complete");
    }
    for (std::size_t i = 0; i < count; ++i) {
      const bool absent = !std::isfinite(wide[i]) || (rule.noData && wide[i] == *rule.noData);
      out[i] = absent ? none : static_cast<float>(wide[i] * rule.scale + rule.offset);
    }
  } else {
    if (!read(band, out, GDT_Float32)) {
      return messages.failure(lost(dataset), where, "check that the file is complete");
    }
    const float noData = rule.noData ? static_cast<float>(*rule.noData) : none;
    for (std::size_t i = 0; i < count; ++i) {
      const bool absent = !std::isfinite(out[i]) || out[i] == noData;
      out[i] = absent ? none : static_cast<float>(out[i] * rule.scale + rule.offset);
    }
  }
  if (rule.hasMask) {
    std::vector<std::uint8_t> mask(count);
    if (!read(band->GetMaskBand(), mask.data(), GDT_Byte)) {
      return messages.failure(lost(dataset), where, "check that the file is complete");
    }
    for (std::size_t i = 0; i < count; ++i) {
      out[i] = mask[i] != 0 ? out[i] : none;
    }
  }
  return {};
}

}  // namespace meridian::globebrowsing
