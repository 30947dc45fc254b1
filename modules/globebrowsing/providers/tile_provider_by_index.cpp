#include "globebrowsing/providers/tile_provider_by_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace meridian::globebrowsing {

namespace {

constexpr double pi = std::numbers::pi;

const Schema& indexSchema() {
  using Type = Schema::Type;
  static const Schema fields({{"X", Type::Integer, "the column, from the antimeridian", true, 0.0, 8388607.0},
                              {"Y", Type::Integer, "the row, from the north", true, 0.0, 8388607.0},
                              {"Level", Type::Integer, "1: two tiles", true, 0.0, 23.0}});
  return fields;
}

/// The value of the first of the keys that is there, and which it is.
std::pair<std::string, Value> firstOf(const Value& table, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    if (const Value& value = valueAt(table, key); !value.isNil()) {
      return {key, value};
    }
  }
  return {*keys.begin(), {}};
}

Result<TileProviderByIndex::Cell> readCell(const ProviderRequest& entry) {
  const auto [key, value] = firstOf(entry.table, {"Index", "TileIndex"});
  const ProviderRequest index = innerRequest(entry, key, value);
  if (Result<void> valid = indexSchema().validate(index.table, index.where, index.path); !valid) {
    return tl::make_unexpected(std::move(valid.error()));
  }
  const auto number = [&value = index.table](const char* of) {
    return static_cast<std::int64_t>(*valueAt(value, of).number());
  };
  const std::int64_t columns = std::int64_t{1} << number("Level");
  const std::int64_t rows = std::max<std::int64_t>(1, columns / 2);
  if (number("Level") < 1 || number("X") >= columns || number("Y") >= rows) {
    return failure(
        fmt::format("there is no tile X = {}, Y = {} at level {}", number("X"), number("Y"), number("Level")),
        placeOf(index, {}), fmt::format("from level 1 on there are 2^Level columns and half as many rows"));
  }
  return TileProviderByIndex::cellOf(number("X"), number("Y"), static_cast<int>(number("Level")));
}

/// Calls `copy` with the place of every sample of the tile that lies within the cell. What lies on its edges belongs to
/// the tiles beside as well, which know nothing of the cell.
template <class Copy>
void forSamplesIn(const TileProviderByIndex::Cell& cell, const Tiling& tiling, const TileIndex& index,
                  const TileLayout& layout, Copy&& copy) {
  for (int row = 0; row < layout.size(); ++row) {
    for (int column = 0; column < layout.size(); ++column) {
      const GeodeticPosition place = tiling.geodetic(index, layout.uv(column, row));
      const double longitude = std::remainder(place.longitude, 2.0 * pi);
      if (longitude > cell.west && longitude < cell.east && place.latitude > cell.south &&
          place.latitude < cell.north) {
        copy(static_cast<std::size_t>(row) * static_cast<std::size_t>(layout.size()) +
             static_cast<std::size_t>(column));
      }
    }
  }
}

void renewSummary(ColourPixels& pixels) {
  pixels.anyOpaque = false;
  pixels.allOpaque = true;
  for (std::size_t i = 3; i < pixels.rgba.size(); i += 4) {
    pixels.anyOpaque = pixels.anyOpaque || pixels.rgba[i] > 0;
    pixels.allOpaque = pixels.allOpaque && pixels.rgba[i] == 255;
  }
}

void renewSummary(HeightPixels& pixels) {
  pixels.any = false;
  pixels.minimum = std::numeric_limits<float>::max();
  pixels.maximum = std::numeric_limits<float>::lowest();
  for (const float metres : pixels.metres) {
    if (!std::isnan(metres)) {
      pixels.any = true;
      pixels.minimum = std::min(pixels.minimum, metres);
      pixels.maximum = std::max(pixels.maximum, metres);
    }
  }
  if (!pixels.any) {
    pixels.minimum = pixels.maximum = 0.0F;
  }
}

std::size_t samples(const TileLayout& layout) {
  return static_cast<std::size_t>(layout.size()) * static_cast<std::size_t>(layout.size());
}

}  // namespace

const Schema& TileProviderByIndex::schema() {
  using Type = Schema::Type;
  static const Schema fields(
      {{"DefaultTileProvider", Type::Table, "the provider of all other tiles (DefaultProvider in older assets)"},
       {"TileProviders", Type::Table,
        "a list of tables, each with Index = { X, Y, Level } and TileProvider (IndexTileProviders and TileIndex in "
        "older "
        "assets)"}});
  return fields;
}

TileProviderByIndex::Cell TileProviderByIndex::cellOf(std::int64_t x, std::int64_t y, int openSpaceLevel) {
  const double side = 2.0 * pi / std::ldexp(1.0, openSpaceLevel);
  return {openSpaceLevel - 1, -pi + side * static_cast<double>(x), pi / 2.0 - side * static_cast<double>(y + 1),
          -pi + side * static_cast<double>(x + 1), pi / 2.0 - side * static_cast<double>(y)};
}

Result<std::shared_ptr<TileProvider>> TileProviderByIndex::make(const ProviderRequest& request) {
  const auto [defaultKey, defaultTable] = firstOf(request.table, {"DefaultTileProvider", "DefaultProvider"});
  Result<ProviderPointer> made = makeInner(innerRequest(request, defaultKey, defaultTable));
  if (!made) {
    return made;
  }
  std::vector<ProviderPointer> providers{std::move(*made)};
  std::vector<Cell> cells;
  const auto [listKey, list] = firstOf(request.table, {"TileProviders", "IndexTileProviders"});
  const std::size_t count = list.isTable() ? list.table()->list.size() : 0;
  for (std::size_t i = 0; i < count; ++i) {
    const ProviderRequest entry =
        innerRequest(request, fmt::format("{}[{}]", listKey, i + 1), list.table()->list[i]);  // as Lua counts
    const Result<Cell> cell = readCell(entry);
    if (!cell) {
      return tl::make_unexpected(cell.error());
    }
    made = makeInner(innerRequest(entry, "TileProvider", valueAt(entry.table, "TileProvider")));
    if (!made) {
      return made;
    }
    cells.push_back(*cell);
    providers.push_back(std::move(*made));
  }
  return std::make_shared<TileProviderByIndex>(std::move(cells), std::move(providers));
}

Result<std::shared_ptr<TileProvider>> TileProviderByIndex::make(const Time& now) const {
  return providersAt(providers_, now)
      .map([this](std::vector<ProviderPointer> providers) -> std::shared_ptr<TileProvider> {
        return std::make_shared<TileProviderByIndex>(cells_, std::move(providers));
      });
}

bool TileProviderByIndex::isWithin(const Cell& cell, const Tiling& tiling, const TileIndex& index) {
  return tiling.locate((cell.south + cell.north) / 2.0, (cell.west + cell.east) / 2.0, index.level).index == index;
}

Result<ColourPixels> TileProviderByIndex::makeColours(const Tiling& tiling, const TileIndex& index,
                                                      std::stop_token stop) const {
  Result<ColourPixels> all = providers_[0]->colours(tiling, index, stop);
  for (std::size_t i = 0; i < cells_.size() && all; ++i) {
    if (cells_[i].level != index.level || !isWithin(cells_[i], tiling, index)) {
      continue;
    }
    Result<ColourPixels> part = providers_[i + 1]->colours(tiling, index, stop);
    if (!part) {
      return part;
    }
    all->size = colourLayout.size();
    all->rgba.resize(4 * samples(colourLayout));
    part->rgba.resize(all->rgba.size());
    forSamplesIn(cells_[i], tiling, index, colourLayout, [&](std::size_t sample) {
      std::copy_n(part->rgba.begin() + static_cast<std::ptrdiff_t>(4 * sample), 4,
                  all->rgba.begin() + static_cast<std::ptrdiff_t>(4 * sample));
    });
    renewSummary(*all);
  }
  return all;
}

Result<HeightPixels> TileProviderByIndex::makeHeights(const Tiling& tiling, const TileIndex& index,
                                                      std::stop_token stop) const {
  constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
  Result<HeightPixels> all = providers_[0]->heights(tiling, index, stop);
  for (std::size_t i = 0; i < cells_.size() && all; ++i) {
    if (cells_[i].level != index.level || !isWithin(cells_[i], tiling, index)) {
      continue;
    }
    Result<HeightPixels> part = providers_[i + 1]->heights(tiling, index, stop);
    if (!part) {
      return part;
    }
    all->size = heightLayout.size();
    all->metres.resize(samples(heightLayout), nothing);
    part->metres.resize(all->metres.size(), nothing);
    forSamplesIn(cells_[i], tiling, index, heightLayout,
                 [&](std::size_t sample) { all->metres[sample] = part->metres[sample]; });
    renewSummary(*all);
  }
  return all;
}

bool TileProviderByIndex::dataOverlap(const Tiling& tiling, const TileIndex& index) const {
  bool any = providers_[0]->overlaps(tiling, index);
  for (std::size_t i = 0; i < cells_.size() && !any; ++i) {
    any = cells_[i].level == index.level && isWithin(cells_[i], tiling, index) &&
          providers_[i + 1]->overlaps(tiling, index);
  }
  return any;
}

bool TileProviderByIndex::dataFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const {
  // Below a cell's tile the default is shown again, which is something else however fine it is.
  bool any = providers_[0]->hasFiner(tiling, index, layout);
  for (std::size_t i = 0; i < cells_.size() && !any; ++i) {
    any = cells_[i].level >= index.level && isWithin(cells_[i], tiling, index);
  }
  return any;
}

}  // namespace meridian::globebrowsing
