#pragma once

#include <vector>

#include "globebrowsing/providers/inner_providers.h"

namespace meridian::globebrowsing {

/// A provider for each stretch of time: TileProviderByDate. The latest whose date is not later is shown; before the
/// first, that.
class TileProviderByDate final : public SteppedTileProvider {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);

  struct Entry {
    Time since;
    ProviderRequest request;
  };
  /// At least one entry, in the order of their dates, and a provider of each.
  TileProviderByDate(std::vector<Entry> entries, std::vector<ProviderPointer> providers)
      : entries_(std::move(entries)), providers_(std::move(providers)) {}

  [[nodiscard]] Result<void> check() const override { return checkAll(providers_); }
  [[nodiscard]] TileStep at(const Time& now) const override;
  [[nodiscard]] Result<std::shared_ptr<TileProvider>> make(const Time& now) const override;

 private:
  /// Those that have steps; the others are opened when their time comes.
  [[nodiscard]] bool prepareData(const std::function<void()>& wake) override {
    return prepareAll(providers_, true, wake);
  }
  [[nodiscard]] Result<void> openData() override { return openAll(providers_, true); }
  [[nodiscard]] std::size_t entryAt(const Time& now) const;

  std::vector<Entry> entries_;
  std::vector<ProviderPointer> providers_;
};

}  // namespace meridian::globebrowsing
