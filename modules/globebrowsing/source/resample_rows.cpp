#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

#include "globebrowsing/source/resample_parts.h"

namespace meridian::globebrowsing {

namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t stripPixels = std::size_t{1} << 20U;

/// One column or row of the tile, on the raster's level.
struct Line {
  double angle = 0.0;   ///< longitude or latitude
  double place = 0.0;   ///< column or row of full resolution
  double centre = 0.0;  ///< on the level, pixel i centred on i
  int shift = 0;        ///< columns that a line on the far side of the raster's seam moves by
  Sampling sampling{};  ///< of a row
  bool isWithin = false;
  bool isRegular = true;  ///< else a row at or beyond a pole, where longitudes mean something else
};

double turnDifference(double a, double b) {
  return std::remainder(a - b, 2.0 * pi);
}

std::vector<Line> columnLines(const Pyramid& pyramid, const TileRequest& tile, const PyramidLevel& level) {
  const RasterGeoreference& georeference = pyramid.georeference;
  const int turn = pyramid.columnsOfTurn(level);
  const int fullTurn = georeference.columnsOfTurn();
  std::vector<Line> lines(static_cast<std::size_t>(tile.layout.size()));
  int turns = 0;
  double previous = 0.0;
  bool isFirst = true;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    Line& line = lines[i];
    line.angle = tile.tiling.geodetic(tile.index, {tile.layout.uv(static_cast<int>(i), 0).x, 0.5}).longitude;
    line.place = georeference.column(line.angle);
    line.centre = level.centreX(line.place);
    line.isWithin = fullTurn > 0 || isWithin(line.place, georeference.width());
    if (fullTurn > 0) {
      const double step = line.place - previous;
      turns += isFirst ? 0 : step > fullTurn / 2.0 ? -1 : step < -fullTurn / 2.0 ? 1 : 0;
      line.shift = turns * turn;
      previous = line.place;
      isFirst = false;
    }
  }
  return lines;
}

std::vector<Line> rowLines(const Pyramid& pyramid, const TileRequest& tile, const SampleSpacing& spacing) {
  const RasterGeoreference& georeference = pyramid.georeference;
  const double meridian = tile.tiling.geodetic(tile.index, {0.5, 0.5}).longitude;
  std::vector<Line> lines(static_cast<std::size_t>(tile.layout.size()));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    Line& line = lines[i];
    const GeodeticPosition place = tile.tiling.geodetic(tile.index, {0.5, tile.layout.uv(0, static_cast<int>(i)).y});
    line.angle = place.latitude;
    line.sampling = chooseSampling(pyramid, spacing, place.latitude);
    line.place = georeference.row(place.latitude);
    line.centre = pyramid.levels[line.sampling.level].centreY(line.place);
    line.isWithin = isWithin(line.place, georeference.height());
    line.isRegular =
        std::abs(place.latitude) < pi / 2 - 1e-12 && std::abs(turnDifference(place.longitude, meridian)) < pi / 2;
  }
  return lines;
}

/// Rows in turn that are sampled alike.
struct Band {
  std::span<const Line> rows;
  std::size_t firstRow = 0;
  [[nodiscard]] const Sampling& sampling() const { return rows.front().sampling; }
};

std::vector<Band> bandsOf(const std::vector<Line>& rows) {
  std::vector<Band> bands;
  for (std::size_t first = 0; first < rows.size();) {
    std::size_t end = first + 1;
    while (end < rows.size() && rows[end].sampling == rows[first].sampling) {
      ++end;
    }
    bands.push_back({std::span(rows).subspan(first, end - first), first});
    first = end;
  }
  return bands;
}

/// A kernel's taps for every line, and the pixels they span.
struct Axis {
  std::vector<Taps> taps;
  int first = std::numeric_limits<int>::max();
  int end = std::numeric_limits<int>::min();
  [[nodiscard]] bool isEmpty() const { return end <= first; }
};

template <class MakeTaps>
Axis makeAxis(std::span<const Line> lines, double stretch, MakeTaps make) {
  Axis axis;
  axis.taps.resize(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i) {
    axis.taps[i].count = 0;
    if (lines[i].isWithin && lines[i].isRegular) {
      axis.taps[i] = make(lines[i].centre, stretch);
      axis.taps[i].first += lines[i].shift;
      axis.first = std::min(axis.first, axis.taps[i].first);
      axis.end = std::max(axis.end, axis.taps[i].first + axis.taps[i].count);
    }
  }
  return axis;
}

/// Calls row(number, its pixels from columns.first on) for each of the level's rows first..end.
template <class Pixel, class Row>
Result<void> forEachRow(PixelReader& reader, std::size_t level, const PixelWindow& window, const std::stop_token& stop,
                        Row row) {
  if (reader.isPlan()) {
    return reader.fetch(level, window, static_cast<Pixel*>(nullptr), stop);
  }
  const auto width = static_cast<std::size_t>(window.width);
  const int rowsAtOnce =
      static_cast<int>(std::clamp<std::size_t>(stripPixels / width, 1, static_cast<std::size_t>(window.height)));
  std::vector<Pixel> strip(width * static_cast<std::size_t>(rowsAtOnce));
  for (int y = 0; y < window.height; y += rowsAtOnce) {
    if (stop.stop_requested()) {
      return failure("cancelled", reader.pyramid().where);
    }
    const int rows = std::min(rowsAtOnce, window.height - y);
    auto done = reader.fetch(level, {window.x, window.y + y, window.width, rows}, strip.data(), stop);
    if (!done) {
      return done;
    }
    for (int r = 0; r < rows; ++r) {
      row(static_cast<std::size_t>(y) + static_cast<std::size_t>(r),
          strip.data() + static_cast<std::ptrdiff_t>(r) * window.width);
    }
  }
  return {};
}

/// Rows at or beyond a pole, point by point. At the pole itself every longitude is one place: 0 stands for all.
template <class Pixel>
Result<void> sampleIrregularRows(PixelReader& reader, const TileRequest& tile, const std::vector<Line>& rows,
                                 Pixel* out, const std::stop_token& stop) {
  const int size = tile.layout.size();
  std::vector<double> x(static_cast<std::size_t>(size));
  std::vector<double> y(x.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (rows[r].isRegular || !rows[r].isWithin) {
      continue;
    }
    const bool isPole = std::abs(rows[r].angle) >= pi / 2 - 1e-12;
    for (std::size_t c = 0; c < x.size(); ++c) {
      x[c] = isPole
                 ? 0.0
                 : tile.tiling.geodetic(tile.index, tile.layout.uv(static_cast<int>(c), static_cast<int>(r))).longitude;
      x[c] = reader.pyramid().georeference.column(x[c]);
      y[c] = rows[r].place;
    }
    Pixel* target = out != nullptr ? out + static_cast<std::ptrdiff_t>(r) * size : nullptr;
    auto done = samplePoints(reader, rows[r].sampling, x, y, target, stop);
    if (!done) {
      return done;
    }
  }
  return {};
}

void sumColours(const Rgba* pixels, const Axis& columns, ColourSum* out) {
  for (const Taps& taps : columns.taps) {
    ColourSum sum;
    const Rgba* pixel = pixels + (taps.first - columns.first);
    for (int i = 0; i < taps.count; ++i, ++pixel) {
      const float present = static_cast<float>(taps.weight[static_cast<std::size_t>(i)]) *
                            static_cast<float>((*pixel)[3]) * (1.0F / 255.0F);
      sum.red += present * static_cast<float>((*pixel)[0]);
      sum.green += present * static_cast<float>((*pixel)[1]);
      sum.blue += present * static_cast<float>((*pixel)[2]);
      sum.alpha += present;
    }
    *out++ = sum;
  }
}

struct HeightSum {
  double cubic = 0.0;  ///< not-a-number where a pixel is absent
  double triangle = 0.0;
  double present = 0.0;
};

void sumHeights(const float* pixels, const Axis& cubic, const Axis& triangle, HeightSum* out) {
  for (std::size_t c = 0; c < cubic.taps.size(); ++c) {
    HeightSum sum;
    const Taps& wide = cubic.taps[c];
    const float* pixel = pixels + (wide.first - cubic.first);
    for (int i = 0; i < wide.count; ++i) {
      sum.cubic += wide.weight[static_cast<std::size_t>(i)] * pixel[i];
    }
    const Taps& near = triangle.taps[c];
    pixel = pixels + (near.first - cubic.first);
    for (int i = 0; i < near.count; ++i) {
      if (!std::isnan(pixel[i])) {
        sum.triangle += near.weight[static_cast<std::size_t>(i)] * pixel[i];
        sum.present += near.weight[static_cast<std::size_t>(i)];
      }
    }
    *out++ = sum;
  }
}

/// Every sample lies on a pixel's centre, so that it is that pixel.
bool isAligned(const Axis& axis) {
  return std::all_of(axis.taps.begin(), axis.taps.end(), [](const Taps& taps) { return taps.count <= 1; });
}

/// What the sums come to where both axes are aligned, at a third of their cost.
Result<void> copyBand(PixelReader& reader, std::size_t level, const Axis& columns, const Axis& rows,
                      const PixelWindow& window, Rgba* out, const std::stop_token& stop) {
  const std::size_t size = columns.taps.size();
  return forEachRow<Rgba>(reader, level, window, stop, [&](std::size_t row, const Rgba* pixels) {
    for (std::size_t r = 0; r < rows.taps.size(); ++r) {
      if (rows.taps[r].count == 0 || rows.taps[r].first != window.y + static_cast<int>(row)) {
        continue;
      }
      for (std::size_t c = 0; c < size; ++c) {
        const Taps& taps = columns.taps[c];
        const Rgba pixel = taps.count == 0 ? Rgba{} : pixels[taps.first - columns.first];
        out[r * size + c] = pixel[3] == 0 ? Rgba{} : pixel;
      }
    }
  });
}

/// `out`: the band's first row.
Result<void> sampleBand(PixelReader& reader, const TileRequest& tile, const Band& band, Rgba* out,
                        const std::stop_token& stop) {
  const Sampling& sampling = band.sampling();
  const PyramidLevel& level = reader.pyramid().levels[sampling.level];
  const Axis columns = makeAxis(columnLines(reader.pyramid(), tile, level), sampling.stretchX, triangleTaps);
  const Axis rows = makeAxis(band.rows, sampling.stretchY, triangleTaps);
  if (columns.isEmpty() || rows.isEmpty()) {
    return {};
  }
  const auto size = static_cast<std::size_t>(tile.layout.size());
  const PixelWindow window{columns.first, rows.first, columns.end - columns.first, rows.end - rows.first};
  const bool isPlan = reader.isPlan();
  if (!isPlan && isAligned(columns) && isAligned(rows)) {
    return copyBand(reader, sampling.level, columns, rows, window, out, stop);
  }
  std::vector<ColourSum> sums(isPlan ? 0 : size * static_cast<std::size_t>(window.height));
  auto done = forEachRow<Rgba>(reader, sampling.level, window, stop, [&](std::size_t row, const Rgba* pixels) {
    sumColours(pixels, columns, sums.data() + row * size);
  });
  if (!done || isPlan) {
    return done;
  }
  std::vector<ColourSum> line(size);
  for (std::size_t r = 0; r < rows.taps.size(); ++r) {
    const Taps& taps = rows.taps[r];
    if (taps.count == 0) {
      continue;
    }
    std::fill(line.begin(), line.end(), ColourSum{});
    for (int i = 0; i < taps.count; ++i) {
      const ColourSum* from = sums.data() + static_cast<std::size_t>(taps.first + i - rows.first) * size;
      const auto weight = static_cast<float>(taps.weight[static_cast<std::size_t>(i)]);
      for (std::size_t c = 0; c < size; ++c) {
        line[c].red += weight * from[c].red;
        line[c].green += weight * from[c].green;
        line[c].blue += weight * from[c].blue;
        line[c].alpha += weight * from[c].alpha;
      }
    }
    for (std::size_t c = 0; c < size; ++c) {
      out[r * size + c] = toRgba(line[c]);
    }
  }
  return {};
}

Result<void> sampleBand(PixelReader& reader, const TileRequest& tile, const Band& band, float* out,
                        const std::stop_token& stop) {
  const Sampling& sampling = band.sampling();
  const std::vector<Line> columnPlaces = columnLines(reader.pyramid(), tile, reader.pyramid().levels[sampling.level]);
  const auto reaching = [](double centre, double stretch) {
    // As far as the cubic's ends, whose weights may be too small to be taken while the triangle's are not.
    Taps taps = cubicTaps(centre, stretch);
    const Taps inner = triangleTaps(centre, stretch);
    const int end = std::max(taps.first + taps.count, inner.first + inner.count);
    taps.first = std::min(taps.first, inner.first);
    taps.count = end - taps.first;
    return taps;
  };
  const Axis wideColumns = makeAxis(columnPlaces, sampling.stretchX, reaching);
  const Axis wideRows = makeAxis(band.rows, sampling.stretchY, reaching);
  if (wideColumns.isEmpty() || wideRows.isEmpty()) {
    return {};
  }
  Axis cubicColumns = makeAxis(columnPlaces, sampling.stretchX, cubicTaps);
  const Axis triangleColumns = makeAxis(columnPlaces, sampling.stretchX, triangleTaps);
  const Axis cubicRows = makeAxis(band.rows, sampling.stretchY, cubicTaps);
  const Axis triangleRows = makeAxis(band.rows, sampling.stretchY, triangleTaps);
  cubicColumns.first = wideColumns.first;
  const auto size = static_cast<std::size_t>(tile.layout.size());
  const PixelWindow window{wideColumns.first, wideRows.first, wideColumns.end - wideColumns.first,
                           wideRows.end - wideRows.first};
  std::vector<HeightSum> sums(reader.isPlan() ? 0 : size * static_cast<std::size_t>(window.height));
  auto done = forEachRow<float>(reader, sampling.level, window, stop, [&](std::size_t row, const float* pixels) {
    sumHeights(pixels, cubicColumns, triangleColumns, sums.data() + row * size);
  });
  if (!done || reader.isPlan()) {
    return done;
  }
  for (std::size_t r = 0; r < band.rows.size(); ++r) {
    if (cubicRows.taps[r].count == 0) {
      continue;
    }
    for (std::size_t c = 0; c < size; ++c) {
      if (cubicColumns.taps[c].count == 0) {
        continue;
      }
      const auto at = [&](const Taps& taps, int i) -> const HeightSum& {
        return sums[static_cast<std::size_t>(taps.first + i - window.y) * size + c];
      };
      double metres = 0.0;
      const Taps& wide = cubicRows.taps[r];
      for (int i = 0; i < wide.count; ++i) {
        metres += wide.weight[static_cast<std::size_t>(i)] * at(wide, i).cubic;
      }
      if (std::isnan(metres)) {
        double present = 0.0;
        metres = 0.0;
        const Taps& near = triangleRows.taps[r];
        for (int i = 0; i < near.count; ++i) {
          metres += near.weight[static_cast<std::size_t>(i)] * at(near, i).triangle;
          present += near.weight[static_cast<std::size_t>(i)] * at(near, i).present;
        }
        metres = present >= leastPresent ? metres / present : std::numeric_limits<double>::quiet_NaN();
      }
      out[r * size + c] = static_cast<float>(metres);
    }
  }
  return {};
}

template <class Pixel>
Result<void> sampleBands(PixelReader& reader, const TileRequest& tile, const SampleSpacing& spacing, Pixel* out,
                         const std::stop_token& stop) {
  const auto size = static_cast<std::size_t>(tile.layout.size());
  const std::vector<Line> rows = rowLines(reader.pyramid(), tile, spacing);
  for (const Band& band : bandsOf(rows)) {
    auto done = sampleBand(reader, tile, band, out != nullptr ? out + band.firstRow * size : nullptr, stop);
    if (!done) {
      return done;
    }
  }
  return sampleIrregularRows(reader, tile, rows, out, stop);
}

}  // namespace

Result<void> sampleRows(PixelReader& reader, const TileRequest& tile, Rgba* out, const std::stop_token& stop) {
  const double u = tile.layout.spacing();
  const double columnSpacing = std::abs(turnDifference(tile.tiling.geodetic(tile.index, {0.5 + u, 0.5}).longitude,
                                                       tile.tiling.geodetic(tile.index, {0.5, 0.5}).longitude));
  return sampleBands(reader, tile, {nominalSpacing(tile.tiling, tile.index, tile.layout), columnSpacing}, out, stop);
}

Result<void> sampleRows(PixelReader& reader, const TileRequest& tile, float* out, const std::stop_token& stop) {
  return sampleBands(reader, tile, {nominalSpacing(tile.tiling, tile.index, tile.layout)}, out, stop);
}

}  // namespace meridian::globebrowsing
