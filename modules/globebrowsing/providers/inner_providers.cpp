#include "globebrowsing/providers/inner_providers.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "host/api/log.h"

namespace meridian::globebrowsing {

ProviderRequest innerRequest(const ProviderRequest& outer, std::string_view key, const Value& table) {
  std::string path = outer.path;
  path.append(path.empty() ? "" : ".").append(key);
  return {table, outer.where, std::move(path), outer.folder, outer.sourceTiles, outer.share, outer.heightLimits};
}

Result<ProviderPointer> makeInner(const ProviderRequest& inner) {
  if (!inner.table.isTable()) {
    return failure("expected a provider's table, found " + std::string(kindName(inner.table.kind())),
                   placeOf(inner, {}), "write { FilePath = ... }");
  }
  return makeProvider(inner).and_then([&](ProviderPointer made) -> Result<ProviderPointer> {
    if (!made->hasTiles()) {
      return failure("a provider without tiles cannot be part of another", placeOf(inner, "Type"),
                     "put it into a layer of its own");
    }
    return made;
  });
}

ProviderRequest rasterRequest(const ProviderRequest& outer, std::string filePath) {
  Table table = outer.table.isTable() ? *outer.table.table() : Table{};
  table.fields["Type"] = std::string(name(LayerType::DefaultTileProvider));
  table.fields["FilePath"] = std::move(filePath);
  return {std::move(table), outer.where, outer.path, outer.folder, outer.sourceTiles, outer.share, outer.heightLimits};
}

const Value& valueAt(const Value& table, std::string_view key) {
  static const Value nil;
  const Value* value = table.find(key);
  return value == nullptr ? nil : *value;
}

Result<void> checkAll(std::span<const ProviderPointer> providers) {
  for (const ProviderPointer& provider : providers) {
    if (Result<void> checked = provider->check(); !checked) {
      return checked;
    }
  }
  return {};
}

std::optional<Error> lastFailureOf(std::span<const ProviderPointer> providers) {
  for (const ProviderPointer& provider : providers) {
    if (std::optional<Error> failure = provider->lastFailure()) {
      return failure;
    }
  }
  return std::nullopt;
}

std::optional<Error> flawOf(std::span<const ProviderPointer> providers) {
  for (const ProviderPointer& provider : providers) {
    if (std::optional<Error> flaw = provider->flaw()) {
      return flaw;
    }
  }
  return std::nullopt;
}

std::string_view attributionOf(std::span<const ProviderPointer> providers) {
  for (const ProviderPointer& provider : providers) {
    if (const std::string_view attribution = provider->attribution(); !attribution.empty()) {
      return attribution;
    }
  }
  return {};
}

bool prepareAll(std::span<const ProviderPointer> providers, bool onlySteps, const std::function<void()>& wake) {
  return std::all_of(providers.begin(), providers.end(), [&](const ProviderPointer& provider) {
    return (onlySteps && provider->steps() == nullptr) || provider->prepare(wake);
  });
}

Result<void> openAll(std::span<const ProviderPointer> providers, bool onlySteps) {
  std::optional<Error> first;
  bool anyOpen = providers.empty();
  for (const ProviderPointer& provider : providers) {
    if (onlySteps && provider->steps() == nullptr) {
      anyOpen = true;
      continue;
    }
    const Result<void> opened = provider->open();
    anyOpen = anyOpen || opened;
    if (!opened) {
      log::error("{}", opened.error().message());
      first = first ? first : opened.error();
    }
  }
  return anyOpen ? Result<void>() : tl::make_unexpected(*first);
}

bool anySteps(std::span<const ProviderPointer> providers) {
  return std::any_of(providers.begin(), providers.end(),
                     [](const ProviderPointer& provider) { return provider->steps() != nullptr; });
}

TileStep stepOf(std::span<const ProviderPointer> providers, const Time& now) {
  TileStep all;
  for (const ProviderPointer& provider : providers) {
    if (provider->steps() == nullptr || provider->state() != TileProvider::State::Ready) {
      continue;
    }
    const TileStep one = provider->steps()->at(now);
    all = {combineIds(all.id, one.id), std::max(all.begin, one.begin), std::min(all.end, one.end)};
  }
  return all;
}

Result<std::vector<ProviderPointer>> providersAt(std::span<const ProviderPointer> providers, const Time& now) {
  std::vector<ProviderPointer> found;
  found.reserve(providers.size());
  for (const ProviderPointer& provider : providers) {
    // One that could not be opened stays as it is: it has nothing to show.
    if (provider->steps() == nullptr || provider->state() != TileProvider::State::Ready) {
      found.push_back(provider);
      continue;
    }
    Result<ProviderPointer> step = provider->steps()->make(now);
    if (!step) {
      return tl::make_unexpected(std::move(step.error()));
    }
    found.push_back(std::move(*step));
  }
  return found;
}

}  // namespace meridian::globebrowsing
