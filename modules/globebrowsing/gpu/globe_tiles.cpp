#include "globebrowsing/gpu/globe_tiles.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

namespace meridian::globebrowsing {

namespace {

/// A tile's nodes miss the peaks between them, and its children will show more: their share of the tile's own range.
constexpr double hiddenRelief = 0.1;
/// The relief of a body of which nothing is known yet: over three times Olympus Mons' share of Mars' radius.
constexpr double unknownRelief = 0.02;

}  // namespace

Result<std::unique_ptr<GlobeTiles>> GlobeTiles::create(graphics::Graphics& graphics,
                                                       std::shared_ptr<const Tiling> tiling, LayerManager& layers,
                                                       TileStreamer& streamer, const Options& options) {
  // A sixth of the pool is shapes, but at least what a globe of a few hundred pixels needs, or selection and eviction
  // would chase each other; the rest colours. Raw tiles are needed only while they are composed: one to every four
  // composites.
  constexpr std::size_t leastSurfaces = 128;
  constexpr std::size_t leastComposites = 12;
  const auto layersOfArray = [&](std::size_t count, std::size_t least) {
    const auto most = static_cast<std::size_t>(graphics.limits().textureLayers);
    return static_cast<std::uint32_t>(std::clamp(count, least, most));
  };
  const std::uint32_t surfaces =
      layersOfArray(options.texturePoolBytes / 6 / SurfacePool::bytesPerSlot(), leastSurfaces);
  const auto less = [](std::size_t from, std::size_t bytes) { return from - std::min(from, bytes); };
  const std::size_t colourBytes = less(options.texturePoolBytes, surfaces * SurfacePool::bytesPerSlot());
  const std::size_t units = colourBytes / (4 * Composer::bytesPerComposite() + Composer::bytesPerRawTile());
  const std::uint32_t rawTiles = layersOfArray(units, options.leastRawTiles);
  const std::uint32_t composites = layersOfArray(
      less(colourBytes, rawTiles * Composer::bytesPerRawTile()) / Composer::bytesPerComposite(), leastComposites);
  // Of relief tiles each composite needs one; with more of them settings that move need not upload them again.
  const std::uint32_t reliefTiles = layersOfArray(options.texturePoolBytes / 16 / ReliefTextures::bytesPerTile(), 4);
  auto composer = Composer::create(graphics, {composites, rawTiles, reliefTiles});
  if (!composer) {
    return tl::make_unexpected(std::move(composer.error()));
  }
  return std::unique_ptr<GlobeTiles>(
      new GlobeTiles(std::move(tiling), layers, streamer, std::move(*composer), surfaces, composites));
}

GlobeTiles::GlobeTiles(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
                       std::unique_ptr<Composer> composer, std::uint32_t surfaces, std::uint32_t composites)
    : tiling_(tiling),
      surfaces_(tiling, layers, streamer, surfaces),
      composites_(std::move(tiling), layers, streamer, std::move(composer), composites) {}

void GlobeTiles::beginFrame(std::uint64_t frame) {
  stale_ = 0;
  staleViews_ = 0;
  absent_ = 0;
  surfaces_.beginFrame(frame);
  composites_.beginFrame(frame);
}

void GlobeTiles::process(graphics::UploadBudget& uploads, double compositionMilliseconds) {
  surfaces_.upload(uploads);
  composites_.compose(compositionMilliseconds);
  composites_.endFrame();
}

void GlobeTiles::want(const TileIndex& index, int colourLevel, double priority, std::uint32_t views) {
  const bool shaped = surfaces_.want(index, priority);
  const CompositeStore::State coloured = composites_.want(index, colourLevel, priority);
  if (!shaped || !coloured.current) {
    ++stale_;
    staleViews_ |= views;
  }
  absent_ += surfaces_.find(index) != nullptr && coloured.present ? 0 : 1;
}

void GlobeTiles::renewShape(const TileIndex& index, double priority, std::uint32_t views) {
  if (surfaces_.isOutdated(index) && !surfaces_.want(index, priority)) {
    ++stale_;
    staleViews_ |= views;
  }
}

void GlobeTiles::keep(const TileIndex& index, int colourLevel) {
  surfaces_.keep(index);
  composites_.keep(index, colourLevel);
}

TileResidency::State GlobeTiles::state(const TileIndex& index, int colourLevel) const {
  if (surfaces_.find(index) == nullptr) {
    return State::Nothing;
  }
  // Colours of an earlier setting count: they are exchanged in place, and must not make the tree draw something
  // coarser.
  return composites_.state(index, colourLevel).present || composites_.full() ? State::Complete : State::Drawable;
}

HeightRange GlobeTiles::heightRange(const TileIndex& index) const {
  const SurfaceStore::KnownRange known = surfaces_.nearestRange(index);
  if (known.level < 0) {
    const double relief = unknownRelief * tiling_->ellipsoid().minimumRadius();
    return {-relief, relief};
  }
  const double margin = hiddenRelief * (known.range.maximum - known.range.minimum);
  return {known.range.minimum - margin, known.range.maximum + margin};
}

unsigned GlobeTiles::heightVersion(const TileIndex& index) const {
  return surfaces_.nearestRange(index).stamp;
}

SurfaceErrors GlobeTiles::surfaceErrors(const TileIndex& index) const {
  static_assert(SurfaceErrors::steps == chunk_grid::steps);
  SurfaceErrors errors;
  const SurfaceStore::Nearest nearest = surfaces_.nearest(index);
  if (nearest.surface == nullptr) {
    for (int step = 0; step < chunk_grid::steps; ++step) {
      const double halfSegment =
          std::numbers::pi / std::ldexp(static_cast<double>(2 * chunk_grid::segmentsAt(step)), index.level);
      errors.vertical[static_cast<std::size_t>(step)] =
          tiling_->ellipsoid().maximumRadius() * (1.0 - std::cos(halfSegment));
    }
    return errors;
  }
  // From level to level curvature's part falls to a quarter, and so does relief's below the resolution of its data;
  // above it, relief is as rough at half the size and falls to a half.
  double curvatureLeft = 1.0;
  double reliefLeft = 1.0;
  for (std::optional<TileIndex> at = nearest.level < index.level ? tiling_->parent(index) : std::nullopt;
       at && at->level >= nearest.level; at = tiling_->parent(*at)) {
    curvatureLeft *= 0.25;
    reliefLeft *= surfaces_.hasFinerHeights(*at) ? 0.5 : 0.25;
  }
  for (int step = 0; step < chunk_grid::steps; ++step) {
    const double curvature = nearest.surface->lift(step);
    const double relief = std::max(nearest.surface->error(step) - curvature, 0.0);
    const auto place = static_cast<std::size_t>(step);
    errors.vertical[place] = curvature * curvatureLeft + relief * reliefLeft;
    errors.along[place] = nearest.surface->drift(step) * curvatureLeft;
  }
  errors.unlike = nearest.isUnlike ? surfaces_.highestHeight() - surfaces_.lowestHeight() : 0.0;
  return errors;
}

std::string GlobeTiles::waitingFor(std::uint32_t views) const {
  const bool areStale = (staleViews_ & views) != 0;
  for (std::string reason : {surfaces_.waitingFor(), composites_.waitingFor(areStale)}) {
    if (!reason.empty()) {
      return reason;
    }
  }
  return areStale && !full() ? fmt::format("{} tiles are loading", stale_) : std::string();
}

}  // namespace meridian::globebrowsing
