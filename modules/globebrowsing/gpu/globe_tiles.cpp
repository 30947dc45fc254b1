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
  // A sixth of the pool is shapes, the rest colours. Raw tiles are needed only while they are composed: one to every
  // four composites.
  const std::size_t surfaceBytes = options.texturePoolBytes / 6;
  const std::size_t colourBytes = options.texturePoolBytes - surfaceBytes;
  const std::size_t units = colourBytes / (4 * Composer::bytesPerComposite() + Composer::bytesPerRawTile());
  const auto layersOfArray = [&](std::size_t count) {
    const auto most = static_cast<std::size_t>(graphics.limits().textureLayers);
    return static_cast<std::uint32_t>(std::clamp<std::size_t>(count, 8, most));
  };
  const std::uint32_t surfaces = layersOfArray(surfaceBytes / SurfacePool::bytesPerSlot());
  const std::uint32_t rawTiles = layersOfArray(std::max<std::size_t>(units, options.leastRawTiles));
  const std::size_t rawBytes = std::min(colourBytes, rawTiles * Composer::bytesPerRawTile());
  const std::uint32_t composites = layersOfArray((colourBytes - rawBytes) / Composer::bytesPerComposite());
  return Composer::create(graphics, {composites, rawTiles}).map([&](std::unique_ptr<Composer> composer) {
    return std::unique_ptr<GlobeTiles>(
        new GlobeTiles(std::move(tiling), layers, streamer, std::move(composer), surfaces, composites));
  });
}

GlobeTiles::GlobeTiles(std::shared_ptr<const Tiling> tiling, LayerManager& layers, TileStreamer& streamer,
                       std::unique_ptr<Composer> composer, std::uint32_t surfaces, std::uint32_t composites)
    : tiling_(tiling),
      surfaces_(tiling, layers, streamer, surfaces),
      composites_(std::move(tiling), layers, streamer, std::move(composer), composites) {}

void GlobeTiles::beginFrame(std::uint64_t frame) {
  stale_ = 0;
  surfaces_.beginFrame(frame);
  composites_.beginFrame(frame);
}

void GlobeTiles::process(graphics::UploadBudget& uploads, double compositionMilliseconds) {
  surfaces_.upload(uploads);
  composites_.compose(compositionMilliseconds);
  composites_.endFrame();
}

void GlobeTiles::want(const TileIndex& index, int colourLevel, double priority) {
  const bool shaped = surfaces_.want(index, priority);
  const bool coloured = composites_.want(index, colourLevel, priority).current;
  stale_ += shaped && coloured ? 0 : 1;
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
  const SurfaceStore::Nearest nearest = surfaces_.nearest(index);
  if (nearest.surface == nullptr) {
    const double relief = unknownRelief * tiling_->ellipsoid().minimumRadius();
    return {-relief, relief};
  }
  const HeightRange range = nearest.surface->heightRange();
  const double margin = hiddenRelief * (range.maximum - range.minimum);
  return {range.minimum - margin, range.maximum + margin};
}

unsigned GlobeTiles::heightVersion(const TileIndex& index) const {
  return surfaces_.nearest(index).stamp;
}

double GlobeTiles::geometricError(const TileIndex& index, int step) const {
  const SurfaceStore::Nearest nearest = surfaces_.nearest(index);
  if (nearest.surface == nullptr) {
    const double halfSegment =
        std::numbers::pi / std::ldexp(static_cast<double>(2 * chunk_grid::segmentsAt(step)), index.level);
    return tiling_->ellipsoid().maximumRadius() * (1.0 - std::cos(halfSegment));
  }
  // Curvature's part falls to a quarter per level, relief's to a half or so.
  return std::ldexp(nearest.surface->error(step), nearest.level - index.level);
}

std::string GlobeTiles::waitingFor() const {
  for (std::string reason : {surfaces_.waitingFor(), composites_.waitingFor()}) {
    if (!reason.empty()) {
      return reason;
    }
  }
  return stale_ > 0 && !full() ? fmt::format("{} tiles are loading", stale_) : std::string();
}

}  // namespace meridian::globebrowsing
