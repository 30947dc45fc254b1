#include "globebrowsing/providers/tile_provider_by_level.h"

#include <algorithm>
#include <string>
#include <utility>

namespace meridian::globebrowsing {

namespace {

const Schema& entrySchema() {
  using Type = Schema::Type;
  static const Schema fields({{"MaxLevel", Type::Integer, "the greatest level of this provider", true, 0.0, 1000.0},
                              {"TileProvider", Type::Table, "the provider's table", true}});
  return fields;
}

}  // namespace

const Schema& TileProviderByLevel::schema() {
  static const Schema fields({{"LevelTileProviders", Schema::Type::Table,
                               "a list of tables, each with MaxLevel (inclusive) and TileProvider", true}});
  return fields;
}

Result<std::shared_ptr<TileProvider>> TileProviderByLevel::make(const ProviderRequest& request) {
  const std::vector<Value>& list = valueAt(request.table, "LevelTileProviders").table()->list;
  std::vector<std::pair<int, ProviderPointer>> entries;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const ProviderRequest entry =
        innerRequest(request, "LevelTileProviders[" + std::to_string(i + 1) + "]", list[i]);  // as Lua counts
    Result<ProviderPointer> made = entrySchema().validate(entry.table, entry.where, entry.path).and_then([&] {
      return makeInner(innerRequest(entry, "TileProvider", valueAt(entry.table, "TileProvider")));
    });
    if (!made) {
      return made;
    }
    entries.emplace_back(static_cast<int>(*valueAt(entry.table, "MaxLevel").number()), std::move(*made));
  }
  if (entries.empty()) {
    return failure("there are no providers by level", placeOf(request, "LevelTileProviders"),
                   "write { { MaxLevel = 5, TileProvider = { ... } } }");
  }
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<int> levels;
  std::vector<ProviderPointer> providers;
  for (auto& [level, provider] : entries) {
    levels.push_back(level);
    providers.push_back(std::move(provider));
  }
  return std::make_shared<TileProviderByLevel>(std::move(levels), std::move(providers));
}

Result<std::shared_ptr<TileProvider>> TileProviderByLevel::make(const Time& now) const {
  return providersAt(providers_, now)
      .map([this](std::vector<ProviderPointer> providers) -> std::shared_ptr<TileProvider> {
        return std::make_shared<TileProviderByLevel>(maximumLevels_, std::move(providers));
      });
}

std::size_t TileProviderByLevel::entryOf(int level) const {
  const auto found = std::lower_bound(maximumLevels_.begin(), maximumLevels_.end(), level + 1);
  return static_cast<std::size_t>(std::min(found, maximumLevels_.end() - 1) - maximumLevels_.begin());
}

Result<ColourPixels> TileProviderByLevel::makeColours(const Tiling& tiling, const TileIndex& index,
                                                      std::stop_token stop) const {
  return providers_[entryOf(index.level)]->colours(tiling, index, std::move(stop));
}

Result<HeightPixels> TileProviderByLevel::makeHeights(const Tiling& tiling, const TileIndex& index,
                                                      const TileLayout& layout, std::stop_token stop) const {
  return providers_[entryOf(index.level)]->heights(tiling, index, layout, std::move(stop));
}

std::unique_ptr<ColourTask> TileProviderByLevel::makeColourTask(const Tiling& tiling, const TileIndex& index) const {
  return providers_[entryOf(index.level)]->colourTask(tiling, index);
}

std::unique_ptr<HeightTask> TileProviderByLevel::makeHeightTask(const Tiling& tiling, const TileIndex& index,
                                                                const TileLayout& layout) const {
  return providers_[entryOf(index.level)]->heightTask(tiling, index, layout);
}

bool TileProviderByLevel::dataOverlap(const Tiling& tiling, const TileIndex& index) const {
  return providers_[entryOf(index.level)]->overlaps(tiling, index);
}

bool TileProviderByLevel::dataFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const {
  if (index.level + 1 >= maximumLevels_.back()) {
    return false;
  }
  // Another provider below shows something else, however fine it is.
  const std::size_t own = entryOf(index.level);
  for (std::size_t i = entryOf(index.level + 1); i < providers_.size(); ++i) {
    const TileProvider& provider = *providers_[i];
    if (i != own ? provider.overlaps(tiling, index) : provider.hasFiner(tiling, index, layout)) {
      return true;
    }
  }
  return false;
}

}  // namespace meridian::globebrowsing
