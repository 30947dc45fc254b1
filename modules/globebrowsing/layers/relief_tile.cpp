#include "globebrowsing/layers/relief_tile.h"

#include <atomic>
#include <cassert>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace meridian::globebrowsing {

namespace {

std::atomic<std::uint64_t> lastId = 0;

/// Metres eastward and northward from one sample to the next.
struct Steps {
  glm::dvec2 column{0.0};
  glm::dvec2 row{0.0};
};

Steps stepsAt(const Tiling& tiling, const TileIndex& index, int column, int row) {
  const glm::dvec2 uv = reliefLayout.uv(column, row);
  const double half = 0.5 * reliefLayout.spacing();
  const GeodeticPosition place = tiling.geodetic(index, uv);
  const glm::dvec3 up = tiling.ellipsoid().normal(place.latitude, place.longitude);
  const glm::dvec3 east(-std::sin(place.longitude), std::cos(place.longitude), 0.0);
  const glm::dvec3 north = glm::cross(up, east);
  const auto along = [&](const glm::dvec2& step) {
    const glm::dvec3 metres = tiling.position(index, uv + step) - tiling.position(index, uv - step);
    return glm::dvec2(glm::dot(metres, east), glm::dot(metres, north));
  };
  return {along({half, 0.0}), along({0.0, half})};
}

ReliefTile::Normal normalOf(const glm::dvec2& differences, const Steps& steps) {
  const double area = steps.column.x * steps.row.y - steps.row.x * steps.column.y;
  if (area == 0.0) {
    return {};
  }
  const glm::dvec2 gradient((differences.x * steps.row.y - differences.y * steps.column.y) / area,
                            (differences.y * steps.column.x - differences.x * steps.row.x) / area);
  const double length = std::sqrt(1.0 + glm::dot(gradient, gradient));
  // Beyond a pole rows go north.
  const double unit = (steps.row.y > 0.0 ? 32767.0 : -32767.0) / length;
  return {static_cast<std::int16_t>(std::lround(gradient.x * unit)),
          static_cast<std::int16_t>(std::lround(gradient.y * unit))};
}

}  // namespace

ReliefTile::ReliefTile(const Tiling& tiling, const TileIndex& index, const std::vector<float>& heights)
    : id_(++lastId) {
  constexpr int side = reliefLayout.size();
  assert(heights.size() == static_cast<std::size_t>(side) * side);
  heights_.reserve(static_cast<std::size_t>(size) * size);
  normals_.reserve(heights_.capacity());
  Steps steps;
  for (int row = 1; row <= size; ++row) {
    for (int column = 1; column <= size; ++column) {
      if (column == 1 || !tiling.isSeparable()) {
        steps = stepsAt(tiling, index, column, row);
      }
      const float* centre = heights.data() + static_cast<std::size_t>(row) * side + column;
      const auto at = [centre](int across, int down) { return static_cast<double>(centre[down * side + across]); };
      const double west = at(-1, -1) + 2.0 * at(-1, 0) + at(-1, 1);
      const double east = at(1, -1) + 2.0 * at(1, 0) + at(1, 1);
      const double north = at(-1, -1) + 2.0 * at(0, -1) + at(1, -1);
      const double south = at(-1, 1) + 2.0 * at(0, 1) + at(1, 1);
      heights_.push_back(*centre);
      normals_.push_back(normalOf({(east - west) / 8.0, (south - north) / 8.0}, steps));
    }
  }
}

std::size_t ReliefTile::bytes() const {
  return sizeof(*this) + heights_.size() * sizeof(float) + normals_.size() * sizeof(Normal);
}

double pixelMetres(const Tiling& tiling, const TileIndex& index) {
  const double half = 0.5 * colourLayout.spacing();
  return glm::distance(tiling.position(index, {0.5, 0.5 - half}), tiling.position(index, {0.5, 0.5 + half}));
}

}  // namespace meridian::globebrowsing
