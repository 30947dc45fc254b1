#include "globebrowsing/gpu/composite_gathering.h"

#include <algorithm>
#include <utility>

#include "globebrowsing/layers/relief_tile.h"
#include "globebrowsing/providers/raw_tile_job.h"
#include "globebrowsing/source/tile_layout.h"

namespace meridian::globebrowsing {

namespace {

/// Of raw tiles that nobody sees yet: after all others.
constexpr double aheadPriority = -5.0;
/// At most that share of the tile cache is fetched ahead for each kind.
constexpr std::size_t aheadShare = 8;

TileDataPointer makeRelief(const Tiling& tiling, const TileIndex& index, std::vector<float>&& heights) {
  return std::make_shared<const ReliefTile>(tiling, index, heights);
}

/// Whether the composite is drawn, but of earlier steps (or heights) of its layers.
bool showsEarlier(const CompositeGathering::Request& request) {
  const CompositeGenerations::Generation& generation = request.generations->of(request.key.side);
  return request.there != nullptr && request.there->stamp >= generation.since &&
         request.there->stamp != generation.stamp;
}

/// Whether a composite may be without the layer's tile, if that is late. What shows a layer at another time is better
/// than what does not show it.
bool mayLack(const Layer& layer, const CompositeGathering::Request& request) {
  return layer.provider()->steps() == nullptr ||
         (!request.generations->isNext(request.key.side) && !showsEarlier(request));
}

}  // namespace

CompositeGathering::CompositeGathering(std::shared_ptr<const Tiling> tiling, LayerManager& layers,
                                       TileStreamer& streamer)
    : tiling_(tiling), streamer_(streamer), relief_(std::move(tiling), layers, streamer, reliefLayout, makeRelief) {}

void CompositeGathering::beginFrame() {
  queue_.clear();
  parts_.clear();
  held_.clear();
  relief_.beginFrame();
  keepRoots(streamer_, *tiling_, relief_.stream());
}

void CompositeGathering::keepStandIns(const std::vector<LayerStepPointer>& steps) {
  for (const LayerStepPointer& step : steps) {
    if (step != nullptr) {
      keepRoots(streamer_, *tiling_, step->stream());
    }
  }
}

bool CompositeGathering::isQueued(const CompositeKey& key) const {
  return std::any_of(queue_.begin(), queue_.end(), [&](const Queued& queued) { return queued.key == key; });
}

std::span<const CompositeGathering::Queued> CompositeGathering::sorted() {
  std::sort(queue_.begin(), queue_.end(), [](const Queued& a, const Queued& b) { return a.priority > b.priority; });
  return queue_;
}

void CompositeGathering::request(const Request& request) {
  Queued queued{request.key, request.priority, request.isMissing, 0, parts_.size()};
  const Lack lack = gather(request);
  queued.lack = lack.coarser;
  queued.partCount = parts_.size() - queued.firstPart;
  if (lack.coarser == 0 || (!lack.comesSoon && isGain(request, lack.coarser, parts(queued)))) {
    queue_.push_back(queued);
  } else {
    parts_.resize(queued.firstPart);
  }
}

bool CompositeGathering::isGain(const Request& request, unsigned lack, std::span<const CompositionPart> parts) {
  if (lack > request.mostLack) {
    return false;
  }
  const auto hasSomething = [](const CompositionPart& part) {
    return part.tile != nullptr || part.relief != nullptr || part.layer->sampling() == Sampling::SolidColor;
  };
  const bool isEmpty = std::none_of(parts.begin(), parts.end(), hasSomething);
  if (request.there == nullptr) {
    return !isEmpty;
  }
  const CompositeContents& there = *request.there;
  if (isEmpty) {
    // An ancestor's composite is better than nothing, unless what is drawn is no longer enabled.
    return std::any_of(there.layers.begin(), there.layers.end(), [&parts](const LayerOpacity& layer) {
      return std::none_of(parts.begin(), parts.end(),
                          [&](const CompositionPart& part) { return part.layer->version() == layer.version; });
    });
  }
  const auto isThere = [](const CompositionPart& part, const LayerOpacity& layer) {
    return part.layer->version() == layer.version && part.opacity == layer.opacity;
  };
  return there.stamp != request.generations->of(request.key.side).stamp || lack < there.lack ||
         !std::equal(parts.begin(), parts.end(), there.layers.begin(), there.layers.end(), isThere);
}

Lack CompositeGathering::gather(const Request& request) {
  Lack lack;
  const std::vector<Layer*>& layers = request.generations->layers();
  const CompositeGenerations::Generation& generation = request.generations->of(request.key.side);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const LayerOpacity& now = (*request.opacities)[i];
    CompositionPart part;
    part.layer = layers[i];
    part.opacity = now.version == request.other.version ? request.other.opacity : now.opacity;
    lack += gatherPart(part, generation.steps[i], request);
    parts_.push_back(part);
  }
  return lack;
}

Lack CompositeGathering::gatherPart(CompositionPart& part, const LayerStepPointer& step, const Request& request) {
  const bool colourHeights = isRelief(part.layer->sampling());
  if (!colourHeights && (part.layer->sampling() != Sampling::Tile || step == nullptr)) {
    return {};
  }
  const auto hasFinerData = [&](const TileIndex& tile) {
    return colourHeights ? relief_.hasFiner(tile) : step->tiles()->hasFinerColours(*tiling_, tile);
  };
  TileIndex index = request.key.index;
  while (index.level > 0 && !hasFinerData(*tiling_->parent(index))) {
    part.transform = part.transform.then(tiling_->inParent(index));
    index = *tiling_->parent(index);
  }
  TileAnswer answer;
  if (colourHeights) {
    part.key = {relief_.stream(), index};
    part.pixelMetres = pixelMetres(*tiling_, request.key.index);
    answer = relief_.request(index, request.priority, showsEarlier(request));
  } else if (const std::shared_ptr<TileProvider>& tiles = step->tiles(); tiles->overlaps(*tiling_, index)) {
    part.key = {step->stream(), index};
    answer = streamer_.request(part.key, request.priority,
                               [&] { return std::make_unique<ColourJob>(tiles, tiling_, index); });
  }
  Lack lack{colourHeights ? relief_.lack(index) : 0};
  const TileDataPointer* data = answer.data;
  if (answer.state == TileAnswer::State::Pending) {
    if (!answer.isLate || !mayLack(*part.layer, request)) {
      return {Lack::everything, true};
    }
    const StandIn standIn = findStandIn(streamer_, *tiling_, part.key);
    part.key.index = standIn.index;
    part.transform = part.transform.then(standIn.within);
    data = standIn.tile;
    lack = {standIn.coarser};
  }
  if (data != nullptr) {
    held_.push_back(*data);
    part.tile = colourHeights ? nullptr : &static_cast<const ColourTile&>(*held_.back());
    part.relief = colourHeights ? &static_cast<const ReliefTile&>(*held_.back()) : nullptr;
  }
  return lack;
}

void CompositeGathering::fetchAhead(const std::vector<Layer*>& layers, const std::vector<Drawn>& drawn) {
  const std::size_t tileBytes = std::size_t{4} * colourLayout.size() * colourLayout.size();
  std::size_t left = streamer_.budget() / aheadShare / tileBytes;
  for (const Layer* layer : layers) {
    double priority = aheadPriority;
    for (const LayerStepPointer& step : layer->ahead()) {
      const std::shared_ptr<TileProvider>& tiles = step->tiles();
      for (const Drawn& tile : drawn) {
        TileIndex index = tile.index;
        while (index.level > 0 &&
               (index.level > tile.colourLevel || !tiles->hasFinerColours(*tiling_, *tiling_->parent(index)))) {
          index = *tiling_->parent(index);
        }
        if (!tiles->overlaps(*tiling_, index)) {
          continue;
        }
        if (left == 0) {
          return;
        }
        --left;
        streamer_.request({step->stream(), index}, priority,
                          [&] { return std::make_unique<ColourJob>(tiles, tiling_, index); });
      }
      priority -= 1.0;
    }
  }
}

}  // namespace meridian::globebrowsing
