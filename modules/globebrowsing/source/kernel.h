#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace meridian::globebrowsing {

/// The pixels of one line that a sample is made of, and their weights, which add up to 1.
struct Taps {
  static constexpr int most = 40;
  int first = 0;
  int count = 0;
  std::array<double, most> weight;
};

/// Kernels are no wider than this many times their natural width; beyond it they leave pixels out.
inline constexpr double widestTriangle = 16.0;
inline constexpr double widestCubic = 8.0;

/// 1 at 0, 0 from 1 on.
[[nodiscard]] inline double triangle(double distance) {
  return std::max(0.0, 1.0 - std::abs(distance));
}

/// Keys 1981 (Cubic convolution interpolation for digital image processing), a = -1/2: exact for parabolas.
[[nodiscard]] inline double cubic(double distance) {
  const double d = std::abs(distance);
  return d < 1.0 ? (1.5 * d - 2.5) * d * d + 1.0 : d < 2.0 ? ((-0.5 * d + 2.5) * d - 4.0) * d + 2.0 : 0.0;
}

/// Of a sample at `centre` (pixel i is centred on i), the kernel being `stretch` (at least 1) times as wide as for
/// interpolation. Weights below rounding are left out, so that a sample on a pixel's centre asks for that pixel alone.
template <class Kernel>
[[nodiscard]] Taps makeTaps(double centre, double stretch, double support, Kernel kernel) {
  Taps taps;
  const double reach = stretch * support;
  int first = static_cast<int>(std::ceil(centre - reach));
  int last = std::min(static_cast<int>(std::floor(centre + reach)), first + Taps::most - 1);
  constexpr double negligible = 1e-9;
  while (first < last && std::abs(kernel((first - centre) / stretch)) < negligible) {
    ++first;
  }
  while (last > first && std::abs(kernel((last - centre) / stretch)) < negligible) {
    --last;
  }
  taps.first = first;
  taps.count = last - first + 1;
  double sum = 0.0;
  for (int i = 0; i < taps.count; ++i) {
    const double weight = kernel((first + i - centre) / stretch);
    taps.weight[static_cast<std::size_t>(i)] = weight;
    sum += weight;
  }
  for (int i = 0; i < taps.count; ++i) {
    taps.weight[static_cast<std::size_t>(i)] /= sum;
  }
  return taps;
}

[[nodiscard]] inline Taps triangleTaps(double centre, double stretch) {
  return makeTaps(centre, std::clamp(stretch, 1.0, widestTriangle), 1.0, triangle);
}
[[nodiscard]] inline Taps cubicTaps(double centre, double stretch) {
  return makeTaps(centre, std::clamp(stretch, 1.0, widestCubic), 2.0, cubic);
}

}  // namespace meridian::globebrowsing
