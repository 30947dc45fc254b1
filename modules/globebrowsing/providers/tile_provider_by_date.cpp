#include "globebrowsing/providers/tile_provider_by_date.h"

#include <algorithm>
#include <utility>

#include "globebrowsing/providers/date_text.h"

namespace meridian::globebrowsing {

const Schema& TileProviderByDate::schema() {
  static const Schema fields(
      {{"Providers", Schema::Type::Table, "providers' tables, each by the date from which it is shown", true}});
  return fields;
}

Result<std::shared_ptr<TileProvider>> TileProviderByDate::make(const ProviderRequest& request) {
  const Table& table = *valueAt(request.table, "Providers").table();
  std::vector<Entry> entries;
  for (const auto& [date, value] : table.fields) {
    ProviderRequest inner = innerRequest(request, "Providers[\"" + date + "\"]", value);
    const Result<Time::UtcInstant> since = readDate(date);
    if (!since) {
      return failure(since.error().what, placeOf(inner, {}), since.error().remedy);
    }
    entries.push_back({Time::fromUtcInstant(*since), std::move(inner)});
  }
  if (entries.empty()) {
    return failure("there are no providers by date", placeOf(request, "Providers"),
                   "write { [\"2004-01-01\"] = { FilePath = ... } }");
  }
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.since < b.since; });
  std::vector<ProviderPointer> providers;
  for (const Entry& entry : entries) {
    Result<ProviderPointer> made = makeInner(entry.request);
    if (!made) {
      return made;
    }
    providers.push_back(std::move(*made));
  }
  return std::make_shared<TileProviderByDate>(std::move(entries), std::move(providers));
}

std::size_t TileProviderByDate::entryAt(const Time& now) const {
  const auto later = std::upper_bound(entries_.begin(), entries_.end(), now,
                                      [](const Time& time, const Entry& entry) { return time < entry.since; });
  return later == entries_.begin() ? 0 : static_cast<std::size_t>(later - entries_.begin()) - 1;
}

TileStep TileProviderByDate::at(const Time& now) const {
  const std::size_t entry = entryAt(now);
  TileStep step = stepOf({&providers_[entry], 1}, now);
  step.id = combineIds(step.id, entry + 1);
  if (entry > 0) {
    step.begin = std::max(step.begin, entries_[entry].since);
  }
  if (entry + 1 < entries_.size()) {
    step.end = std::min(step.end, entries_[entry + 1].since);
  }
  return step;
}

Result<std::shared_ptr<TileProvider>> TileProviderByDate::make(const Time& now) const {
  const std::size_t entry = entryAt(now);
  if (providers_[entry]->steps() == nullptr) {
    return makeInner(entries_[entry].request);  // a new one, so that it is closed when its time has passed
  }
  return providersAt({&providers_[entry], 1}, now).map([](std::vector<ProviderPointer> found) {
    return std::move(found.front());
  });
}

}  // namespace meridian::globebrowsing
