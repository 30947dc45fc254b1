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
void forSamplesIn(const TileProviderByIndex::Cell& cell, const TileProviderByIndex::Target& target, Copy&& copy) {
  const TileLayout& layout = target.layout;
  for (int row = 0; row < layout.size(); ++row) {
    for (int column = 0; column < layout.size(); ++column) {
      const GeodeticPosition place = target.tiling.geodetic(target.index, layout.uv(column, row));
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

/// The cell's part of the tile; where it has nothing there will be nothing.
void put(const ColourPixels& part, const TileProviderByIndex::Cell& cell, const TileProviderByIndex::Target& target,
         ColourPixels& all) {
  all.size = target.layout.size();
  all.rgba.resize(4 * samples(target.layout));
  forSamplesIn(cell, target, [&](std::size_t sample) {
    for (std::size_t i = 4 * sample; i < 4 * sample + 4; ++i) {
      all.rgba[i] = part.rgba.empty() ? std::uint8_t{0} : part.rgba[i];
    }
  });
  renewSummary(all);
}

void put(const HeightPixels& part, const TileProviderByIndex::Cell& cell, const TileProviderByIndex::Target& target,
         HeightPixels& all) {
  constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
  all.size = target.layout.size();
  all.metres.resize(samples(target.layout), nothing);
  forSamplesIn(cell, target,
               [&](std::size_t sample) { all.metres[sample] = part.metres.empty() ? nothing : part.metres[sample]; });
  renewSummary(all);
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

bool TileProviderByIndex::isShown(const Cell& cell, const Tiling& tiling, const TileIndex& index) {
  return cell.level == index.level && isWithin(cell, tiling, index);
}

bool TileProviderByIndex::isWithin(const Cell& cell, const Tiling& tiling, const TileIndex& index) {
  return tiling.locate((cell.south + cell.north) / 2.0, (cell.west + cell.east) / 2.0, index.level).index == index;
}

template <class Pixels, class Make>
Result<Pixels> TileProviderByIndex::compose(const Target& target, Make make) const {
  Result<Pixels> all = make(0);
  for (std::size_t i = 0; i < cells_.size() && all; ++i) {
    if (!isShown(cells_[i], target.tiling, target.index)) {
      continue;
    }
    Result<Pixels> part = make(i + 1);
    if (!part) {
      return part;
    }
    put(*part, cells_[i], target, *all);
  }
  return all;
}

Result<ColourPixels> TileProviderByIndex::makeColours(const Tiling& tiling, const TileIndex& index,
                                                      std::stop_token stop) const {
  return compose<ColourPixels>({tiling, index, colourLayout}, [&](std::size_t provider) {
    return providers_[provider]->colours(tiling, index, stop);
  });
}

Result<HeightPixels> TileProviderByIndex::makeHeights(const Tiling& tiling, const TileIndex& index,
                                                      const TileLayout& layout, std::stop_token stop) const {
  return compose<HeightPixels>({tiling, index, layout}, [&](std::size_t provider) {
    return providers_[provider]->heights(tiling, index, layout, stop);
  });
}

/// Of the providers that the tile is made of, those that give theirs by and by.
template <class Pixels>
class TileProviderByIndex::Task final : public PixelTask<Pixels> {
 public:
  Task(const TileProviderByIndex& all, const Target& target)
      : all_(all), target_(target), parts_(all.providers_.size()) {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      if (i == 0 || isShown(all.cells_[i - 1], target.tiling, target.index)) {
        begin(*all.providers_[i], parts_[i]);
      }
    }
  }
  [[nodiscard]] bool isNeeded() const {
    return std::any_of(parts_.begin(), parts_.end(), [](const auto& part) { return part != nullptr; });
  }

  bool prepare(double priority, const std::function<void()>& wake) override {
    return std::all_of(parts_.begin(), parts_.end(),
                       [&](const auto& part) { return part == nullptr || part->prepare(priority, wake); });
  }
  void setPriority(double priority) override {
    for (const auto& part : parts_) {
      if (part != nullptr) {
        part->setPriority(priority);
      }
    }
  }
  Result<Pixels> make(const std::stop_token& stop) override {
    return all_.template compose<Pixels>(target_, [&](std::size_t i) {
      return parts_[i] != nullptr ? parts_[i]->make(stop) : atOnce(*all_.providers_[i], parts_[i], stop);
    });
  }
  std::optional<Error> flaw() const override {
    for (const auto& part : parts_) {
      if (std::optional<Error> flaw = part != nullptr ? part->flaw() : std::nullopt) {
        return flaw;
      }
    }
    return std::nullopt;
  }

 private:
  void begin(const TileProvider& provider, std::unique_ptr<ColourTask>& part) {
    part = provider.colourTask(target_.tiling, target_.index);
  }
  void begin(const TileProvider& provider, std::unique_ptr<HeightTask>& part) {
    part = provider.heightTask(target_.tiling, target_.index, target_.layout);
  }
  Result<ColourPixels> atOnce(const TileProvider& provider, const std::unique_ptr<ColourTask>&,
                              const std::stop_token& stop) const {
    return provider.colours(target_.tiling, target_.index, stop);
  }
  Result<HeightPixels> atOnce(const TileProvider& provider, const std::unique_ptr<HeightTask>&,
                              const std::stop_token& stop) const {
    return provider.heights(target_.tiling, target_.index, target_.layout, stop);
  }

  const TileProviderByIndex& all_;
  Target target_;
  std::vector<std::unique_ptr<PixelTask<Pixels>>> parts_;  ///< by provider; null where it needs none
};

std::unique_ptr<ColourTask> TileProviderByIndex::makeColourTask(const Tiling& tiling, const TileIndex& index) const {
  auto task = std::make_unique<Task<ColourPixels>>(*this, Target{tiling, index, colourLayout});
  return task->isNeeded() ? std::move(task) : nullptr;
}

std::unique_ptr<HeightTask> TileProviderByIndex::makeHeightTask(const Tiling& tiling, const TileIndex& index,
                                                                const TileLayout& layout) const {
  auto task = std::make_unique<Task<HeightPixels>>(*this, Target{tiling, index, layout});
  return task->isNeeded() ? std::move(task) : nullptr;
}

bool TileProviderByIndex::dataOverlap(const Tiling& tiling, const TileIndex& index) const {
  bool any = providers_[0]->overlaps(tiling, index);
  for (std::size_t i = 0; i < cells_.size() && !any; ++i) {
    any = isShown(cells_[i], tiling, index) && providers_[i + 1]->overlaps(tiling, index);
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
