#include "globebrowsing/source/resample.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <fmt/format.h>

#include "globebrowsing/source/polar_heights.h"
#include "globebrowsing/source/raster_access.h"
#include "globebrowsing/source/resample_parts.h"

namespace meridian::globebrowsing {

Error implausibleHeight(double metres, const HeightLimits& limits, const std::string& where) {
  return {fmt::format("a height of {:.6g} m is taken for no data, as are all that are not between {:.6g} and {:.6g} m "
                      "on this body",
                      metres, limits.least, limits.greatest),
          where, "declare the raster's nodata value, or set HeightScale, HeightOffset or HeightDatum"};
}

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

Rgba toRgba(const ColourSum& sum) {
  if (!(sum.alpha > 0.0F)) {
    return {};
  }
  const auto byte = [](float value) { return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F)); };
  const float scale = 1.0F / sum.alpha;
  return {byte(sum.red * scale), byte(sum.green * scale), byte(sum.blue * scale), byte(sum.alpha * 255.0F)};
}

namespace {

/// Points of a picture whose level is chosen by place: those of one sampling after those of another.
template <class Pixel>
Result<void> samplePlaces(PixelReader& reader, const SampleSpacing& spacing, std::span<const double> columns,
                          std::span<const double> rows, Pixel* out, const std::stop_token& stop) {
  std::vector<std::size_t> left;
  std::vector<Sampling> samplings(columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (std::isfinite(columns[i]) && std::isfinite(rows[i])) {
      samplings[i] = chooseSampling(reader.pyramid(), spacing, columns[i], rows[i]);
      left.push_back(i);
    }
  }
  while (!left.empty()) {
    const Sampling sampling = samplings[left.front()];
    const auto others =
        std::stable_partition(left.begin(), left.end(), [&](std::size_t i) { return samplings[i] == sampling; });
    const std::vector<std::size_t> chosen(left.begin(), others);
    left.erase(left.begin(), others);
    std::vector<double> x;
    std::vector<double> y;
    std::vector<Pixel> pixels;
    for (const std::size_t i : chosen) {
      x.push_back(columns[i]);
      y.push_back(rows[i]);
      if (out != nullptr) {
        pixels.push_back(out[i]);
      }
    }
    auto done = samplePoints(reader, sampling, x, y, out != nullptr ? pixels.data() : nullptr, stop);
    if (!done) {
      return done;
    }
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      out[chosen[i]] = pixels[i];
    }
  }
  return {};
}

/// Every sample's place through the CRS.
template <class Pixel>
Result<void> sampleThroughCrs(PixelReader& reader, const TileRequest& tile, Pixel* out, const std::stop_token& stop) {
  const Pyramid& pyramid = reader.pyramid();
  const SampleSpacing spacing{nominalSpacing(tile.tiling, tile.index, tile.layout)};
  const int size = tile.layout.size();
  constexpr int rowsAtOnce = 32;
  std::vector<double> x;
  std::vector<double> y;
  for (int first = 0; first < size; first += rowsAtOnce) {
    if (stop.stop_requested()) {
      return failure("cancelled", pyramid.where);
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
    pyramid.georeference.toPixels(reader.projection(), x, y);
    Pixel* target = out != nullptr ? out + static_cast<std::ptrdiff_t>(first) * size : nullptr;
    auto done = pyramid.isChosenByPlace ? samplePlaces(reader, spacing, x, y, target, stop)
                                        : samplePoints(reader, chooseSampling(pyramid, spacing), x, y, target, stop);
    if (!done) {
      return done;
    }
  }
  return {};
}

template <class Pixel>
Result<void> sampleAny(PixelReader& reader, const TileRequest& tile, Pixel* out, const std::stop_token& stop) {
  return reader.pyramid().georeference.isGeographic() && tile.tiling.isSeparable()
             ? sampleRows(reader, tile, out, stop)
             : sampleThroughCrs(reader, tile, out, stop);
}

/// `make` of a reader that the tile needs; an empty tile without overlap.
template <class Pixels, class Make>
Result<Pixels> resample(const RasterSource& source, const TileRequest& tile, const std::stop_token& stop, Make make) {
  if (!source.overlaps(tile.tiling, tile.index)) {
    return Pixels{tile.layout.size()};
  }
  if (stop.stop_requested()) {
    return failure("cancelled", source.access().pyramid().where);
  }
  return source.access().reader().and_then(
      [&](const std::unique_ptr<PixelReader>& reader) { return make(*reader, tile, stop); });
}

}  // namespace

Result<void> sampleTile(PixelReader& reader, const TileRequest& tile, Rgba* out, const std::stop_token& stop) {
  return sampleAny(reader, tile, out, stop);
}

Result<void> sampleTile(PixelReader& reader, const TileRequest& tile, float* out, const std::stop_token& stop) {
  if (!PolarHeights::concerns(reader.pyramid())) {
    return sampleAny(reader, tile, out, stop);
  }
  PolarHeights smoothed(reader);
  return sampleAny(smoothed, tile, out, stop);
}

Result<ColourPixels> readColours(PixelReader& reader, const TileRequest& tile, const std::stop_token& stop) {
  ColourPixels result{tile.layout.size()};
  std::vector<Rgba> pixels(static_cast<std::size_t>(result.size) * static_cast<std::size_t>(result.size));
  if (auto done = sampleTile(reader, tile, pixels.data(), stop); !done) {
    return tl::make_unexpected(done.error());
  }
  result.allOpaque = true;
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

Result<HeightPixels> readHeights(PixelReader& reader, const TileRequest& tile, const std::stop_token& stop) {
  HeightPixels result{tile.layout.size()};
  result.metres.assign(static_cast<std::size_t>(result.size) * static_cast<std::size_t>(result.size), noHeight);
  if (auto done = sampleTile(reader, tile, result.metres.data(), stop); !done) {
    return tl::make_unexpected(done.error());
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

Result<ColourPixels> resampleColours(const RasterSource& source, const Tiling& tiling, const TileIndex& index,
                                     const TileLayout& layout, const std::stop_token& stop) {
  return resample<ColourPixels>(source, {tiling, index, layout}, stop, readColours);
}

Result<HeightPixels> resampleHeights(const RasterSource& source, const Tiling& tiling, const TileIndex& index,
                                     const TileLayout& layout, const std::stop_token& stop) {
  return resample<HeightPixels>(source, {tiling, index, layout}, stop, readHeights);
}

}  // namespace meridian::globebrowsing
