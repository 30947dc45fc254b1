#include "globebrowsing/source/resample.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "globebrowsing/source/resample_parts.h"

namespace meridian::globebrowsing {

double nominalSpacing(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) {
  // A root's height, halved with every level: taken from the root, so that rounding is the same for all tiles.
  const auto direction = [&tiling](double v) {
    const GeodeticPosition place = tiling.geodetic(TileIndex{}, {0.5, v});
    return glm::dvec3(std::cos(place.latitude) * std::cos(place.longitude),
                      std::cos(place.latitude) * std::sin(place.longitude), std::sin(place.latitude));
  };
  const glm::dvec3 top = direction(0.0);
  const glm::dvec3 middle = direction(0.5);
  const double half = std::acos(std::clamp(top.x * middle.x + top.y * middle.y + top.z * middle.z, -1.0, 1.0));
  return std::ldexp(2.0 * half * layout.spacing(), -int{index.level});
}

Sampling chooseSampling(const RasterAccess& access, double spacing, double columnSpacing) {
  const RasterGeoreference& georeference = access.georeference();
  const std::vector<RasterLevel>& levels = access.levels();
  const double ratioX = spacing / georeference.pixelWidthAngle();
  const double ratioY = spacing / georeference.pixelHeightAngle();
  Sampling sampling;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    constexpr double rounding = 1.0 + 1e-9;
    if (levels[i].scaleY <= ratioY * rounding && levels[i].scaleX <= ratioX * rounding) {
      sampling.level = i;
    }
  }
  const RasterLevel& level = levels[sampling.level];
  const double wider = std::max(spacing, columnSpacing) / spacing;
  sampling.stretchX = std::max(1.0, ratioX * wider / level.scaleX);
  sampling.stretchY = std::max(1.0, ratioY / level.scaleY);
  return sampling;
}

Rgba toRgba(const ColourSum& sum) {
  if (!(sum.alpha > 0.0F)) {
    return {};
  }
  const auto byte = [](float value) { return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F)); };
  const float scale = 1.0F / sum.alpha;
  return {byte(sum.red * scale), byte(sum.green * scale), byte(sum.blue * scale), byte(sum.alpha * 255.0F)};
}

namespace {

/// Any tile from any raster: every sample's place through the CRS.
template <class Pixel>
Result<void> sampleTile(const RasterAccess& access, RasterHandle& handle, const TileRequest& tile, Pixel* out,
                        const std::stop_token& stop) {
  if (access.georeference().isGeographic() && tile.tiling.isSeparable()) {
    return sampleRows(access, handle, tile, out, stop);
  }
  const double spacing = nominalSpacing(tile.tiling, tile.index, tile.layout);
  const Sampling sampling = chooseSampling(access, spacing, spacing);
  const int size = tile.layout.size();
  constexpr int rowsAtOnce = 32;
  std::vector<double> x;
  std::vector<double> y;
  for (int first = 0; first < size; first += rowsAtOnce) {
    if (stop.stop_requested()) {
      return failure("cancelled", access.where());
    }
    const int rows = std::min(rowsAtOnce, size - first);
    x.clear();
    y.clear();
    for (int r = first; r < first + rows; ++r) {
      for (int c = 0; c < size; ++c) {
        const GeodeticPosition place = tile.tiling.geodetic(tile.index, tile.layout.uv(c, r));
        const bool isPole = std::abs(place.latitude) >= std::numbers::pi / 2 - 1e-12;
        x.push_back(isPole ? 0.0 : place.longitude);
        y.push_back(place.latitude);
      }
    }
    access.georeference().toPixels(handle.projection(), x, y);
    auto done = samplePoints(access, handle, sampling, x, y, out + static_cast<std::ptrdiff_t>(first) * size, stop);
    if (!done) {
      return done;
    }
  }
  return {};
}

template <class Pixel>
Result<bool> fill(const RasterSource& source, const TileRequest& tile, std::vector<Pixel>& pixels, Pixel empty,
                  const std::stop_token& stop) {
  const RasterAccess& access = source.access();
  if (!source.overlaps(tile.tiling, tile.index)) {
    return false;
  }
  if (stop.stop_requested()) {
    return failure("cancelled", access.where());
  }
  const auto handle = access.borrow();
  if (!handle) {
    return tl::make_unexpected(handle.error());
  }
  const auto size = static_cast<std::size_t>(tile.layout.size());
  pixels.assign(size * size, empty);
  if (auto done = sampleTile(access, **handle, tile, pixels.data(), stop); !done) {
    return tl::make_unexpected(done.error());
  }
  return true;
}

}  // namespace

Result<ColourPixels> resampleColours(const RasterSource& source, const Tiling& tiling, const TileIndex& index,
                                     const TileLayout& layout, std::stop_token stop) {
  ColourPixels result;
  result.size = layout.size();
  std::vector<Rgba> pixels;
  const auto filled = fill(source, {tiling, index, layout}, pixels, Rgba{}, stop);
  if (!filled) {
    return tl::make_unexpected(filled.error());
  }
  result.allOpaque = *filled;
  for (const Rgba& pixel : pixels) {
    result.anyOpaque = result.anyOpaque || pixel[3] > 0;
    result.allOpaque = result.allOpaque && pixel[3] == 255;
  }
  if (result.anyOpaque) {
    result.rgba.resize(pixels.size() * sizeof(Rgba));
    std::memcpy(result.rgba.data(), pixels.data(), result.rgba.size());
  }
  return result;
}

Result<HeightPixels> resampleHeights(const RasterSource& source, const Tiling& tiling, const TileIndex& index,
                                     const TileLayout& layout, std::stop_token stop) {
  HeightPixels result;
  result.size = layout.size();
  const auto filled = fill(source, {tiling, index, layout}, result.metres, noHeight, stop);
  if (!filled) {
    return tl::make_unexpected(filled.error());
  }
  for (const float metres : result.metres) {
    if (!std::isnan(metres)) {
      result.minimum = result.any ? std::min(result.minimum, metres) : metres;
      result.maximum = result.any ? std::max(result.maximum, metres) : metres;
      result.any = true;
    }
  }
  if (!result.any) {
    result.metres.clear();
  }
  return result;
}

}  // namespace meridian::globebrowsing
