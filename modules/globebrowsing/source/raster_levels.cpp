#include "globebrowsing/source/raster_levels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <gdal_priv.h>

namespace meridian::globebrowsing {

namespace {

constexpr int coarsestSide = 32;  // no tile is coarser than a hemisphere in a hundred samples

int ceilDivide(int a, int b) {
  return a / b + (a % b != 0 ? 1 : 0);
}

/// Calls block(columns, rows, first pixel, to's pixel) for each block.
template <class Pixel, class Block>
void forEachBlock(const Pixel* from, int width, int height, int factor, Pixel* to, Block block) {
  for (int y = 0; y < height; y += factor) {
    const int rows = std::min(factor, height - y);
    for (int x = 0; x < width; x += factor) {
      *to++ = block(std::min(factor, width - x), rows, from + static_cast<std::ptrdiff_t>(y) * width + x);
    }
  }
}

}  // namespace

std::vector<RasterLevel> rasterLevels(GDALDataset& dataset) {
  const int width = dataset.GetRasterXSize();
  const int height = dataset.GetRasterYSize();
  GDALRasterBand& band = *dataset.GetRasterBand(1);
  std::vector<RasterLevel> levels{{width, height}};
  for (int i = 0; i < band.GetOverviewCount(); ++i) {
    GDALRasterBand* overview = band.GetOverview(i);
    if (overview == nullptr || overview->GetXSize() < 1 || overview->GetYSize() < 1) {
      continue;
    }
    bool inAllBands = true;
    for (int b = 2; b <= dataset.GetRasterCount(); ++b) {
      GDALRasterBand* other = dataset.GetRasterBand(b)->GetOverview(i);
      inAllBands = inAllBands && other != nullptr && other->GetXSize() == overview->GetXSize() &&
                   other->GetYSize() == overview->GetYSize();
    }
    if (inAllBands && overview->GetXSize() < width) {
      levels.push_back({overview->GetXSize(), overview->GetYSize(), double{1.0} * width / overview->GetXSize(),
                        double{1.0} * height / overview->GetYSize(), i, 1});
    }
  }
  std::sort(levels.begin(), levels.end(), [](const auto& a, const auto& b) { return a.width > b.width; });
  const RasterLevel native = levels.back();
  for (int factor = 2;
       factor < (1 << 24) && (native.width / factor > coarsestSide || native.height / factor > coarsestSide);
       factor *= 2) {
    levels.push_back({ceilDivide(native.width, factor), ceilDivide(native.height, factor), native.scaleX * factor,
                      native.scaleY * factor, native.overview, factor});
  }
  return levels;
}

void reduce(const Rgba* from, int width, int height, int factor, Rgba* to) {
  forEachBlock(from, width, height, factor, to, [width](int columns, int rows, const Rgba* first) {
    std::array<std::uint64_t, 4> sum{};
    for (int y = 0; y < rows; ++y) {
      const Rgba* pixel = first + static_cast<std::ptrdiff_t>(y) * width;
      for (int x = 0; x < columns; ++x, ++pixel) {
        const std::uint64_t alpha = (*pixel)[3];
        sum[0] += alpha * (*pixel)[0];
        sum[1] += alpha * (*pixel)[1];
        sum[2] += alpha * (*pixel)[2];
        sum[3] += alpha;
      }
    }
    if (sum[3] == 0) {
      return Rgba{};
    }
    const std::uint64_t pixels = static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows);
    const auto mean = [](std::uint64_t total, std::uint64_t count) {
      return static_cast<std::uint8_t>((total + count / 2) / count);
    };
    return Rgba{mean(sum[0], sum[3]), mean(sum[1], sum[3]), mean(sum[2], sum[3]), mean(sum[3], pixels)};
  });
}

void reduce(const float* from, int width, int height, int factor, float* to) {
  forEachBlock(from, width, height, factor, to, [width](int columns, int rows, const float* first) {
    double sum = 0.0;
    int count = 0;
    for (int y = 0; y < rows; ++y) {
      const float* pixel = first + static_cast<std::ptrdiff_t>(y) * width;
      for (int x = 0; x < columns; ++x, ++pixel) {
        if (!std::isnan(*pixel)) {
          sum += *pixel;
          ++count;
        }
      }
    }
    return count > 0 ? static_cast<float>(sum / count) : std::numeric_limits<float>::quiet_NaN();
  });
}

}  // namespace meridian::globebrowsing
