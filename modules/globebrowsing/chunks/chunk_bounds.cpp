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

/// How far the surface leaves the bilinear cells between the samples, at most: |f_uu| du^2 / 8 + |f_vv| dv^2 / 8.
///
/// On the ellipsoid P(n) = A n / h, h = |r n|, A = diag(r^2), is homogeneous of degree 0 in the normal n. For unit v at
/// right angles to n, n A v <= e = (r_max^2 - r_min^2) / 2, so |P''[v, v]| <= 2 r_max^2 e / h^3 + r_max^3 / h^2 +
/// 3 r_max e^2 / h^4. Along a meridian n'' = -n adds nothing; along a parallel n'' is cos(latitude) long and adds the
/// largest radius of curvature, r_max^2 / r_min, times that. The height adds itself.
double provedMargin(const Tiling& tiling, const TileIndex& index, double height) {
  const double most = tiling.ellipsoid().maximumRadius();
  const double least = tiling.ellipsoid().minimumRadius();
  const double eccentric = 0.5 * (most - least) * (most + least);
  const double bend = 2.0 * most * most * eccentric / (least * least * least) + most * most * most / (least * least) +
                      3.0 * most * eccentric * eccentric / (least * least * least * least);
  const GeodeticPosition first = tiling.geodetic(index, {0.0, 0.0});
  const GeodeticPosition last = tiling.geodetic(index, {1.0, 1.0});
  const double latitudes = std::abs(last.latitude - first.latitude);
  const double longitudes = std::abs(last.longitude - first.longitude);
  const bool overEquator = first.latitude * last.latitude < 0.0;
  const double cosine = overEquator ? 1.0 : std::cos(std::min(std::abs(first.latitude), std::abs(last.latitude)));
  const double alongMeridian = bend + height;
  const double alongParallel = cosine * (cosine * bend + most * most / least + height);
  return (latitudes * latitudes * alongMeridian + longitudes * longitudes * alongParallel) / (8.0 * cellsSquared);
}

double measuredMargin(const Samples& samples, const Ellipsoid& ellipsoid, double height) {
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
  return 2.0 * (across + down) / 8.0 * (1.0 + height / ellipsoid.minimumRadius());
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

ScaledCap capAround(const Samples& samples, const glm::dvec3& radii, const HeightRange& heights, double margin) {
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
  const double scaledMargin = margin / std::min({radii.x, radii.y, radii.z});
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
  const double bend =
      tiling.isSeparable() ? provedMargin(tiling, index, height) : measuredMargin(samples, ellipsoid, height);
  // Rounding of positions in model space.
  const double margin = bend + 1e-15 * 8.0 * (ellipsoid.maximumRadius() + height);

  ChunkBounds bounds;
  bounds.box = boxAround(samples, range, margin);
  bounds.cap = capAround(samples, ellipsoid.radii(), range, margin);
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
