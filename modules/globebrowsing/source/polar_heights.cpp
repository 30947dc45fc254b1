#include "globebrowsing/source/polar_heights.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace meridian::globebrowsing {

namespace {

/// Sums of sums of a row, which give the sum under any triangle at once. Whole numbers, and what overflows in sums of
/// sums is taken away again: so the answer does not depend on where the row begins, and tiles agree to the bit.
class TriangleSums {
 public:
  void assign(const std::vector<std::int64_t>& values) {
    sums_.assign(values.size() + 2, 0);
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      sum += static_cast<std::uint64_t>(values[i]);
      sums_[i + 2] = sums_[i + 1] + sum;
    }
  }
  /// Of (width - |i|) * value[centre + i]; the row reaches as far.
  [[nodiscard]] double under(std::ptrdiff_t centre, std::ptrdiff_t width) const {
    return static_cast<double>(static_cast<std::int64_t>(at(centre + width) - 2 * at(centre) + at(centre - width)));
  }

 private:
  [[nodiscard]] std::uint64_t at(std::ptrdiff_t i) const { return sums_[static_cast<std::size_t>(i + 1)]; }
  std::vector<std::uint64_t> sums_;
};

/// A row with `margin` further pixels on each side -> the row.
class RowSmoother {
 public:
  void smooth(const std::vector<float>& row, double halfWidth, std::ptrdiff_t margin, float* out) {
    const auto narrower = static_cast<std::ptrdiff_t>(halfWidth);
    const double wide = halfWidth - static_cast<double>(narrower);
    // As finely as 63 bits hold the widest triangle of the greatest heights; some micrometres as a rule.
    const int areaBits = 2 * static_cast<int>(std::ceil(std::log2(static_cast<double>(narrower + 1))));
    const int fraction = std::min(62 - areaBits - heightBits, 20);
    values_.assign(row.size(), 0);
    counts_.assign(row.size(), 0);
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (counts(row[i])) {
        values_[i] = std::llround(std::ldexp(static_cast<double>(row[i]), fraction));
        counts_[i] = 1;
      }
    }
    valueSums_.assign(values_);
    countSums_.assign(counts_);
    const auto width = static_cast<std::ptrdiff_t>(row.size()) - 2 * margin;
    for (std::ptrdiff_t i = 0; i < width; ++i) {
      const float pixel = row[static_cast<std::size_t>(margin + i)];
      const double smoothed = std::lerp(mean(margin + i, narrower), mean(margin + i, narrower + 1), wide);
      out[i] = counts(pixel) ? static_cast<float>(std::ldexp(smoothed, -fraction)) : pixel;
    }
  }

 private:
  static constexpr int heightBits = 21;
  /// Whether that is a height, of at most two thousand kilometres.
  [[nodiscard]] static bool counts(float metres) { return std::abs(metres) < std::ldexp(1.0F, heightBits); }
  /// Not-a-number where nothing counts.
  [[nodiscard]] double mean(std::ptrdiff_t centre, std::ptrdiff_t width) const {
    return valueSums_.under(centre, width) / countSums_.under(centre, width);
  }

  std::vector<std::int64_t> values_;
  std::vector<std::int64_t> counts_;
  TriangleSums valueSums_;
  TriangleSums countSums_;
};

}  // namespace

bool PolarHeights::concerns(const Pyramid& pyramid) {
  return pyramid.georeference.isGeographic() && !pyramid.georeference.isMercator() && !pyramid.isChosenByPlace;
}

double PolarHeights::halfWidth(const PyramidLevel& level, int row) const {
  const RasterGeoreference& georeference = pyramid().georeference;
  const double latitude = georeference.latitude((row + 0.5 - level.offsetY) * level.scaleY);
  const double height = georeference.pixelHeightAngle() * level.scaleY;
  const double width = georeference.pixelWidthAngle() * level.scaleX * std::abs(std::cos(latitude));
  const int turn = pyramid().columnsOfTurn(level);
  return std::min(height / width - 2.0, (turn > 0 ? turn : level.width) / 2.0);
}

Result<void> PolarHeights::fetch(std::size_t levelNumber, const UnboundedWindow& window, float* out,
                                 const std::stop_token& stop) {
  const PyramidLevel& level = pyramid().levels[levelNumber];
  RowSmoother smoother;
  std::vector<float> wide;
  for (int row = 0; row < window.height;) {
    float* target = out != nullptr ? out + static_cast<std::ptrdiff_t>(row) * window.width : nullptr;
    const double half = halfWidth(level, window.y + row);
    int rows = 1;
    if (half <= 1.0) {
      while (row + rows < window.height && halfWidth(level, window.y + row + rows) <= 1.0) {
        ++rows;
      }
      if (auto done = reader_.fetch(levelNumber, {window.x, window.y + row, window.width, rows}, target, stop); !done) {
        return done;
      }
    } else {
      const int margin = static_cast<int>(half) + 1;
      const PixelWindow wider{window.x - margin, window.y + row, window.width + 2 * margin, 1};
      wide.resize(out != nullptr ? static_cast<std::size_t>(wider.width) : 0);
      if (auto done = reader_.fetch(levelNumber, wider, out != nullptr ? wide.data() : nullptr, stop); !done) {
        return done;
      }
      if (out != nullptr) {
        smoother.smooth(wide, half, margin, target);
      }
    }
    row += rows;
  }
  return {};
}

}  // namespace meridian::globebrowsing
