#include <algorithm>
#include <cmath>
#include <vector>

#include "globebrowsing/source/resample_parts.h"

namespace meridian::globebrowsing {

namespace {

constexpr std::int64_t mostPixels = std::int64_t{1} << 21U;  // of a window read at once

/// The part of the level that some samples need, in memory.
template <class Pixel>
struct Patch {
  PixelWindow window;
  std::vector<Pixel> pixels;
  [[nodiscard]] const Pixel* at(int x, int y) const {
    return pixels.data() + static_cast<std::ptrdiff_t>(y - window.y) * window.width + (x - window.x);
  }
};

Taps tapsFor(const Rgba*, double centre, double stretch) {
  return triangleTaps(centre, stretch);
}
Taps tapsFor(const float*, double centre, double stretch) {
  return cubicTaps(centre, stretch);
}

struct Centre {
  double x = 0.0;
  double y = 0.0;
  int shift = 0;  ///< columns that a sample on the far side of the raster's seam moves by
};

void evaluate(const Patch<Rgba>& patch, const Sampling& sampling, const Centre& centre, Rgba& out) {
  const Taps across = triangleTaps(centre.x, sampling.stretchX);
  const Taps down = triangleTaps(centre.y, sampling.stretchY);
  ColourSum sum;
  for (int r = 0; r < down.count; ++r) {
    const Rgba* pixel = patch.at(across.first + centre.shift, down.first + r);
    const auto weightY = static_cast<float>(down.weight[static_cast<std::size_t>(r)]);
    for (int c = 0; c < across.count; ++c, ++pixel) {
      const auto weight = weightY * static_cast<float>(across.weight[static_cast<std::size_t>(c)]);
      const float present = weight * static_cast<float>((*pixel)[3]) * (1.0F / 255.0F);
      sum.red += present * static_cast<float>((*pixel)[0]);
      sum.green += present * static_cast<float>((*pixel)[1]);
      sum.blue += present * static_cast<float>((*pixel)[2]);
      sum.alpha += present;
    }
  }
  out = toRgba(sum);
}

void evaluate(const Patch<float>& patch, const Sampling& sampling, const Centre& centre, float& out) {
  const auto weigh = [&](const Taps& across, const Taps& down, auto add) {
    for (int r = 0; r < down.count; ++r) {
      const float* pixel = patch.at(across.first + centre.shift, down.first + r);
      for (int c = 0; c < across.count; ++c) {
        add(down.weight[static_cast<std::size_t>(r)] * across.weight[static_cast<std::size_t>(c)], pixel[c]);
      }
    }
  };
  double sum = 0.0;
  weigh(cubicTaps(centre.x, sampling.stretchX), cubicTaps(centre.y, sampling.stretchY),
        [&sum](double weight, float metres) { sum += weight * metres; });
  if (!std::isnan(sum)) {
    out = static_cast<float>(sum);
    return;
  }
  double present = 0.0;
  sum = 0.0;
  weigh(triangleTaps(centre.x, sampling.stretchX), triangleTaps(centre.y, sampling.stretchY),
        [&](double weight, float metres) {
          if (!std::isnan(metres)) {
            sum += weight * metres;
            present += weight;
          }
        });
  out = present >= leastPresent ? static_cast<float>(sum / present) : noHeight;
}

template <class Pixel>
Result<void> sample(PixelReader& reader, const Sampling& sampling, std::span<const double> columns,
                    std::span<const double> rows, Pixel* out, const std::stop_token& stop) {
  const Pyramid& pyramid = reader.pyramid();
  const PyramidLevel& level = pyramid.levels[sampling.level];
  const int turn = pyramid.columnsOfTurn(level);
  const int fullTurn = pyramid.georeference.columnsOfTurn();
  const int width = pyramid.georeference.width();
  const int height = pyramid.georeference.height();
  std::vector<Centre> centres(columns.size());
  std::vector<std::uint8_t> inside(columns.size(), 0);
  double seam = std::numeric_limits<double>::quiet_NaN();
  int x0 = std::numeric_limits<int>::max();
  int y0 = x0;
  int x1 = std::numeric_limits<int>::min();
  int y1 = x1;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!isWithin(rows[i], height) || (turn == 0 && !isWithin(columns[i], width))) {
      continue;
    }
    inside[i] = 1;
    seam = std::isnan(seam) ? columns[i] : seam;
    Centre& centre = centres[i];
    centre.x = level.centreX(columns[i]);
    centre.y = level.centreY(rows[i]);
    if (turn > 0 && std::abs(columns[i] - seam) > fullTurn / 2.0) {
      centre.shift = columns[i] > seam ? -turn : turn;
    }
    // A fallback's triangle lies within the cubic.
    const Taps across = tapsFor(out, centre.x, sampling.stretchX);
    const Taps down = tapsFor(out, centre.y, sampling.stretchY);
    if (reader.isPlan()) {
      auto noted =
          reader.fetch(sampling.level, {across.first + centre.shift, down.first, across.count, down.count}, out, stop);
      if (!noted) {
        return noted;
      }
      continue;
    }
    const int spare = static_cast<int>(std::ceil(std::max(sampling.stretchX, sampling.stretchY)));
    x0 = std::min(x0, std::min(across.first, static_cast<int>(std::floor(centre.x)) - spare) + centre.shift);
    x1 = std::max(
        x1, std::max(across.first + across.count, static_cast<int>(std::floor(centre.x)) + spare + 2) + centre.shift);
    y0 = std::min(y0, std::min(down.first, static_cast<int>(std::floor(centre.y)) - spare));
    y1 = std::max(y1, std::max(down.first + down.count, static_cast<int>(std::floor(centre.y)) + spare + 2));
  }
  if (x1 < x0) {
    return {};
  }
  if (std::int64_t{x1 - x0} * (y1 - y0) > mostPixels && columns.size() > 1) {
    const std::size_t half = columns.size() / 2;
    auto done = sample(reader, sampling, columns.first(half), rows.first(half), out, stop);
    return done ? sample(reader, sampling, columns.subspan(half), rows.subspan(half),
                         out + static_cast<std::ptrdiff_t>(half), stop)
                : done;
  }
  Patch<Pixel> patch{{x0, y0, x1 - x0, y1 - y0}, {}};
  patch.pixels.resize(static_cast<std::size_t>(x1 - x0) * static_cast<std::size_t>(y1 - y0));
  if (auto done = reader.fetch(sampling.level, patch.window, patch.pixels.data(), stop); !done) {
    return done;
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (inside[i] != 0) {
      evaluate(patch, sampling, centres[i], out[i]);
    }
  }
  return {};
}

}  // namespace

Result<void> samplePoints(PixelReader& reader, const Sampling& sampling, std::span<const double> columns,
                          std::span<const double> rows, Rgba* out, const std::stop_token& stop) {
  return sample(reader, sampling, columns, rows, out, stop);
}

Result<void> samplePoints(PixelReader& reader, const Sampling& sampling, std::span<const double> columns,
                          std::span<const double> rows, float* out, const std::stop_token& stop) {
  return sample(reader, sampling, columns, rows, out, stop);
}

}  // namespace meridian::globebrowsing
