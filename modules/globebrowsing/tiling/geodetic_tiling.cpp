#include "globebrowsing/tiling/geodetic_tiling.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

namespace meridian::globebrowsing {

namespace {

constexpr double pi = std::numbers::pi;

/// A tile whose columns have been halved `thinned` times splits in latitude only while the colatitude of its edge
/// nearer the equator, as a fraction of pi, is below this: cos(latitude) pi / columns < pi / rows / 2, columns = rows /
/// 2^thinned.
double thinningLimit(int thinned) {
  static const auto limits = [] {
    std::array<double, maximumLevel + 1> values{};
    for (int i = 0; i <= maximumLevel; ++i) {
      values[static_cast<std::size_t>(i)] = std::asin(std::ldexp(0.5, -i)) / pi;
    }
    return values;
  }();
  return limits[static_cast<std::size_t>(thinned)];
}

/// 2^exponent; what std::ldexp does in a call, and tiles are asked for their places by the thousand.
constexpr double powerOfTwo(int exponent) {
  constexpr int bias = 1023;
  constexpr int mantissaBits = 52;
  return std::bit_cast<double>(static_cast<std::uint64_t>(bias + exponent) << mantissaBits);
}

/// The colatitude of the edge nearer the equator, as a fraction of pi, of the ancestor at that level of a row.
double equatorwardEdge(int level, std::uint32_t fromNearerPole, int ancestor) {
  return static_cast<double>((fromNearerPole >> (level - ancestor)) + 1) * powerOfTwo(-ancestor);
}

std::uint32_t rowsFromNearerPole(int level, std::uint32_t row) {
  return std::min(row, (std::uint32_t{1} << level) - 1 - row);
}

/// How often rows of that level were not split in longitude on the way down to this one.
int thinned(int level, std::uint32_t row) {
  const std::uint32_t fromNearerPole = rowsFromNearerPole(level, row);
  // The edge comes no nearer to the equator from ancestor to descendant, so in the middle latitudes the last one tells.
  if (level < 2 || equatorwardEdge(level, fromNearerPole, level - 1) >= thinningLimit(0)) {
    return 0;
  }
  int count = 0;
  // A root reaches over the equator and always splits into four.
  for (int ancestor = 1; ancestor < level; ++ancestor) {
    if (equatorwardEdge(level, fromNearerPole, ancestor) < thinningLimit(count)) {
      ++count;
    }
  }
  return count;
}

int columnsExponent(int level, std::uint32_t row) {
  return level - thinned(level, row);
}

bool splitsInLongitude(int level, std::uint32_t row) {
  return level == 0 ||
         equatorwardEdge(level, rowsFromNearerPole(level, row), level) >= thinningLimit(thinned(level, row));
}

}  // namespace

std::uint32_t GeodeticTiling::columns(int level, std::uint32_t row) {
  assert(level >= 0 && level <= maximumLevel && row < std::uint32_t{1} << level);
  return std::uint32_t{1} << columnsExponent(level, row);
}

Children GeodeticTiling::children(const TileIndex& index) const {
  assert(index.level < maximumLevel);
  const auto level = static_cast<std::uint8_t>(index.level + 1);
  Children children;
  const bool four = splitsInLongitude(index.level, index.y);
  for (std::uint32_t row = 0; row < 2; ++row) {
    for (std::uint32_t column = 0; column < (four ? 2U : 1U); ++column) {
      children.index[static_cast<std::size_t>(children.count++)] = {
          index.root, level, (four ? 2 * index.x : index.x) + column, 2 * index.y + row};
    }
  }
  return children;
}

std::optional<TileIndex> GeodeticTiling::parent(const TileIndex& index) const {
  if (index.level == 0) {
    return std::nullopt;
  }
  const int level = index.level - 1;
  const std::uint32_t row = index.y / 2;
  return TileIndex{index.root, static_cast<std::uint8_t>(level), splitsInLongitude(level, row) ? index.x / 2 : index.x,
                   row};
}

UnitSquareTransform GeodeticTiling::inParent(const TileIndex& index) const {
  assert(index.level > 0);
  const double v = 0.5 * (index.y % 2);
  if (splitsInLongitude(index.level - 1, index.y / 2)) {
    return {{0.5 * (index.x % 2), v}, {0.5, 0.5}};
  }
  return {{0.0, v}, {1.0, 0.5}};
}

std::optional<Neighbour> GeodeticTiling::neighbour(const TileIndex& index, Edge edge) const {
  const int exponent = columnsExponent(index.level, index.y);
  TileIndex other = index;
  if (edge == Edge::West || edge == Edge::East) {
    const std::uint32_t last = (std::uint32_t{1} << exponent) - 1;
    const bool east = edge == Edge::East;
    if (index.x == (east ? last : 0)) {
      other.root = static_cast<std::uint8_t>(1 - index.root);
      other.x = east ? 0 : last;
    } else {
      other.x = east ? index.x + 1 : index.x - 1;
    }
    return Neighbour{other, east ? Edge::West : Edge::East, 0.0, 1.0};
  }

  const bool south = edge == Edge::South;
  if (index.y == (south ? (std::uint32_t{1} << index.level) - 1 : 0)) {
    return std::nullopt;
  }
  other.y = south ? index.y + 1 : index.y - 1;
  int otherExponent = columnsExponent(other.level, other.y);
  // Towards the equator there may be more columns. Then the line between the rows is one of the parents' rows too,
  // since children of one row have equally many.
  while (otherExponent > exponent) {
    --other.level;
    other.y /= 2;
    otherExponent = columnsExponent(other.level, other.y);
  }
  const int shift = exponent - otherExponent;
  other.x = index.x >> shift;
  const std::uint32_t within = index.x - (other.x << shift);
  return Neighbour{other, south ? Edge::North : Edge::South, std::ldexp(static_cast<double>(within), -shift),
                   std::ldexp(1.0, -shift)};
}

GeodeticPosition GeodeticTiling::geodetic(const TileIndex& index, const glm::dvec2& uv) const {
  // Fractions of the whole way round and from pole to pole. At nodes (dyadic uv) they are exact, so every tile that
  // shares a node takes the same angles from them; they are brought into range before they become angles.
  double around =
      (static_cast<double>(index.x) + uv.x) * powerOfTwo(-columnsExponent(index.level, index.y) - 1) + 0.5 * index.root;
  double down = (static_cast<double>(index.y) + uv.y) * powerOfTwo(-index.level);
  if (down < 0.0 || down > 1.0) {
    down = down < 0.0 ? -down : 2.0 - down;
    around += 0.5;
  }
  if (around < 0.0 || around > 1.0) {
    around -= std::floor(around);
  }
  return {pi * (0.5 - down), pi * (2.0 * around - 1.0), 0.0};
}

TilePlace GeodeticTiling::locate(double latitude, double longitude, int level) const {
  assert(level >= 0 && level <= maximumLevel);
  const double down = std::isfinite(latitude) ? std::clamp(0.5 - latitude / pi, 0.0, 1.0) : 0.5;
  double around = std::isfinite(longitude) ? 0.5 + longitude / (2.0 * pi) : 0.5;
  if (around < 0.0 || around > 1.0) {
    around -= std::floor(around);
  }
  TilePlace place;
  place.index.level = static_cast<std::uint8_t>(level);
  place.index.root = around < 0.5 ? 0 : 1;

  const auto cell = [](double value, int exponent, std::uint32_t& number) {
    const double scaled = std::ldexp(value, exponent);
    number = static_cast<std::uint32_t>(std::min(std::floor(scaled), std::ldexp(1.0, exponent) - 1.0));
    return scaled - number;
  };
  place.uv.y = cell(down, level, place.index.y);
  place.uv.x = cell(2.0 * around - place.index.root, columnsExponent(level, place.index.y), place.index.x);
  return place;
}

}  // namespace meridian::globebrowsing
