#pragma once

#include <map>
#include <memory>
#include <optional>

#include "globebrowsing/source/service_pyramid.h"
#include "globebrowsing/source/source_tile.h"

namespace meridian::globebrowsing {

/// A tile in a plan: what is needed of it.
struct PlannedTile {
  std::size_t level = 0;
  PixelWindow pixels;     ///< of the level; the least rectangle about all that is needed
  bool isAsked = true;    ///< false: the service says itself that it does not have it
  bool isAbsent = false;  ///< so the next coarser level stands in for it
  PixelWindow standIn{};  ///< the part for which that has been noted
  SourceTilePointer tile{};
};
using PlannedTiles = std::map<TileAddress, PlannedTile>;

/// Which source tiles a tile needs: resampling with this reader notes them, and their needed parts, instead of reading.
/// A plan of more than `mostTiles` is given up: the coarsest matrix is much finer than the tile, and services that
/// begin so deep show nothing from farther away.
class TilePlan final : public PixelReader {
 public:
  static constexpr std::size_t mostTiles = 512;

  /// `pyramid` outlives the plan.
  explicit TilePlan(const ServicePyramid& pyramid);

  [[nodiscard]] const Pyramid& pyramid() const override { return pyramid_.pyramid(); }
  [[nodiscard]] const Projection* projection() const override { return projection_.get(); }
  [[nodiscard]] bool isPlan() const override { return true; }
  [[nodiscard]] Result<void> fetch(std::size_t level, const UnboundedWindow& window, Rgba* out,
                                   const std::stop_token& stop) override;
  [[nodiscard]] Result<void> fetch(std::size_t level, const UnboundedWindow& window, float* out,
                                   const std::stop_token& stop) override;

  /// Of absent tiles, the parts that are needed are taken from the next coarser level: notes what that takes, down to
  /// tiles of which it is not known yet whether they are absent.
  void addStandIns(PixelKind kind);

  /// Empty when it was given up.
  [[nodiscard]] PlannedTiles& tiles() { return tiles_; }

 private:
  void note(std::size_t level, const PixelWindow& window);

  const ServicePyramid& pyramid_;
  std::unique_ptr<Projection> projection_;
  PlannedTiles tiles_;
  PlannedTile* last_ = nullptr;  ///< noted last; most samples need the same
  bool isGivenUp_ = false;
};

/// Reads the pixels of a plan whose tiles are there or absent. What was not planned is absent as well.
class TileMosaic final : public PixelReader {
 public:
  /// Both outlive the mosaic.
  TileMosaic(const ServicePyramid& pyramid, const PlannedTiles& tiles, const HeightLimits& limits = {});

  [[nodiscard]] const Pyramid& pyramid() const override { return pyramid_.pyramid(); }
  [[nodiscard]] const Projection* projection() const override { return projection_.get(); }
  [[nodiscard]] Result<void> fetch(std::size_t level, const UnboundedWindow& window, Rgba* out,
                                   const std::stop_token& stop) override;
  [[nodiscard]] Result<void> fetch(std::size_t level, const UnboundedWindow& window, float* out,
                                   const std::stop_token& stop) override;
  /// A height that was read and is beyond the limits; such have no data.
  [[nodiscard]] const std::optional<double>& implausible() const { return implausible_; }

 private:
  template <class Pixel>
  Result<void> assemble(std::size_t level, const UnboundedWindow& window, Pixel* out, const std::stop_token& stop);
  template <class Pixel>
  Result<void> fill(const TilePart& part, const PlannedTile& planned, Pixel* out, std::ptrdiff_t stride,
                    const std::stop_token& stop);

  const ServicePyramid& pyramid_;
  std::unique_ptr<Projection> projection_;
  const PlannedTiles& tiles_;
  HeightLimits limits_;
  std::optional<double> implausible_;
};

}  // namespace meridian::globebrowsing
