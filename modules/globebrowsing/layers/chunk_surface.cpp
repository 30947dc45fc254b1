#include "globebrowsing/layers/chunk_surface.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <glm/geometric.hpp>

namespace meridian::globebrowsing {

/// Every node's ellipsoid normal and displaced position, apron included.
struct ChunkSurface::Nodes {
  std::vector<glm::dvec3> normals;
  std::vector<glm::dvec3> positions;

  [[nodiscard]] static std::size_t at(int column, int row) {
    return static_cast<std::size_t>(row + apron) * heightSide + static_cast<std::size_t>(column + apron);
  }
};

namespace {

glm::dvec2 nodeUv(int column, int row) {
  constexpr double cells = ChunkSurface::nodes - 1;
  return {column / cells, row / cells};
}

std::array<float, 3> narrow(const glm::dvec3& vector) {
  return {static_cast<float>(vector.x), static_cast<float>(vector.y), static_cast<float>(vector.z)};
}

}  // namespace

glm::dvec3 bilinear(const std::array<glm::dvec3, 4>& corners, const glm::dvec2& uv) {
  const glm::dvec3 north = corners[0] + (corners[1] - corners[0]) * uv.x;
  const glm::dvec3 south = corners[2] + (corners[3] - corners[2]) * uv.x;
  return north + (south - north) * uv.y;
}

ChunkSurface::ChunkSurface(const Tiling& tiling, const TileIndex& index, std::vector<float> heights)
    : heights_(std::move(heights)) {
  assert(heights_.size() == static_cast<std::size_t>(heightSide) * heightSide);
  Nodes all;
  all.normals.resize(heights_.size());
  all.positions.resize(heights_.size());
  range_ = {height(0, 0), height(0, 0)};
  const Ellipsoid& ellipsoid = tiling.ellipsoid();
  for (int row = -apron; row < nodes + apron; ++row) {
    for (int column = -apron; column < nodes + apron; ++column) {
      GeodeticPosition position = tiling.geodetic(index, nodeUv(column, row));
      position.height = height(column, row);
      all.normals[Nodes::at(column, row)] = ellipsoid.normal(position.latitude, position.longitude);
      all.positions[Nodes::at(column, row)] = ellipsoid.cartesian(position);
      const bool inside = row >= 0 && row < nodes && column >= 0 && column < nodes;
      if (inside) {
        range_.minimum = std::min(range_.minimum, position.height);
        range_.maximum = std::max(range_.maximum, position.height);
      }
    }
  }
  corners_ = {tiling.position(index, {0.0, 0.0}), tiling.position(index, {1.0, 0.0}),
              tiling.position(index, {0.0, 1.0}), tiling.position(index, {1.0, 1.0})};
  setTaper(all);
  setLifts(tiling, index);
  makeVertices(all);
  makeNormals(all);
  for (int step = 0; step < chunk_grid::steps; ++step) {
    errors_[static_cast<std::size_t>(step)] = errorAt(all, step);
    drifts_[static_cast<std::size_t>(step)] = driftAt(all, step);
  }
}

double ChunkSurface::driftAt(const Nodes& all, int step) const {
  const int stride = (nodes - 1) / chunk_grid::columnsAt(step, columns_);
  double largest = 0.0;
  for (const int row : {0, nodes - 1}) {
    for (int column = 0; column < nodes - 1; column += stride) {
      const glm::dvec3& west = all.positions[Nodes::at(column, row)];
      const glm::dvec3 edge = all.positions[Nodes::at(column + stride, row)] - west;
      for (int i = 1; i < stride; ++i) {
        const std::size_t node = Nodes::at(column + i, row);
        const glm::dvec3 across = glm::cross(all.normals[node], edge);
        const double length = glm::length(across);
        const glm::dvec3 apart = all.positions[node] - (west + edge * (static_cast<double>(i) / stride));
        largest = length > 0.0 ? std::max(largest, std::abs(glm::dot(apart, across)) / length) : largest;
      }
    }
  }
  return largest;
}

void ChunkSurface::setTaper(const Nodes& all) {
  const auto length = [&](int row) {
    double sum = 0.0;
    for (int column = 1; column < nodes; ++column) {
      sum += glm::distance(all.positions[Nodes::at(column, row)], all.positions[Nodes::at(column - 1, row)]);
    }
    return sum;
  };
  const double north = length(0);
  const double south = length(nodes - 1);
  const double wider = std::max(north, south);
  if (wider < 1e-6 * length(nodes / 2)) {
    return;  // between two poles
  }
  taper_ = north < south ? 1.0 - north / wider : south / wider - 1.0;
  constexpr double toAPoint = 1.0 - 1e-6;
  const double high = glm::distance(corners_[0], corners_[2]);
  if (std::abs(taper_) > toAPoint && wider < 0.5 * high) {
    columns_ = taper_ > 0.0 ? chunk_grid::Columns::HalfToNorthPole : chunk_grid::Columns::HalfToSouthPole;
  }
}

void ChunkSurface::setLifts(const Tiling& tiling, const TileIndex& index) {
  // A cell's edge is an arc of `angle`; it sags by angle^2 / 8 of the radius of curvature, and the cell's diagonal by
  // twice that. Taken from the root and from the least radius there is, so that it is alike all over the level, and
  // nowhere more than half of what is to be halved.
  const auto normalAt = [&tiling](double v) {
    const GeodeticPosition place = tiling.geodetic(TileIndex{}, {0.5, v});
    return tiling.ellipsoid().normal(place.latitude, place.longitude);
  };
  const double half = std::acos(std::clamp(glm::dot(normalAt(0.0), normalAt(0.5)), -1.0, 1.0));
  const double least = tiling.ellipsoid().minimumRadius();
  const double radius = least * least / tiling.ellipsoid().maximumRadius();
  for (int step = 0; step < chunk_grid::steps; ++step) {
    const double angle = std::ldexp(2.0 * half / chunk_grid::segmentsAt(step), -int{index.level});
    lifts_[static_cast<std::size_t>(step)] = radius * angle * angle / 8.0;
  }
}

float ChunkSurface::height(int column, int row) const {
  return heights_[Nodes::at(column, row)];
}

void ChunkSurface::makeVertices(const Nodes& all) {
  constexpr int stride = (nodes - 1) / chunk_grid::segments;
  vertices_.resize(chunk_grid::vertexCount);
  for (int i = 0; i < chunk_grid::vertexCount; ++i) {
    const chunk_grid::Place place = chunk_grid::place(i);
    const int column = place.column * stride;
    const int row = place.row * stride;
    const glm::dvec3& normal = all.normals[Nodes::at(column, row)];
    const double metres = height(column, row);
    const glm::dvec3 onEllipsoid = all.positions[Nodes::at(column, row)] - normal * metres;
    vertices_[static_cast<std::size_t>(i)] = {
        narrow(onEllipsoid - bilinear(corners_, nodeUv(column, row))),
        static_cast<float>(metres),
        narrow(normal),
        {static_cast<std::uint8_t>(place.column), static_cast<std::uint8_t>(place.row),
         static_cast<std::uint8_t>(place.skirt ? 1 : 0), 0}};
  }
}

void ChunkSurface::makeNormals(const Nodes& all) {
  std::vector<glm::dvec3> offsets;
  offsets.reserve(static_cast<std::size_t>(nodes) * nodes);
  cone_.axis = all.normals[Nodes::at(nodes / 2, nodes / 2)];
  double leastCosine = 1.0;
  for (int row = 0; row < nodes; ++row) {
    for (int column = 0; column < nodes; ++column) {
      const glm::dvec3& vertical = all.normals[Nodes::at(column, row)];
      leastCosine = std::min(leastCosine, glm::dot(vertical, cone_.axis));
      offsets.push_back(surfaceNormal(all, column, row) - vertical);
    }
  }
  cone_.angle = std::acos(std::clamp(leastCosine, -1.0, 1.0));
  normals_ = NormalImage(offsets);
}

glm::dvec3 ChunkSurface::surfaceNormal(const Nodes& all, int column, int row) {
  const glm::dvec3& vertical = all.normals[Nodes::at(column, row)];
  const glm::dvec3 east = all.positions[Nodes::at(column + 1, row)] - all.positions[Nodes::at(column - 1, row)];
  const glm::dvec3 south = all.positions[Nodes::at(column, row + 1)] - all.positions[Nodes::at(column, row - 1)];
  const glm::dvec3 across = glm::cross(south, east);
  const double length = glm::length(across);
  // At a pole a whole row is one point: there the ellipsoid's normal has to do.
  if (!(length > 1e-9 * glm::dot(south, south))) {
    return vertical;
  }
  return glm::dot(across, vertical) < 0.0 ? -across / length : across / length;
}

double ChunkSurface::errorAt(const Nodes& all, int step) const {
  const int down = (nodes - 1) / chunk_grid::segmentsAt(step);
  const int across = (nodes - 1) / chunk_grid::columnsAt(step, columns_);
  const auto vertex = [&](int column, int row) {
    const std::size_t node = Nodes::at(column, row);
    return all.positions[node] + all.normals[node] * lift(step);
  };
  double largest = 0.0;
  for (int row = 0; row < nodes - 1; row += down) {
    // There a cell is one triangle.
    const bool atNorthPole = columns_ == chunk_grid::Columns::HalfToNorthPole && row == 0;
    const bool atSouthPole = columns_ == chunk_grid::Columns::HalfToSouthPole && row + down == nodes - 1;
    for (int column = 0; column < nodes - 1; column += across) {
      const glm::dvec3 northWest = vertex(column, row);
      const glm::dvec3 southWest = vertex(column, row + down);
      const glm::dvec3 northEast = vertex(column + across, row);
      const glm::dvec3 southEast = vertex(column + across, row + down);
      const glm::dvec3 west = southWest - northWest;
      const glm::dvec3 south = southEast - southWest;
      const glm::dvec3 north = northEast - northWest;
      const glm::dvec3 east = southEast - northEast;
      for (int j = 0; j <= down; ++j) {
        for (int i = 0; i <= across; ++i) {
          const double a = static_cast<double>(i) / across;
          const double b = static_cast<double>(j) / down;
          const glm::dvec3 drawn = atNorthPole   ? northWest + (west + south * a) * b
                                   : atSouthPole ? southWest + (north * a - west) * (1.0 - b)
                                   : a <= b      ? northWest + west * b + south * a
                                                 : northWest + north * a + east * b;
          const std::size_t node = Nodes::at(column + i, row + j);
          largest = std::max(largest, std::abs(glm::dot(all.positions[node] - drawn, all.normals[node])));
        }
      }
    }
  }
  return largest;
}

double ChunkSurface::heightAt(const glm::dvec2& uv) const {
  const glm::dvec2 place = glm::clamp(uv, 0.0, 1.0) * static_cast<double>(nodes - 1);
  const int column = std::min(static_cast<int>(place.x), nodes - 2);
  const int row = std::min(static_cast<int>(place.y), nodes - 2);
  const double a = place.x - column;
  const double b = place.y - row;
  const double north = (1.0 - a) * height(column, row) + a * height(column + 1, row);
  const double south = (1.0 - a) * height(column, row + 1) + a * height(column + 1, row + 1);
  return (1.0 - b) * north + b * south;
}

std::size_t ChunkSurface::bytes() const {
  return sizeof(*this) + heights_.size() * sizeof(float) + vertices_.size() * sizeof(SurfaceVertex) + normals_.bytes();
}

}  // namespace meridian::globebrowsing
