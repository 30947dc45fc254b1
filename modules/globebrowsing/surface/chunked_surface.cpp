#include "globebrowsing/surface/chunked_surface.h"

#include <chrono>
#include <string_view>

#include <fmt/format.h>

#include "globebrowsing/surface/height_query.h"
#include "host/api/log.h"
#include "host/api/statistics.h"

namespace meridian::globebrowsing {

namespace {

constexpr std::string_view tooSmallPool = "the texture pool is too small for this view; raise TexturePoolSize";
constexpr std::string_view tooManyChunks =
    "a globe asks for more chunks than can be drawn, so coarser ones are; look for heights that are out of proportion, "
    "or lower TargetLodScaleFactor";
constexpr std::uint32_t allViews = ~std::uint32_t{0};
/// Selection serves the first 32; what others see is not known.
constexpr std::uint32_t bitOf(std::size_t view) {
  return view < 32 ? std::uint32_t{1} << view : allViews;
}
/// A globe coming nearer soon gets a larger pool.
constexpr int framesUntilTold = 120;

}  // namespace

Result<std::unique_ptr<ChunkedSurface>> ChunkedSurface::create(Parts parts, const GlobeTiles::Options& options) {
  Result<std::unique_ptr<GlobeTiles>> tiles =
      GlobeTiles::create(*parts.graphics, parts.tiling, *parts.layers, *parts.streamer, options);
  if (!tiles) {
    return tl::make_unexpected(std::move(tiles.error()));
  }
  return std::unique_ptr<ChunkedSurface>(new ChunkedSurface(std::move(parts), std::move(*tiles)));
}

ChunkedSurface::ChunkedSurface(Parts parts, std::unique_ptr<GlobeTiles> tiles)
    : parts_(std::move(parts)), tiles_(std::move(tiles)), renderer_(*parts_.graphics), tree_(*parts_.tiling) {}

void ChunkedSurface::update(const FrameContext& frame, const SurfaceSettings& settings) {
  settings_ = settings;
  if (frameOpen_) {
    renderer_.endFrame();
  }
  frameOpen_ = true;
  renderer_.beginFrame();
  tiles_->beginFrame(frame.number);
  const ChunkProgramKey key{settings.shading,
                            settings.shading && settings.accurateNormals,
                            settings.shading && tiles_->composites().inUse(CompositeKind::Night),
                            tiles_->composites().inUse(CompositeKind::Overlay),
                            settings.shading && tiles_->composites().hasWater(),
                            settings.showEdges,
                            settings.opacity < 1.0,
                            tiles_->composites().fading()};
  if (const Result<void> program = renderer_.programs().set(key); !program) {
    if (programTrouble_ != program.error().message()) {
      programTrouble_ = program.error().message();
      log::error("{}", programTrouble_);
    }
  }
  tiles_->composites().setMixing(renderer_.programs().key().fade);
  select(frame, settings);
  if (renderer_.programs().ready() && !renderer_.programs().hasPreparedFades() &&
      tiles_->waitingFor(allViews).empty()) {
    renderer_.programs().prepareFades();
  }
  tiles_->process(parts_.graphics->uploads(), settings.compositionMilliseconds);
  tellWhenFull();
  tellWhenCoarse();
}

void ChunkedSurface::tellWhenCoarse() {
  if (tree_.figures().coarsening > 1.0 && !toldCoarse_) {
    toldCoarse_ = true;
    log::warning("{}", tooManyChunks);
  }
}

void ChunkedSurface::tellWhenFull() {
  fullFrames_ = tiles_->full() ? fullFrames_ + 1 : 0;
  if (fullFrames_ == framesUntilTold) {
    log::warning("{}", tooSmallPool);
  }
}

void ChunkedSurface::select(const FrameContext& frame, const SurfaceSettings& settings) {
  const auto start = std::chrono::steady_clock::now();
  views_.clear();
  for (const View& view : frame.views) {
    views_.push_back({view.cameraPosition, view.clipFromCamera * view.cameraFromModel, view.pixelsPerRadian});
  }
  SelectionSettings selection = settings.selection;
  selection.lowestHeight = tiles_->surfaces().lowestHeight();
  tree_.select(views_, selection, *tiles_);
  Statistics& statistics = parts_.graphics->statistics();
  statistics.frame.select +=
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  const SelectionFigures& figures = tree_.figures();
  statistics.chunks.drawn += static_cast<std::uint32_t>(tree_.selected().size());
  statistics.chunks.tree += figures.nodes;
  statistics.chunks.culledFrustum += figures.culledFrustum;
  statistics.chunks.culledHorizon += figures.culledHorizon;
}

void ChunkedSurface::draw(const FrameContext& frame, std::size_t view) {
  renderer_.draw({tree_.selected(), &frame.views[view], view, settings_.ambient, settings_.opacity,
                  settings_.waterReflectance, true},
                 *tiles_);
}

bool ChunkedSurface::filled() const {
  // A pool that is too small stays as it is, with what is late as well.
  return renderer_.programs().ready() && (tiles_->full() || (tiles_->filled() && tree_.figures().atTarget));
}

Settled ChunkedSurface::settled(std::size_t view) const {
  // Programs, layers and the pool serve all views: what is wrong with them is so with each.
  if (!programTrouble_.empty()) {
    return {true, programTrouble_};
  }
  if (const std::string error = renderer_.programs().error(); !error.empty()) {
    return {true, error};
  }
  if (!renderer_.programs().ready()) {
    return {false, "the program that draws chunks is being built"};
  }
  if (std::string error = tiles_->composites().composer().programs().error(CompositeKind::Base); !error.empty()) {
    return {true, std::move(error)};
  }
  if (std::string reason = tiles_->waitingFor(bitOf(view)); !reason.empty()) {
    return {false, std::move(reason)};
  }
  if (tiles_->full()) {
    return {true, std::string(tooSmallPool)};
  }
  if ((tree_.figures().viewsShortOfTarget & bitOf(view)) != 0) {
    const std::uint32_t missing = tree_.figures().missing;
    return {false, missing > 0 ? fmt::format("{} chunks are not at their target", missing) : "chunks become finer"};
  }
  if (tree_.figures().coarsening > 1.0) {
    return {true, std::string(tooManyChunks)};
  }
  return {};
}

double ChunkedSurface::heightAt(double latitude, double longitude) const {
  return globebrowsing::heightAt(tiles_->surfaces(), *parts_.tiling, latitude, longitude);
}

std::optional<glm::dvec3> ChunkedSurface::pick(const glm::dvec3& origin, const glm::dvec3& direction) const {
  return globebrowsing::pick(tiles_->surfaces(), *parts_.tiling, origin, direction);
}

}  // namespace meridian::globebrowsing
