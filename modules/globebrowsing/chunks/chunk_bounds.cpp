#include "globebrowsing/chunks/chunk_bounds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace meridian::globebrowsing {

namespace {

constexpr int cells = 8;
constexpr int side = cells + 1;
constexpr std::size_t pointCount = std::size_t{side} * side;
constexpr double cellsSquared = cells * cells;

struct Samples {
  std::array<glm::dvec3, pointCount> points;  ///< on the ellipsoid
  std::array<glm::dvec3, pointCount> normals;

  [[nodiscard]] static std::size_t at(int column, int row) {
    return static_cast<std::size_t>(row) * side + static_cast<std::size_t>(column);
  }
};

Samples sample(const Tiling& tiling, const TileIndex& index) {
  Samples samples;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const GeodeticPosition place =
          tiling.geodetic(index, {column / static_cast<double>(cells), row / static_cast<double>(cells)});
      const std::size_t i = Samples::at(column, row);
      samples.normals[i] = tiling.ellipsoid().normal(place.latitude, place.longitude);
      const glm::dvec3 scaled = tiling.ellipsoid().radii() * samples.normals[i];
      samples.points[i] = tiling.ellipsoid().radii() * scaled / glm::length(scaled);
    }
  }
  return samples;
}

HeightRange ordered(const HeightRange& heights) {
  const double minimum = std::isfinite(heights.minimum) ? heights.minimum : 0.0;
  const double maximum = std::isfinite(heights.maximum) ? heights.maximum : 0.0;
  return {std::min(minimum, maximum), std::max(minimum, maximum)};
}

/// How far a surface may leave the bilinear cells between the samples.
struct Margin {
  double metres = 0.0;
  double scaled = 0.0;  ///< the same in scaled space
};

struct Squares {
  double sine = 0.0;
  double cosine = 1.0;
};

/// What bounds the squares of sine and cosine, and their product, between two angles that are at most pi apart.
struct Arc {
  std::array<Squares, 2> extremes;  ///< with the least sine and the greatest
  double product = 0.0;             ///< greatest |sine * cosine|

  Arc(double first, double last) {
    const auto squaresAt = [](double angle) {
      return Squares{std::sin(angle) * std::sin(angle), std::cos(angle) * std::cos(angle)};
    };
    const double low = std::min(first, last);
    const double high = std::max(first, last);
    extremes = {squaresAt(low), squaresAt(high)};
    if (extremes[0].sine > extremes[1].sine) {
      std::swap(extremes[0], extremes[1]);
    }
    // At even quarter turns the sine is 0, at odd ones the cosine; half way between both are alike.
    constexpr double quarter = std::numbers::pi / 2.0;
    for (auto turn = static_cast<int>(std::ceil(low / quarter)); turn <= std::floor(high / quarter); ++turn) {
      (turn % 2 == 0 ? extremes[0] : extremes[1]) = turn % 2 == 0 ? Squares{0.0, 1.0} : Squares{1.0, 0.0};
    }
    const bool hasHalfWay = std::floor(low / quarter - 0.5) != std::floor(high / quarter - 0.5);
    product = hasHalfWay ? 0.5 : 0.5 * std::max(std::abs(std::sin(2.0 * low)), std::abs(std::sin(2.0 * high)));
  }
};

/// What bounds the bend of a tile's surface. All is bilinear in the squared sines of latitude and longitude, or less
/// than a product of what is, so the tile's corners hold the extremes.
struct Bend {
  double leastSupport = 0.0;        ///< h = |r n|: distance from the centre to the tangent plane
  double greatestFoot = 0.0;        ///< |A n|
  double greatestEquatorial = 0.0;  ///< h^2 at the same longitudes on the equator

  /// Second derivative along an arc of normals whose direction v has v A v and |n A v| of at most that.
  [[nodiscard]] Margin along(double square, double product, double greatestRadius) const {
    const double h = leastSupport;
    const double tilt = product / (h * h);
    const double reach = std::sqrt(square) / h;
    return {2.0 * greatestRadius * reach * tilt + greatestFoot / h * (reach * reach + 3.0 * tilt * tilt),
            2.0 * reach * tilt + reach * reach + 3.0 * tilt * tilt};
  }
};

/// At most |f_uu| du^2 / 8 + |f_vv| dv^2 / 8.
///
/// On the ellipsoid P(n) = A n / h, h = |r n|, A = diag(r^2), is homogeneous of degree 0 in the normal n. For unit v at
/// right angles to n, P''[v, v] = -2 A v (n A v) / h^3 - A n (v A v) / h^3 + 3 A n (n A v)^2 / h^5. Along a meridian
/// n'' = -n adds nothing; along a parallel n'' is cos(latitude) long and adds P'[n'']. The height adds itself. In
/// scaled space A v and A n become r v and r n, of length sqrt(v A v) and h. Everything is bounded within the tile: on
/// a flattened body the bends of its face and of its rim differ by powers of the radii's ratio.
Margin provedMargin(const Tiling& tiling, const TileIndex& index, double height) {
  const glm::dvec3 squares = tiling.ellipsoid().radii() * tiling.ellipsoid().radii();
  const double most = tiling.ellipsoid().maximumRadius();
  const GeodeticPosition first = tiling.geodetic(index, {0.0, 0.0});
  const GeodeticPosition last = tiling.geodetic(index, {1.0, 1.0});
  const double latitudes = std::abs(last.latitude - first.latitude);
  const double longitudes = std::abs(last.longitude - first.longitude);
  const Arc north(first.latitude, last.latitude);
  const Arc east(first.longitude, last.longitude);
  const double cosine = std::sqrt(north.extremes[0].cosine);

  Bend bend;
  bend.leastSupport = most * most;
  double alongMeridian = 0.0;  // v A v there
  double alongParallel = 0.0;
  double unlike = 0.0;  // of the axis' square and the equator's
  for (const Squares& y : east.extremes) {
    const double equatorial = squares.x * y.cosine + squares.y * y.sine;
    const double equatorialFoot = squares.x * squares.x * y.cosine + squares.y * squares.y * y.sine;
    bend.greatestEquatorial = std::max(bend.greatestEquatorial, equatorial);
    alongParallel = std::max(alongParallel, squares.x * y.sine + squares.y * y.cosine);
    unlike = std::max(unlike, std::abs(squares.z - equatorial));
    for (const Squares& z : north.extremes) {
      bend.leastSupport = std::min(bend.leastSupport, equatorial * z.cosine + squares.z * z.sine);
      bend.greatestFoot = std::max(bend.greatestFoot, equatorialFoot * z.cosine + squares.z * squares.z * z.sine);
      alongMeridian = std::max(alongMeridian, equatorial * z.sine + squares.z * z.cosine);
    }
  }
  bend.leastSupport = std::sqrt(bend.leastSupport);
  bend.greatestFoot = std::sqrt(bend.greatestFoot);
  const Margin meridian = bend.along(alongMeridian, unlike * north.product, most);
  const Margin parallel = bend.along(alongParallel, cosine * std::abs(squares.y - squares.x) * east.product, most);
  const double turn = std::sqrt(bend.greatestEquatorial) / bend.leastSupport;
  const double scaledHeight = height / tiling.ellipsoid().minimumRadius();
  const auto sum = [&](double alongLatitude, double alongLongitude) {
    return (latitudes * latitudes * alongLatitude + longitudes * longitudes * cosine * alongLongitude) /
           (8.0 * cellsSquared);
  };
  return {sum(meridian.metres + height, cosine * parallel.metres + most * turn + height),
          sum(meridian.scaled + scaledHeight, cosine * parallel.scaled + turn + scaledHeight)};
}

Margin measuredMargin(const Samples& samples, const Ellipsoid& ellipsoid, double height) {
  double across = 0.0;
  double down = 0.0;
  for (int i = 0; i < side; ++i) {
    for (int j = 1; j < cells; ++j) {
      const auto bend = [&samples](std::size_t before, std::size_t middle, std::size_t after) {
        return glm::length(samples.points[before] - 2.0 * samples.points[middle] + samples.points[after]);
      };
      across = std::max(across, bend(Samples::at(j - 1, i), Samples::at(j, i), Samples::at(j + 1, i)));
      down = std::max(down, bend(Samples::at(i, j - 1), Samples::at(i, j), Samples::at(i, j + 1)));
    }
  }
  const double metres = 2.0 * (across + down) / 8.0 * (1.0 + height / ellipsoid.minimumRadius());
  return {metres, metres / ellipsoid.minimumRadius()};
}

OrientedBox boxAround(const Samples& samples, const HeightRange& heights, double margin) {
  OrientedBox box;
  constexpr int middle = cells / 2;
  const glm::dvec3& up = samples.normals[Samples::at(middle, middle)];
  glm::dvec3 along = samples.points[Samples::at(cells, middle)] - samples.points[Samples::at(0, middle)];
  along -= up * glm::dot(along, up);
  const glm::dvec3 any = std::abs(up.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(1.0, 0.0, 0.0);
  along = glm::length(along) > 0.0 ? glm::normalize(along) : glm::normalize(glm::cross(any, up));
  box.axes = {along, glm::cross(up, along), up};

  const glm::dvec3& origin = samples.points[Samples::at(middle, middle)];
  glm::dvec3 low(1e300);
  glm::dvec3 high(-1e300);
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    for (const double height : {heights.minimum, heights.maximum}) {
      const glm::dvec3 point = samples.points[i] - origin + height * samples.normals[i];
      const glm::dvec3 local(glm::dot(point, box.axes[0]), glm::dot(point, box.axes[1]), glm::dot(point, box.axes[2]));
      low = glm::min(low, local);
      high = glm::max(high, local);
    }
  }
  box.half = 0.5 * (high - low) + margin;
  const glm::dvec3 local = 0.5 * (high + low);
  box.centre = origin + local.x * box.axes[0] + local.y * box.axes[1] + local.z * box.axes[2];
  return box;
}

ScaledCap capAround(const Samples& samples, const glm::dvec3& radii, const HeightRange& heights, double scaledMargin) {
  ScaledCap cap;
  constexpr int middle = cells / 2;
  cap.direction = glm::normalize(samples.points[Samples::at(middle, middle)] / radii);
  double least = 1e300;
  double most = 0.0;
  double angle = 0.0;
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    for (const double height : {heights.minimum, heights.maximum}) {
      const glm::dvec3 point = (samples.points[i] + height * samples.normals[i]) / radii;
      least = std::min(least, glm::length(point));
      most = std::max(most, glm::length(point));
      // Both products are needed: the cosine alone loses the small angles of deep tiles.
      angle =
          std::max(angle, std::atan2(glm::length(glm::cross(cap.direction, point)), glm::dot(cap.direction, point)));
    }
  }
  // Cone and ball are convex, so they hold what lies between the samples too; the margin widens both. Between samples
  // a surface may come nearer to the centre than any of them, by no more than the chords' depth, cos(angle).
  const double nearest = least * std::cos(std::min(angle, 1.5)) - scaledMargin;
  cap.greatestRadius = most + scaledMargin;
  const bool useful = angle < 1.5 && nearest > scaledMargin;
  cap.angle = useful ? angle + std::asin(scaledMargin / nearest) : std::numbers::pi;
  return cap;
}

double edgeLength(const Samples& samples, bool vertical, int which) {
  double length = 0.0;
  for (int i = 0; i < cells; ++i) {
    const std::size_t from = vertical ? Samples::at(which, i) : Samples::at(i, which);
    const std::size_t to = vertical ? Samples::at(which, i + 1) : Samples::at(i + 1, which);
    length += glm::length(samples.points[to] - samples.points[from]);
  }
  return length;
}

}  // namespace

double OrientedBox::distance(const glm::dvec3& position) const {
  const glm::dvec3 relative = position - centre;
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double outside = std::abs(glm::dot(relative, axes[static_cast<std::size_t>(i)])) - half[i];
    sum += outside > 0.0 ? outside * outside : 0.0;
  }
  return std::sqrt(sum);
}

ChunkBounds chunkBounds(const Tiling& tiling, const TileIndex& index, const HeightRange& heights) {
  const HeightRange range = ordered(heights);
  const Samples samples = sample(tiling, index);
  const Ellipsoid& ellipsoid = tiling.ellipsoid();
  const double height = std::max(std::abs(range.minimum), std::abs(range.maximum));
  const Margin bend =
      tiling.isSeparable() ? provedMargin(tiling, index, height) : measuredMargin(samples, ellipsoid, height);
  // Rounding of positions in model space.
  const double rounding = 1e-15 * 8.0 * (ellipsoid.maximumRadius() + height);

  ChunkBounds bounds;
  bounds.box = boxAround(samples, range, bend.metres + rounding);
  bounds.cap = capAround(samples, ellipsoid.radii(), range, bend.scaled + rounding / ellipsoid.minimumRadius());
  const double north = edgeLength(samples, false, 0);
  const double south = edgeLength(samples, false, cells);
  const double west = edgeLength(samples, true, 0);
  const double east = edgeLength(samples, true, cells);
  bounds.edgeLength = std::max({north, south, west, east});
  bounds.area = edgeLength(samples, false, cells / 2) * edgeLength(samples, true, cells / 2);
  bounds.normal = samples.normals[Samples::at(cells / 2, cells / 2)];
  std::size_t next = 0;
  for (const int row : {0, cells / 2, cells}) {
    for (const int column : {0, cells / 2, cells}) {
      const std::size_t place = Samples::at(column, row);
      bounds.normals[next] = samples.normals[place];
      bounds.points[next++] = samples.points[place] + 0.5 * (range.minimum + range.maximum) * samples.normals[place];
    }
  }
  return bounds;
}

}  // namespace meridian::globebrowsing
