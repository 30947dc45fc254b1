#pragma once

#include <vector>

#include "globebrowsing/providers/inner_providers.h"

namespace meridian::globebrowsing {

/// One provider for most tiles and others for some: TileProviderByIndex.
///
/// Indices are OpenSpace's: at level L a regular grid of 2^L columns by 2^(L-1) rows, x from the antimeridian, y from
/// the north. L is one more than our level. Our tiles near the poles are wider than one of its cells: of such a tile
/// only the cell's part comes from the cell's provider. On tilings other than the geodetic one a cell is shown in the
/// tile that has its middle.
class TileProviderByIndex final : public TileProvider, private TileSteps {
 public:
  [[nodiscard]] static const Schema& schema();
  [[nodiscard]] static Result<std::shared_ptr<TileProvider>> make(const ProviderRequest& request);

  /// One of the grid's cells; edges in radians.
  struct Cell {
    int level = 0;  ///< ours
    double west = 0.0;
    double south = 0.0;
    double east = 0.0;
    double north = 0.0;
  };
  [[nodiscard]] static Cell cellOf(std::int64_t x, std::int64_t y, int openSpaceLevel);
  /// A tile that is being made.
  struct Target {
    const Tiling& tiling;
    TileIndex index;
    TileLayout layout;
  };

  /// The first provider is for all other tiles; then one for each cell.
  TileProviderByIndex(std::vector<Cell> cells, std::vector<ProviderPointer> providers)
      : cells_(std::move(cells)), providers_(std::move(providers)) {}

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
  template <class Pixels>
  class Task;
  /// The tile of all that it is made of; `make(i)` gives that of provider i.
  template <class Pixels, class Make>
  [[nodiscard]] Result<Pixels> compose(const Target& target, Make make) const;
  /// Whether the cell replaces a part of just that tile.
  [[nodiscard]] static bool isShown(const Cell& cell, const Tiling& tiling, const TileIndex& index);
  /// Whether the cell's middle is in the tile.
  [[nodiscard]] static bool isWithin(const Cell& cell, const Tiling& tiling, const TileIndex& index);

  std::vector<Cell> cells_;
  std::vector<ProviderPointer> providers_;
};

}  // namespace meridian::globebrowsing
