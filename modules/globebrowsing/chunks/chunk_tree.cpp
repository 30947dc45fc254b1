#include "globebrowsing/chunks/chunk_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "globebrowsing/chunks/chunk_bounds.h"
#include "globebrowsing/chunks/culling.h"
#include "globebrowsing/chunks/evaluators.h"
#include "globebrowsing/chunks/node_pool.h"
#include "globebrowsing/chunks/skirts.h"
#include "globebrowsing/chunks/view_demand.h"

namespace meridian::globebrowsing {

namespace {

constexpr int finestStep = static_cast<int>(SurfaceErrors::steps) - 1;
/// A tile that this step does not bring within the error splits: large tiles at 4 segments a side, because beyond the
/// horizon they are culled whole or not at all; others at 8, because small tiles fit uneven relief better than dense
/// ones: where one peak asks for density, only its own tile gets it, and a chunk costs less than the triangles that it
/// saves. The steps left are for what stands in for tiles that load.
constexpr int splitStep(int level) {
  constexpr int firstOrdinaryLevel = 4;
  return level < firstOrdinaryLevel ? 1 : 2;
}
/// A float holds 24 bits: a corner patch's edge times this is the error of a vertex along it.
constexpr double floatPrecision = 0x1p-23;
constexpr double maximumPrecisionPixels = 0.05;
/// Frames for which a node that is not visited is kept.
constexpr std::uint64_t patience = 120;
/// Of the inner nodes without a surface, only these levels are asked for, as a picture to start with.
constexpr int stopgapLevels = 3;

/// By how much coarsening grows when a selection is too large, and falls when one has become small; and the share of
/// the most tiles, and the frames between, at which it falls. Half the error needs two to four times the tiles.
constexpr double coarser = 16.0;
constexpr double finer = 0.5;
constexpr std::uint32_t small = 16;
constexpr std::uint64_t finerEvery = 4;
constexpr double coarsest = 1e60;

/// Priorities: roots, then what is needed now, then what may be needed soon. Within a class by urgency.
constexpr double rootPriority = 3.0;
constexpr double neededPriority = 1.0;

constexpr std::uint32_t allViews = ~std::uint32_t{0};

double orElse(double value, double least, double otherwise) {
  return std::isfinite(value) && value >= least ? value : otherwise;
}

SelectionSettings inRange(const SelectionSettings& settings) {
  const SelectionSettings standard;
  SelectionSettings result = settings;
  result.scale = orElse(settings.scale, 1e-6, standard.scale);
  result.compositeTexels = orElse(settings.compositeTexels, 1.0, standard.compositeTexels);
  result.maximumErrorPixels = orElse(settings.maximumErrorPixels, 1e-3, standard.maximumErrorPixels);
  result.lowestHeight = std::isfinite(settings.lowestHeight) ? std::min(settings.lowestHeight, 0.0) : 0.0;
  result.deepestLevel = std::clamp(settings.deepestLevel, 0, maximumLevel);
  return result;
}

/// Why a tile splits.
struct Refinement {
  bool colours = false;
  bool surface = false;
};

}  // namespace

class ChunkTree::Implementation {
 public:
  explicit Implementation(const Tiling& tiling) : tiling_(tiling) { clear(); }

  void select(std::span<const SelectionView> views, const SelectionSettings& settings, TileResidency& residency);
  void clear();

  [[nodiscard]] std::span<const SelectedChunk> selected() const { return selected_; }
  [[nodiscard]] const SelectionFigures& figures() const { return figures_; }

 private:
  void selectFromRoots();
  [[nodiscard]] bool isSpent() const { return figures_.visited >= settings_.mostVisited; }
  /// Whether coarsening is about to fall: the selection has become small.
  [[nodiscard]] bool hasRoomForFiner() const;
  /// Selects what covers the node; false when something in it cannot be drawn.
  bool visit(NodeNumber number);
  bool visitTarget(NodeNumber number, const Demand& demand);
  bool visitChildren(NodeNumber number, const Demand& demand, bool finerColours);
  /// Selects drawable chunks below the node that cover all of it that is visible; nothing if there are none.
  bool coverByFiner(NodeNumber number, bool drawnOnly);
  bool coverByFinerChild(NodeNumber number, bool drawnOnly);

  void updateBounds(ChunkNode& node);
  [[nodiscard]] Demand demandOn(const ChunkNode& node) const { return views_.demandOn(node.bounds, node.horizonCap); }
  /// Of the tile drawn at that step.
  [[nodiscard]] static double errorPixels(const ChunkNode& node, int step, const Demand& demand);
  [[nodiscard]] Refinement refinement(const ChunkNode& node, const Demand& demand) const;
  void noteCulled(const ChunkNode& node, const Demand& demand);
  void split(NodeNumber number);
  void draw(NodeNumber number, const Demand& demand);
  void want(const ChunkNode& node, double priority, std::uint32_t views);
  void renewShape(const ChunkNode& node, double priority, std::uint32_t views);
  [[nodiscard]] TileResidency::State stateOf(const ChunkNode& node) const {
    return residency_->state(node.index, node.colourLevel);
  }
  void keep(const ChunkNode& node) { residency_->keep(node.index, node.colourLevel); }
  [[nodiscard]] double priority(const Demand& demand, double base) const;
  void truncate(std::size_t count);

  void finish();
  /// Gives back what was not visited for more than that many frames.
  void reclaim(NodeNumber number, std::uint64_t frames);
  void giveChildren(ChunkNode& node);

  const Tiling& tiling_;
  NodePool pool_;
  std::vector<NodeNumber> roots_;
  std::uint64_t frame_ = 1;

  PreparedViews views_;
  SelectionSettings settings_;
  TileResidency* residency_ = nullptr;

  std::vector<SelectedChunk> selected_;
  std::vector<NodeNumber> numbers_;  ///< of the nodes of selected_
  SkirtFitter skirts_;
  SelectionFigures figures_;
  double coarsening_ = 1.0;
  bool cutShort_ = false;  ///< tiles that should have split did not, for too many had been visited
};

void ChunkTree::Implementation::clear() {
  pool_ = NodePool();
  roots_.clear();
  for (int root = 0; root < tiling_.rootCount(); ++root) {
    roots_.push_back(pool_.take({static_cast<std::uint8_t>(root), 0, 0, 0}, noNode));
  }
  selected_.clear();
  numbers_.clear();
  figures_ = {};
  coarsening_ = 1.0;
}

void ChunkTree::Implementation::select(std::span<const SelectionView> views, const SelectionSettings& settings,
                                       TileResidency& residency) {
  ++frame_;
  settings_ = inRange(settings);
  residency_ = &residency;
  if (frame_ % finerEvery == 0 && hasRoomForFiner()) {
    coarsening_ = std::max(1.0, finer * coarsening_);
  }
  views_.prepare(views, settings_, tiling_.ellipsoid().radii());
  for (const NodeNumber root : roots_) {
    residency.want(pool_[root].index, 0, rootPriority, allViews);
    keep(pool_[root]);
  }
  selectFromRoots();
  finish();
  if (cutShort_) {
    coarsening_ = std::min(coarsest, coarser * coarsening_);
  }
}

void ChunkTree::Implementation::selectFromRoots() {
  figures_ = {};
  figures_.coarsening = coarsening_;
  cutShort_ = false;
  truncate(0);
  if (!views_.empty()) {
    for (const NodeNumber root : roots_) {
      visit(root);
    }
  }
  if (cutShort_ || hasRoomForFiner()) {
    figures_.viewsShortOfTarget = allViews;
  }
  figures_.atTarget = figures_.viewsShortOfTarget == 0;
}

bool ChunkTree::Implementation::hasRoomForFiner() const {
  return coarsening_ > 1.0 && figures_.visited < settings_.mostVisited / small;
}

void ChunkTree::Implementation::updateBounds(ChunkNode& node) {
  const unsigned version = residency_->heightVersion(node.index);
  if (!node.bounded || node.heightVersion != version) {
    node.bounds = chunkBounds(tiling_, node.index, residency_->heightRange(node.index));
    node.heightVersion = version;
    node.bounded = true;
    node.occluderScale = -1.0;
  }
  if (node.occluderScale != views_.occluderScale()) {
    node.horizonCap = Horizon::capOf(node.bounds.cap, views_.occluderScale());
    node.occluderScale = views_.occluderScale();
  }
}

Refinement ChunkTree::Implementation::refinement(const ChunkNode& node, const Demand& demand) const {
  Refinement wanted;
  if (node.index.level >= settings_.deepestLevel) {
    return wanted;
  }
  wanted.colours = demand.urgency > coarsening_ &&
                   (!evaluatorOf(settings_.evaluator).limitedByData() || residency_->hasFinerColours(node.index));
  wanted.surface =
      node.bounds.edgeLength * floatPrecision * demand.pixelsPerMetre > coarsening_ * maximumPrecisionPixels ||
      errorPixels(node, splitStep(node.index.level), demand) > coarsening_ * settings_.maximumErrorPixels;
  return wanted;
}

double ChunkTree::Implementation::errorPixels(const ChunkNode& node, int step, const Demand& demand) {
  const auto at = static_cast<std::size_t>(step);
  return std::max(node.errors.vertical[at] * demand.error.vertical, node.errors.along[at] * demand.error.along);
}

double ChunkTree::Implementation::priority(const Demand& demand, double base) const {
  const double worth = demand.urgency * (0.25 + 0.75 * demand.centred);
  constexpr double beyondCompare = 1e15;
  return base + (worth < beyondCompare ? worth / (1.0 + worth) : 1.0);
}

void ChunkTree::Implementation::want(const ChunkNode& node, double priority, std::uint32_t views) {
  // Roots were asked for before everything else.
  if (node.index.level > 0) {
    residency_->want(node.index, node.colourLevel, priority, views);
  }
}

void ChunkTree::Implementation::renewShape(const ChunkNode& node, double priority, std::uint32_t views) {
  if (node.index.level > 0) {
    residency_->renewShape(node.index, priority, views);
  }
}

void ChunkTree::Implementation::noteCulled(const ChunkNode& node, const Demand& demand) {
  if (demand.beside == 0) {
    ++figures_.culledHorizon;
    renewShape(node, 0.0, allViews);
    return;
  }
  ++figures_.culledFrustum;
  // Beside what is drawn: without it, turning the camera would fall back to a coarser chunk.
  if (settings_.prefetch) {
    want(node, priority(demand, 0.0), demand.beside);
  } else {
    renewShape(node, 0.0, demand.beside);
  }
  keep(node);
}

bool ChunkTree::Implementation::visit(NodeNumber number) {
  ++figures_.visited;
  ChunkNode& node = pool_[number];
  node.visitedFrame = frame_;
  updateBounds(node);
  const Demand demand = demandOn(node);
  if (demand.views == 0) {
    noteCulled(node, demand);
    return true;
  }
  node.errors = residency_->surfaceErrors(node.index);
  Refinement wanted = refinement(node, demand);
  if (isSpent() && (wanted.colours || wanted.surface)) {
    cutShort_ = true;
    wanted = {};
  }
  return wanted.colours || wanted.surface ? visitChildren(number, demand, wanted.colours) : visitTarget(number, demand);
}

bool ChunkTree::Implementation::visitTarget(NodeNumber number, const Demand& demand) {
  ChunkNode& node = pool_[number];
  want(node, priority(demand, neededPriority), demand.views);
  const TileResidency::State state = stateOf(node);
  if (state == TileResidency::State::Complete) {
    draw(number, demand);
    return true;
  }
  ++figures_.missing;
  figures_.viewsShortOfTarget |= demand.views;
  // Zooming out: what was drawn stays until this one is complete. Without a surface of its own, any finer one will do.
  const bool cannotDraw = state == TileResidency::State::Nothing;
  const bool drewFiner = node.belowFrame + 1 == frame_;
  if ((drewFiner && coverByFiner(number, true)) || (cannotDraw && coverByFiner(number, false))) {
    return true;
  }
  if (cannotDraw) {
    return false;
  }
  draw(number, demand);
  return true;
}

bool ChunkTree::Implementation::visitChildren(NodeNumber number, const Demand& demand, bool finerColours) {
  split(number);
  const std::size_t before = selected_.size();
  const std::uint32_t kickedBefore = figures_.kicked;
  bool covered = true;
  for (int i = 0; i < pool_[number].childCount; ++i) {
    ChunkNode& child = pool_[pool_[number].children[static_cast<std::size_t>(i)]];
    child.colourLevel = finerColours ? child.index.level : pool_[number].colourLevel;
    covered = visit(pool_[number].children[static_cast<std::size_t>(i)]) && covered;
  }
  const ChunkNode& node = pool_[number];
  keep(node);
  renewShape(node, priority(demand, 0.0), demand.views | demand.beside);
  if (covered) {
    return true;
  }
  if (stateOf(node) == TileResidency::State::Nothing) {
    if (node.index.level % stopgapLevels == 0) {
      want(node, priority(demand, neededPriority), demand.views);
    }
    return false;
  }
  truncate(before);
  draw(number, demand);
  figures_.kicked = kickedBefore + 1;           // whatever stood in for something below is not drawn either
  figures_.viewsShortOfTarget |= demand.views;  // it is also seen where only its other children are
  return true;
}

bool ChunkTree::Implementation::coverByFiner(NodeNumber number, bool drawnOnly) {
  ChunkNode& node = pool_[number];
  if (node.childCount == 0 || isSpent()) {
    return false;
  }
  const std::size_t before = selected_.size();
  for (int i = 0; i < node.childCount; ++i) {
    if (!coverByFinerChild(node.children[static_cast<std::size_t>(i)], drawnOnly)) {
      truncate(before);
      return false;
    }
  }
  return true;
}

bool ChunkTree::Implementation::coverByFinerChild(NodeNumber number, bool drawnOnly) {
  ++figures_.visited;
  ChunkNode& node = pool_[number];
  node.visitedFrame = frame_;
  if (node.index.level > settings_.deepestLevel) {
    return false;
  }
  updateBounds(node);
  const Demand demand = demandOn(node);
  if (demand.views == 0) {
    return true;
  }
  node.errors = residency_->surfaceErrors(node.index);
  const bool drawable = stateOf(node) != TileResidency::State::Nothing;
  if (drawable && (!drawnOnly || node.selectedFrame + 1 == frame_)) {
    keep(node);
    draw(number, demand);
    return true;
  }
  return (!drawnOnly || node.belowFrame + 1 == frame_) && coverByFiner(number, drawnOnly);
}

void ChunkTree::Implementation::split(NodeNumber number) {
  if (pool_[number].childCount > 0) {
    return;
  }
  const Children children = tiling_.children(pool_[number].index);
  for (int i = 0; i < children.count; ++i) {
    const auto place = static_cast<std::size_t>(i);
    const NodeNumber child = pool_.take(children.index[place], number);
    pool_[number].children[place] = child;
    pool_[child].colourLevel = pool_[number].colourLevel;
  }
  pool_[number].childCount = children.count;
}

void ChunkTree::Implementation::draw(NodeNumber number, const Demand& demand) {
  const ChunkNode& node = pool_[number];
  SelectedChunk chunk;
  chunk.index = node.index;
  chunk.colourLevel = node.colourLevel;
  chunk.views = demand.views;
  chunk.distance = demand.distance;
  while (chunk.step < finestStep && errorPixels(node, chunk.step, demand) > settings_.maximumErrorPixels) {
    ++chunk.step;
  }
  chunk.error = node.errors.vertical[static_cast<std::size_t>(chunk.step)];
  keep(node);
  selected_.push_back(chunk);
  numbers_.push_back(number);
}

void ChunkTree::Implementation::truncate(std::size_t count) {
  selected_.resize(count);
  numbers_.resize(count);
}

void ChunkTree::Implementation::finish() {
  for (const NodeNumber number : numbers_) {
    pool_[number].selectedFrame = frame_;
    for (NodeNumber up = pool_[number].parent; up != noNode && pool_[up].belowFrame != frame_; up = pool_[up].parent) {
      pool_[up].belowFrame = frame_;
    }
  }
  if (!selected_.empty()) {
    skirts_.fit(tiling_, pool_, {selected_, numbers_, settings_.maximumErrorPixels, 1.0 / views_.finestPixels()});
  }
  std::sort(selected_.begin(), selected_.end(), [](const SelectedChunk& a, const SelectedChunk& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
  });
  constexpr std::uint64_t reclaimEvery = 32;
  const bool isLarge = pool_.used() > 4 * settings_.mostVisited;
  if (frame_ % reclaimEvery == 0 || isLarge) {
    for (const NodeNumber root : roots_) {
      reclaim(root, isLarge ? 1 : patience);
    }
  }
  figures_.nodes = pool_.used();
}

void ChunkTree::Implementation::reclaim(NodeNumber number, std::uint64_t frames) {
  ChunkNode& node = pool_[number];
  bool inUse = false;
  for (int i = 0; i < node.childCount; ++i) {
    const NodeNumber child = node.children[static_cast<std::size_t>(i)];
    reclaim(child, frames);
    inUse = inUse || pool_[child].childCount > 0 || pool_[child].visitedFrame + frames >= frame_;
  }
  if (!inUse) {
    giveChildren(node);
  }
}

void ChunkTree::Implementation::giveChildren(ChunkNode& node) {
  for (int i = 0; i < node.childCount; ++i) {
    pool_.give(node.children[static_cast<std::size_t>(i)]);
  }
  node.childCount = 0;
}

ChunkTree::ChunkTree(const Tiling& tiling) : implementation_(std::make_unique<Implementation>(tiling)) {}
ChunkTree::~ChunkTree() = default;
ChunkTree::ChunkTree(ChunkTree&&) noexcept = default;
ChunkTree& ChunkTree::operator=(ChunkTree&&) noexcept = default;

void ChunkTree::select(std::span<const SelectionView> views, const SelectionSettings& settings,
                       TileResidency& residency) {
  implementation_->select(views, settings, residency);
}

std::span<const SelectedChunk> ChunkTree::selected() const {
  return implementation_->selected();
}

const SelectionFigures& ChunkTree::figures() const {
  return implementation_->figures();
}

void ChunkTree::clear() {
  implementation_->clear();
}

}  // namespace meridian::globebrowsing
