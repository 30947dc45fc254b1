#pragma once

#include <vector>

#include "globebrowsing/providers/inner_providers.h"

namespace meridian::globebrowsing {

/// A provider for each range of levels: TileProviderByLevel. Levels are OpenSpace's, one more than ours.
class TileProviderByLevel final : public TileProvider, private TileSteps {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);

  /// The greatest level of each provider, ascending; at least one.
  TileProviderByLevel(std::vector<int> maximumLevels, std::vector<ProviderPointer> providers)
      : maximumLevels_(std::move(maximumLevels)), providers_(std::move(providers)) {}

  [[nodiscard]] const TileSteps* steps() const override { return anySteps(providers_) ? this : nullptr; }
  [[nodiscard]] Result<void> check() const override { return checkAll(providers_); }
  [[nodiscard]] std::optional<Error> lastFailure() const override { return lastFailureOf(providers_); }
  [[nodiscard]] std::optional<Error> flaw() const override { return flawOf(providers_); }
  [[nodiscard]] std::string_view attribution() const override { return attributionOf(providers_); }

 private:
  [[nodiscard]] TileStep at(const Time& now) const override { return stepOf(providers_, now); }
  [[nodiscard]] Result<std::shared_ptr<TileProvider>> make(const Time& now) const override;
  [[nodiscard]] bool prepareData(const std::function<void()>& wake) override {
    return prepareAll(providers_, steps() != nullptr, wake);
  }
  [[nodiscard]] Result<void> openData() override { return openAll(providers_, steps() != nullptr); }
  [[nodiscard]] Result<ColourPixels> makeColours(const Tiling& tiling, const TileIndex& index,
                                                 std::stop_token stop) const override;
  [[nodiscard]] Result<HeightPixels> makeHeights(const Tiling& tiling, const TileIndex& index, const TileLayout& layout,
                                                 std::stop_token stop) const override;
  [[nodiscard]] std::unique_ptr<ColourTask> makeColourTask(const Tiling& tiling, const TileIndex& index) const override;
  [[nodiscard]] std::unique_ptr<HeightTask> makeHeightTask(const Tiling& tiling, const TileIndex& index,
                                                           const TileLayout& layout) const override;
  [[nodiscard]] bool dataOverlap(const Tiling& tiling, const TileIndex& index) const override;
  [[nodiscard]] bool dataFiner(const Tiling& tiling, const TileIndex& index, const TileLayout& layout) const override;
  /// Of that level (ours); the last beyond all.
  [[nodiscard]] std::size_t entryOf(int level) const;

  std::vector<int> maximumLevels_;
  std::vector<ProviderPointer> providers_;
};

}  // namespace meridian::globebrowsing
