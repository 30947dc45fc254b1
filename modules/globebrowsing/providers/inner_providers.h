#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "globebrowsing/providers/provider_registry.h"
#include "globebrowsing/providers/tile_steps.h"

namespace meridian::globebrowsing {

/// Providers that are made of others: by level, by index, by date, and series in time.
using ProviderPointer = std::shared_ptr<TileProvider>;

/// The request for a table within the outer one's: `key` is its path there ("LevelTileProviders[1].TileProvider").
[[nodiscard]] ProviderRequest innerRequest(const ProviderRequest& outer, std::string_view key, const Value& table);
/// Makes the provider of such a table. Errors: no table; a type without tiles; its own.
[[nodiscard]] Result<ProviderPointer> makeInner(const ProviderRequest& inner);
/// A raster with the keys of the outer table: what series in time and image sequences consist of.
[[nodiscard]] ProviderRequest rasterRequest(const ProviderRequest& outer, std::string filePath);

/// The keys of a table's sub-table, or of an item of one. Nil where there is none.
[[nodiscard]] const Value& valueAt(const Value& table, std::string_view key);

/// The first complaint of any.
[[nodiscard]] Result<void> checkAll(std::span<const ProviderPointer> providers);
/// The first that there is of any.
[[nodiscard]] std::optional<Error> lastFailureOf(std::span<const ProviderPointer> providers);
[[nodiscard]] std::optional<Error> flawOf(std::span<const ProviderPointer> providers);
/// The first that there is of any, as TileProvider::attribution.
[[nodiscard]] std::string_view attributionOf(std::span<const ProviderPointer> providers);
/// Prepares them for being opened, one after the other, as TileProvider::prepare.
[[nodiscard]] bool prepareAll(std::span<const ProviderPointer> providers, bool onlySteps,
                              const std::function<void()>& wake);
/// Opens them (`onlySteps`: those that have steps), one after the other. Some may fail, which is logged; all failing is
/// an error.
[[nodiscard]] Result<void> openAll(std::span<const ProviderPointer> providers, bool onlySteps);

[[nodiscard]] bool anySteps(std::span<const ProviderPointer> providers);
/// What all of them together show: the times that their steps have in common.
[[nodiscard]] TileStep stepOf(std::span<const ProviderPointer> providers, const Time& now);
/// Each one's provider of that time's tiles; those without steps as they are.
[[nodiscard]] Result<std::vector<ProviderPointer>> providersAt(std::span<const ProviderPointer> providers,
                                                               const Time& now);

}  // namespace meridian::globebrowsing
