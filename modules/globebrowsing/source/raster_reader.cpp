#include "globebrowsing/source/raster_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include "globebrowsing/source/gdal_runtime.h"

namespace meridian::globebrowsing {

namespace {

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
  const char* sign = band.GetMetadataItem("PIXELTYPE", "IMAGE_STRUCTURE");
  rule.isSignedByte = type == GDT_Byte && sign != nullptr && EQUAL(sign, "SIGNEDBYTE");
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
  rule.limits = description.heightLimits;
  return rule;
}

namespace {

/// The bands of one overview, read pixel by pixel of the request into buffers.
class BandReader {
 public:
  BandReader(GDALDataset& dataset, const ReadRequest& request) : dataset_(dataset), request_(request) {}

  [[nodiscard]] GDALRasterBand* band(int number) const {
    GDALRasterBand* full = dataset_.GetRasterBand(number);
    return request_.overview < 0 || full == nullptr ? full : full->GetOverview(request_.overview);
  }
  [[nodiscard]] GDALRasterBand* mask(int number) const {
    GDALRasterBand* of = band(number);
    return of != nullptr ? of->GetMaskBand() : nullptr;
  }
  /// pixelBytes: from one pixel to the next in `into`.
  [[nodiscard]] bool read(GDALRasterBand* from, void* into, GDALDataType type, int pixelBytes) const {
    const PixelWindow& window = request_.window;
    return from != nullptr && from->RasterIO(GF_Read, window.x, window.y, window.width, window.height, into,
                                             request_.columns(), request_.rows(), type, pixelBytes,
                                             GSpacing{pixelBytes} * request_.columns(), nullptr) == CE_None;
  }
  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(request_.columns()) * static_cast<std::size_t>(request_.rows());
  }

 private:
  GDALDataset& dataset_;
  const ReadRequest& request_;
};

tl::unexpected<Error> cannotRead(const GdalMessages& messages, const std::string& where) {
  return messages.failure("the raster cannot be read", where, "check that the file is complete");
}

/// Bytes as they are; alpha 0 where all bands have their nodata value.
bool readBytes(GDALDataset& dataset, const ColourRule& rule, const ReadRequest& request, Rgba* out) {
  const BandReader reader(dataset, request);
  const std::size_t count = reader.count();
  const std::size_t channels = rule.isGrey() ? 1 : 3;
  if (channels == 3 && request.overview < 0) {
    // All at once: pixel-interleaved files are then decoded once.
    std::array<int, 3> bands = rule.bands;
    const PixelWindow& window = request.window;
    if (dataset.RasterIO(GF_Read, window.x, window.y, window.width, window.height, out->data(), request.columns(),
                         request.rows(), GDT_Byte, 3, bands.data(), 4, GSpacing{4} * request.columns(), 1,
                         nullptr) != CE_None) {
      return false;
    }
  } else {
    for (std::size_t c = 0; c < channels; ++c) {
      if (!reader.read(reader.band(rule.bands[c]), out->data() + c, GDT_Byte, 4)) {
        return false;
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (channels == 1) {
      out[i][1] = out[i][2] = out[i][0];
    }
    bool isAbsent = true;
    for (std::size_t c = 0; c < channels; ++c) {
      isAbsent = isAbsent && rule.noData[c] && out[i][c] == *rule.noData[c];
    }
    out[i][3] = isAbsent ? 0 : 255;
  }
  return true;
}

/// Values by the palette or by their range; alpha as above.
bool readValues(GDALDataset& dataset, const ColourRule& rule, const ReadRequest& request, Rgba* out) {
  const BandReader reader(dataset, request);
  const std::size_t channels = rule.isGrey() ? 1 : 3;
  std::vector<double> values(reader.count());
  std::fill(out, out + values.size(), Rgba{});
  for (std::size_t c = 0; c < channels; ++c) {
    if (!reader.read(reader.band(rule.bands[c]), values.data(), GDT_Float64, 8)) {
      return false;
    }
    const std::optional<double>& noData = rule.noData[c];
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double value = values[i];
      // A nodata value of a float raster may be written in the file as a double next to it.
      if (std::isnan(value) ||
          (noData && (value == *noData || static_cast<float>(value) == static_cast<float>(*noData)))) {
        continue;
      }
      if (!rule.palette.empty()) {
        const bool isKnown = value >= 0 && value < static_cast<double>(rule.palette.size());
        out[i] = isKnown ? rule.palette[static_cast<std::size_t>(value)] : Rgba{};
        continue;
      }
      out[i][c] =
          static_cast<std::uint8_t>(std::lround(std::clamp(value * rule.scale[c] + rule.offset[c], 0.0, 255.0)));
      out[i][3] = 255;
      if (channels == 1) {
        out[i][1] = out[i][2] = out[i][0];
      }
    }
  }
  return true;
}

bool readAlpha(GDALDataset& dataset, const ColourRule& rule, const ReadRequest& request, Rgba* out) {
  if (rule.alphaBand == 0 && !rule.hasMask) {
    return true;
  }
  const BandReader reader(dataset, request);
  GDALRasterBand* alpha = rule.hasMask ? reader.mask(rule.bands[0]) : reader.band(rule.alphaBand);
  std::vector<double> values(reader.count());
  if (!reader.read(alpha, values.data(), GDT_Float64, 8)) {
    return false;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = rule.hasMask ? (values[i] != 0 ? 255.0 : 0.0) : values[i] * rule.scale[3] + rule.offset[3];
    out[i][3] = std::min(out[i][3], static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0))));
  }
  return true;
}

}  // namespace

Result<void> readPixels(GDALDataset& dataset, const ColourRule& rule, const ReadRequest& request, Rgba* out,
                        const std::string& where, ReadNotes& notes) {
  const GdalMessages messages;
  const bool isDirect = rule.isByte && rule.palette.empty();
  const bool isRead = isDirect ? readBytes(dataset, rule, request, out) : readValues(dataset, rule, request, out);
  if (!isRead || !readAlpha(dataset, rule, request, out)) {
    return cannotRead(messages, where);
  }
  notes.warning = messages.warning();
  return {};
}

Result<void> readPixels(GDALDataset& dataset, const HeightRule& rule, const ReadRequest& request, float* out,
                        const std::string& where, ReadNotes& notes) {
  const GdalMessages messages;
  const BandReader reader(dataset, request);
  const std::size_t count = reader.count();
  constexpr float none = std::numeric_limits<float>::quiet_NaN();
  if (rule.isWide) {
    std::vector<double> values(count);
    if (!reader.read(reader.band(1), values.data(), GDT_Float64, 8)) {
      return cannotRead(messages, where);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const bool isAbsent = !std::isfinite(values[i]) || (rule.noData && values[i] == *rule.noData);
      out[i] = isAbsent ? none : static_cast<float>(values[i] * rule.scale + rule.offset);
    }
  } else {
    if (!reader.read(reader.band(1), out, GDT_Float32, 4)) {
      return cannotRead(messages, where);
    }
    const float noData = rule.noData ? static_cast<float>(*rule.noData) : none;
    for (std::size_t i = 0; i < count; ++i) {
      const float value = rule.isSignedByte && out[i] > 127.0F ? out[i] - 256.0F : out[i];
      const bool isAbsent = !std::isfinite(value) || value == noData;
      out[i] = isAbsent ? none : static_cast<float>(value * rule.scale + rule.offset);
    }
  }
  if (rule.hasMask) {
    std::vector<std::uint8_t> mask(count);
    if (!reader.read(reader.mask(1), mask.data(), GDT_Byte, 1)) {
      return cannotRead(messages, where);
    }
    for (std::size_t i = 0; i < count; ++i) {
      out[i] = mask[i] != 0 ? out[i] : none;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isnan(out[i]) && !rule.limits.hold(out[i])) {
      notes.implausible = notes.implausible.value_or(out[i]);
      out[i] = none;
    }
  }
  notes.warning = messages.warning();
  return {};
}

}  // namespace meridian::globebrowsing
