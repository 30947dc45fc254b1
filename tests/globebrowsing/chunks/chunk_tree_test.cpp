#include "globebrowsing/chunks/chunk_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "fake_residency.h"
#include "globebrowsing/chunks/chunk_bounds.h"
#include "globebrowsing/geodesy/ray.h"
#include "globebrowsing/tiling/geodetic_tiling.h"
#include "test_views.h"

namespace meridian::globebrowsing {
namespace {

using State = TileResidency::State;

class ChunkTreeTest : public testing::Test {
 protected:
  std::set<TileIndex> select(const SelectionView& view) { return select(std::vector<SelectionView>{view}); }
  std::set<TileIndex> select(const std::vector<SelectionView>& views) {
    residency_.newFrame();
    tree_.select(views, settings_, residency_);
    std::set<TileIndex> indices;
    for (const SelectedChunk& chunk : tree_.selected()) {
      EXPECT_TRUE(indices.insert(chunk.index).second) << "drawn twice: " << toString(chunk.index);
    }
    return indices;
  }

  void expectNoOverlaps(const std::set<TileIndex>& selected) {
    for (const TileIndex& index : selected) {
      for (auto up = tiling_.parent(index); up; up = tiling_.parent(*up)) {
        ASSERT_FALSE(selected.contains(*up)) << toString(index) << " lies in " << toString(*up);
      }
    }
  }

  /// The selected tile that has a place, if any.
  std::optional<TileIndex> chunkAt(const std::set<TileIndex>& selected, double latitude, double longitude) {
    for (int level = 0; level <= settings_.deepestLevel; ++level) {
      const TileIndex index = tiling_.locate(latitude, longitude, level).index;
      if (selected.contains(index)) {
        return index;
      }
    }
    return std::nullopt;
  }

  /// Shoots rays through the picture; whatever they meet must be drawn.
  void expectNoHoles(const SelectionView& view, const std::set<TileIndex>& selected, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const glm::dvec3 radii = tiling_.ellipsoid().radii();
    for (int i = 0; i < 200; ++i) {
      const double reach = std::max(1e4, glm::length(view.cameraPosition) - 6.3e6);
      glm::dvec3 target = view.cameraPosition + 3.0 * reach * glm::dvec3(unit(random), unit(random), unit(random));
      const std::optional<double> hit = nearestHit(view.cameraPosition, target - view.cameraPosition, radii);
      if (!hit) {
        continue;
      }
      const glm::dvec3 point = view.cameraPosition + *hit * (target - view.cameraPosition);
      if (!shows(view, point)) {
        continue;
      }
      ++raysTested_;
      const GeodeticPosition place = tiling_.ellipsoid().geodetic(point);
      ASSERT_TRUE(chunkAt(selected, place.latitude, place.longitude).has_value())
          << "hole at " << place.latitude << ' ' << place.longitude;
    }
  }

  int deepest() const {
    int level = 0;
    for (const SelectedChunk& chunk : tree_.selected()) {
      level = std::max(level, static_cast<int>(chunk.index.level));
    }
    return level;
  }

  GeodeticTiling tiling_{testEarth()};
  ChunkTree tree_{tiling_};
  FakeResidency residency_;
  SelectionSettings settings_;
  int raysTested_ = 0;
};

SelectionView above(double latitude, double longitude, double altitude, double heading = 0.3, double pitch = 1.4) {
  return viewAbove(testEarth(), {latitude, longitude, altitude}, heading, pitch);
}

TEST_F(ChunkTreeTest, FarAwayDrawsTheRoots) {
  residency_.errorAtRoot = 0.0;
  const auto selected = select(testView({1e11, 0.0, 0.0}, {-1.0, 0.0, 0.0}));
  EXPECT_EQ(selected, (std::set<TileIndex>{{0, 0, 0, 0}, {1, 0, 0, 0}}));
  EXPECT_TRUE(tree_.figures().atTarget);
  EXPECT_EQ(tree_.figures().missing, 0U);
}

/// The greatest length in testView's picture, in pixels, of a vertical line of that many metres anywhere in the tile.
double errorOnScreen(const Tiling& tiling, const SelectionView& view, const TileIndex& index, double metres) {
  double largest = 0.0;
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j) {
      GeodeticPosition place = tiling.geodetic(index, {i / 8.0, j / 8.0});
      const glm::dvec3 foot = tiling.ellipsoid().cartesian(place);
      place.height = metres;
      const glm::dvec3 top = tiling.ellipsoid().cartesian(place);
      const bool faces = glm::dot(view.cameraPosition - foot, top - foot) > 0.0;
      if (faces && shows(view, foot) && shows(view, top)) {
        const glm::dvec4 from = view.clipFromModel * glm::dvec4(foot, 1.0);
        const glm::dvec4 to = view.clipFromModel * glm::dvec4(top, 1.0);
        const glm::dvec2 moved = glm::dvec2(to.x, to.y) / to.w - glm::dvec2(from.x, from.y) / from.w;
        largest = std::max(largest, glm::length(moved * glm::dvec2(640.0, 360.0)));
      }
    }
  }
  return largest;
}

TEST_F(ChunkTreeTest, SelectsUntilATexelIsAPixel) {
  for (const double altitude : {2e7, 1e6, 1e5, 2e3, 10.0}) {
    for (int frame = 0; frame < 2; ++frame) {
      select(above(0.7, 0.2, altitude));
    }
    EXPECT_TRUE(tree_.figures().atTarget) << altitude;
    ASSERT_FALSE(tree_.selected().empty());
    const SelectionView view = above(0.7, 0.2, altitude);
    for (const SelectedChunk& chunk : tree_.selected()) {
      const ChunkBounds bounds = chunkBounds(tiling_, chunk.index, {0.0, 0.0});
      const double pixels = bounds.edgeLength / 512.0 * view.pixelsPerRadian / chunk.distance;
      EXPECT_LE(pixels, 1.0) << toString(chunk.index);
      EXPECT_LE(errorOnScreen(tiling_, view, chunk.index, chunk.error), 0.5) << toString(chunk.index);
    }
  }
}

TEST_F(ChunkTreeTest, StopsWhereTheDataStop) {
  residency_.errorAtRoot = 0.0;
  residency_.finerColours = [](const TileIndex& index) { return index.level < 5; };
  select(above(0.7, 0.2, 1e5));
  EXPECT_EQ(deepest(), 5);
}

TEST_F(ChunkTreeTest, ShortEdgesKeepFloatsExact) {
  residency_.errorAtRoot = 0.0;
  residency_.finerColours = [](const TileIndex&) { return false; };
  select(above(0.7, 0.2, 1e2));
  for (const SelectedChunk& chunk : tree_.selected()) {
    const double edge = chunkBounds(tiling_, chunk.index, {0.0, 0.0}).edgeLength;
    EXPECT_LE(edge * 0x1p-23 * above(0.7, 0.2, 1e2).pixelsPerRadian / chunk.distance, 0.05) << toString(chunk.index);
  }
  EXPECT_GT(deepest(), 5);
}

TEST_F(ChunkTreeTest, NeverGoesBelowTheDeepestLevel) {
  for (const int level : {0, 1, 3, 9}) {
    settings_.deepestLevel = level;
    select(above(0.7, 0.2, 10.0));
    EXPECT_EQ(deepest(), level);
  }
  settings_.deepestLevel = 1000;
  select(above(0.7, 0.2, 0.0));
  EXPECT_LE(deepest(), maximumLevel);
  settings_.deepestLevel = -3;
  select(above(0.7, 0.2, 10.0));
  EXPECT_EQ(deepest(), 0);
}

TEST_F(ChunkTreeTest, IsSortedFromNearToFar) {
  select(above(0.7, 0.2, 3e4, 0.3, 0.2));
  const auto selected = tree_.selected();
  ASSERT_GT(selected.size(), 20U);
  for (std::size_t i = 1; i < selected.size(); ++i) {
    EXPECT_LE(selected[i - 1].distance, selected[i].distance);
  }
}

TEST_F(ChunkTreeTest, CameraInsideAChunksBoxSeesIt) {
  residency_.range = {-500.0, 9000.0};
  settings_.deepestLevel = 12;
  for (double heading = 0.0; heading < 6.0; heading += 0.5) {
    const auto selected = select(above(0.7, 0.2, 1500.0, heading, 0.1));
    EXPECT_TRUE(chunkAt(selected, 0.7, 0.2).has_value()) << heading;
  }
}

TEST_F(ChunkTreeTest, KicksUntilTheReplacementIsComplete) {
  residency_.errorAtRoot = 0.0;
  residency_.finerColours = [](const TileIndex& index) { return index.level < 4; };
  residency_.stateOf = [](const TileIndex& index) { return index.level <= 2 ? State::Complete : State::Nothing; };
  const SelectionView view = above(0.7, 0.2, 5e5);
  auto selected = select(view);
  EXPECT_EQ(deepest(), 2);
  EXPECT_GT(tree_.figures().kicked, 0U);
  EXPECT_GT(tree_.figures().missing, 0U);
  EXPECT_FALSE(tree_.figures().atTarget);
  // The targets themselves were asked for, not every ancestor.
  const TileIndex target = tiling_.locate(0.7, 0.2, 4).index;
  const FakeResidency::Wish* wish = residency_.wish(target);
  ASSERT_NE(wish, nullptr);
  EXPECT_TRUE(wish->wanted);

  residency_.stateOf = [](const TileIndex&) { return State::Complete; };
  select(view);
  EXPECT_EQ(deepest(), 4);
  EXPECT_EQ(tree_.figures().kicked, 0U);
  EXPECT_TRUE(tree_.figures().atTarget);
}

TEST_F(ChunkTreeTest, DrawableChunksAreDrawnButAreNotTheTarget) {
  residency_.stateOf = [](const TileIndex&) { return State::Drawable; };
  select(above(0.7, 0.2, 1e5));
  EXPECT_EQ(tree_.figures().kicked, 0U);
  EXPECT_EQ(tree_.figures().missing, tree_.selected().size());
  EXPECT_FALSE(tree_.figures().atTarget);
}

TEST_F(ChunkTreeTest, ZoomingOutKeepsFinerChunksUntilTheCoarserIsComplete) {
  residency_.errorAtRoot = 0.0;
  int finest = 8;
  residency_.finerColours = [&finest](const TileIndex& index) { return index.level < finest; };
  const SelectionView view = above(0.7, 0.2, 1e4);
  const auto before = select(view);
  ASSERT_EQ(deepest(), 8);
  finest = 6;
  for (const State coarse : {State::Drawable, State::Nothing}) {
    residency_.stateOf = [coarse](const TileIndex& index) { return index.level == 6 ? coarse : State::Complete; };
    for (int frame = 0; frame < 3; ++frame) {
      const auto selected = select(view);
      EXPECT_TRUE(std::includes(selected.begin(), selected.end(), before.begin(), before.end()));
      EXPECT_FALSE(tree_.figures().atTarget);
      for (const TileIndex& index : before) {
        ASSERT_NE(residency_.wish(index), nullptr);
        EXPECT_TRUE(residency_.wish(index)->kept);
      }
    }
  }
  residency_.stateOf = [](const TileIndex&) { return State::Complete; };
  select(view);
  EXPECT_EQ(deepest(), 6);
  EXPECT_TRUE(tree_.figures().atTarget);
}

TEST_F(ChunkTreeTest, RootsAreAlwaysWantedFirstAndKept) {
  for (const auto& views : {std::vector<SelectionView>{}, {above(0.7, 0.2, 1e3)}, {SelectionView{}}}) {
    select(views);
    for (const TileIndex& root : {TileIndex{0, 0, 0, 0}, TileIndex{1, 0, 0, 0}}) {
      const FakeResidency::Wish* wish = residency_.wish(root);
      ASSERT_NE(wish, nullptr);
      EXPECT_TRUE(wish->wanted && wish->kept);
      for (const FakeResidency::Wish& other : residency_.wishes) {
        EXPECT_LE(other.priority, wish->priority);
      }
    }
  }
}

TEST_F(ChunkTreeTest, WhatIsSeenComesBeforeWhatIsBeside) {
  select(above(0.7, 0.2, 1e5, 0.3, 0.5));
  double leastNeeded = 10.0;
  std::set<TileIndex> drawn;
  for (const SelectedChunk& chunk : tree_.selected()) {
    drawn.insert(chunk.index);
    leastNeeded = std::min(leastNeeded, residency_.wish(chunk.index)->priority);
  }
  int beside = 0;
  for (const FakeResidency::Wish& wish : residency_.wishes) {
    if (wish.wanted && wish.index.level > 0 && !drawn.contains(wish.index)) {
      ++beside;
      EXPECT_LT(wish.priority, leastNeeded);
    }
  }
  EXPECT_GT(beside, 0);
  settings_.prefetch = false;
  select(above(0.7, 0.2, 1e5, 0.3, 0.5));
  for (const FakeResidency::Wish& wish : residency_.wishes) {
    EXPECT_TRUE(!wish.wanted || wish.index.level == 0 || drawn.contains(wish.index));
  }
}

TEST_F(ChunkTreeTest, WhatIsCulledOrSplitByItsHeightsHasThemRenewed) {
  for (const bool prefetch : {true, false}) {
    settings_.prefetch = prefetch;
    const std::set<TileIndex> drawn = select(above(0.7, 0.2, 1e5, 0.3, 0.5));
    std::set<TileIndex> renewed;
    for (const FakeResidency::Wish& wish : residency_.wishes) {
      if (wish.renewed) {
        EXPECT_FALSE(wish.wanted) << "with all else";
        EXPECT_LE(wish.priority, 1.0) << "after all that is drawn";
        renewed.insert(wish.index);
      }
    }
    std::set<TileIndex> split;
    for (const TileIndex& index : drawn) {
      for (auto up = tiling_.parent(index); up && up->level > 0; up = tiling_.parent(*up)) {
        EXPECT_TRUE(renewed.contains(*up)) << toString(*up);
        split.insert(*up);
      }
    }
    const SelectionFigures& figures = tree_.figures();
    EXPECT_GT(figures.culledHorizon, 0U);
    EXPECT_GE(renewed.size() + 2, split.size() + figures.culledHorizon + (prefetch ? 0 : figures.culledFrustum));
  }
}

TEST_F(ChunkTreeTest, OneSelectionServesAllViews) {
  const SelectionView left = above(0.7, 0.2, 1e5, 0.0, 0.6);
  const SelectionView right = above(0.7, 0.2, 1e5, 2.0, 0.6);
  const auto leftOnly = select(left);
  const auto rightOnly = select(right);
  select({left, right});
  std::set<TileIndex> inLeft;
  std::set<TileIndex> inRight;
  for (const SelectedChunk& chunk : tree_.selected()) {
    ASSERT_NE(chunk.views, 0U);
    if ((chunk.views & 1U) != 0) {
      inLeft.insert(chunk.index);
    }
    if ((chunk.views & 2U) != 0) {
      inRight.insert(chunk.index);
    }
  }
  EXPECT_EQ(inLeft, leftOnly);
  EXPECT_EQ(inRight, rightOnly);
}

TEST_F(ChunkTreeTest, WhatOneViewMayTurnToIsKeptThoughAnotherNeverSeesIt) {
  const SelectionView here = above(0.7, 0.2, 1e6, 0.0, 1.0);
  const SelectionView antipode = above(-0.7, 0.2 + std::numbers::pi, 1e6, 0.0, 1.0);
  select(here);
  std::set<TileIndex> beside;
  for (const FakeResidency::Wish& wish : residency_.wishes) {
    if (wish.kept) {
      beside.insert(wish.index);
    }
  }
  EXPECT_GT(tree_.figures().culledFrustum, 0U);
  EXPECT_GT(tree_.figures().culledHorizon, 0U);
  select({here, antipode});
  for (const TileIndex& index : beside) {
    EXPECT_NE(residency_.wish(index), nullptr) << toString(index);
  }
}

TEST_F(ChunkTreeTest, EachViewIsAtItsTargetByItself) {
  const SelectionView here = above(0.7, 0.2, 1e6, 0.0, 1.0);
  const SelectionView antipode = above(-0.7, 0.2 + std::numbers::pi, 1e6, 0.0, 1.0);
  const std::set<TileIndex> there = select(antipode);
  for (const auto incomplete : {TileResidency::State::Drawable, TileResidency::State::Nothing}) {
    residency_.stateOf = [&](const TileIndex& index) {
      return there.contains(index) ? incomplete : TileResidency::State::Complete;
    };
    select({here, antipode});
    EXPECT_EQ(tree_.figures().viewsShortOfTarget, 2U);
    EXPECT_FALSE(tree_.figures().atTarget);
    select({antipode, here});
    EXPECT_EQ(tree_.figures().viewsShortOfTarget, 1U);
    select({antipode, here, antipode});
    EXPECT_EQ(tree_.figures().viewsShortOfTarget, 5U);
    select(here);
    EXPECT_TRUE(tree_.figures().atTarget);
  }
  residency_.stateOf = [](const TileIndex&) { return TileResidency::State::Complete; };
  select({here, antipode});
  EXPECT_EQ(tree_.figures().viewsShortOfTarget, 0U);
  EXPECT_TRUE(tree_.figures().atTarget);
}

TEST_F(ChunkTreeTest, ViewBitsKeepTheirPlaceWhenABadViewIsLeftOut) {
  SelectionView bad;
  bad.cameraPosition.x = std::nan("");
  select({bad, above(0.7, 0.2, 1e5)});
  ASSERT_FALSE(tree_.selected().empty());
  for (const SelectedChunk& chunk : tree_.selected()) {
    EXPECT_EQ(chunk.views, 2U);
  }
}

TEST_F(ChunkTreeTest, BadCamerasNeverBreakIt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const double huge = std::numeric_limits<double>::max();
  settings_.deepestLevel = 14;
  std::vector<SelectionView> views(1, SelectionView{});
  for (const double value : {nan, infinity, -infinity, huge, 1e29, 1e-300, 0.0}) {
    SelectionView view = above(0.7, 0.2, 1e5);
    view.cameraPosition = glm::dvec3(value, 0.0, 0.0);
    views.push_back(view);
    view = above(0.7, 0.2, 1e5);
    view.pixelsPerRadian = value;
    views.push_back(view);
    view = above(0.7, 0.2, 1e5);
    view.clipFromModel[1][2] = value;
    views.push_back(view);
    view.clipFromModel = glm::dmat4(value);
    views.push_back(view);
  }
  for (const SelectionView& view : views) {
    const auto selected = select(view);
    expectNoOverlaps(selected);
    for (const SelectedChunk& chunk : tree_.selected()) {
      EXPECT_TRUE(std::isfinite(chunk.distance) && std::isfinite(chunk.error) && std::isfinite(chunk.skirt));
    }
    EXPECT_TRUE(residency_.allFinite);
  }
  settings_.scale = nan;
  settings_.maximumErrorPixels = -1.0;
  settings_.compositeTexels = 0.0;
  settings_.lowestHeight = infinity;
  EXPECT_FALSE(select(above(0.7, 0.2, 1e5)).empty());
}

TEST_F(ChunkTreeTest, PartitionsWhatIsSeenOverRandomWalks) {
  std::mt19937 random(21);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  settings_.deepestLevel = 16;
  std::map<TileIndex, State> states;
  for (const double chance : {0.5, 0.1, 0.9}) {
    states.clear();
    residency_.stateOf = [&states](const TileIndex& index) {
      if (index.level == 0) {
        return State::Drawable;
      }
      const auto found = states.find(index);
      return found == states.end() ? State::Nothing : found->second;
    };
    GeodeticPosition place{unit(random), 3.0 * unit(random), 1e7};
    for (int frame = 0; frame < 150; ++frame) {
      place.height = std::clamp(place.height * std::exp(0.5 * unit(random) - 0.02), 20.0, 3e7);
      const double stride = place.height / 6.4e6;
      place.latitude = std::clamp(place.latitude + 0.5 * stride * unit(random), -1.57, 1.57);
      place.longitude = std::remainder(place.longitude + 0.5 * stride * unit(random), 2.0 * std::numbers::pi);
      if (frame % 50 == 25) {
        place.latitude = frame % 100 == 25 ? 1.57 : -1.57;
      }
      const SelectionView view = viewAbove(testEarth(), place, 3.0 * unit(random), 0.8 + 0.7 * unit(random));
      const auto selected = select(view);
      expectNoOverlaps(selected);
      expectNoHoles(view, selected, random);
      for (const SelectedChunk& chunk : tree_.selected()) {
        ASSERT_NE(residency_.state(chunk.index, chunk.colourLevel), State::Nothing);
      }
      if (HasFatalFailure()) {
        return;
      }
      // What was asked for arrives by chance; some of what nobody wants goes.
      for (const FakeResidency::Wish& wish : residency_.wishes) {
        if (wish.wanted && unit(random) < 2.0 * chance - 1.0) {
          State& state = states[wish.index];
          state = state == State::Nothing && random() % 2 == 0 ? State::Drawable : State::Complete;
        }
      }
      std::erase_if(states, [this, &random](const auto& entry) {
        return residency_.wish(entry.first) == nullptr && random() % 4 == 0;
      });
    }
  }
  EXPECT_GT(raysTested_, 2000);
}

TEST_F(ChunkTreeTest, ReachesItsTargetWhenEverythingWantedArrives) {
  std::set<TileIndex> loaded;
  residency_.stateOf = [&loaded](const TileIndex& index) {
    return loaded.contains(index) ? State::Complete : State::Nothing;
  };
  const SelectionView view = above(-1.2, 3.1, 2e3, 1.0, 0.4);
  int frame = 0;
  for (; frame < 40 && !tree_.figures().atTarget; ++frame) {
    select(view);
    for (const FakeResidency::Wish& wish : residency_.wishes) {
      if (wish.wanted) {
        loaded.insert(wish.index);
      }
    }
  }
  EXPECT_LE(frame, 3);
  EXPECT_TRUE(tree_.figures().atTarget);
}

TEST_F(ChunkTreeTest, ForgetsWhatIsNotVisited) {
  for (int i = 0; i < 20; ++i) {
    select(above(0.7, -3.0 + 0.3 * i, 1e3));
  }
  const std::uint32_t many = tree_.figures().nodes;
  residency_.errorAtRoot = 0.0;
  for (int i = 0; i < 400; ++i) {
    select(testView({1e11, 0.0, 0.0}, {-1.0, 0.0, 0.0}));
  }
  EXPECT_LT(tree_.figures().nodes, many / 10);
  tree_.clear();
  EXPECT_TRUE(tree_.selected().empty());
}

TEST_F(ChunkTreeTest, AsksForHeightRangesOnlyWhenTheyChange) {
  const SelectionView view = above(0.7, 0.2, 1e5);
  select(view);
  residency_.rangesAsked = 0;
  select(view);
  EXPECT_EQ(residency_.rangesAsked, 0);
  residency_.version = 2;
  residency_.range = {0.0, 8000.0};
  select(view);
  EXPECT_GT(residency_.rangesAsked, 0);
}

TEST_F(ChunkTreeTest, SkirtsHangBetweenSurfacesOfDifferentData) {
  residency_.finerColours = [](const TileIndex& index) { return index.level < 6; };
  select(above(0.3, 0.7, 1e6));
  const auto edgesOf = [&] {
    std::map<TileIndex, SelectedChunk> chunks;
    for (const SelectedChunk& chunk : tree_.selected()) {
      chunks[chunk.index] = chunk;
    }
    return chunks;
  };
  const std::map<TileIndex, SelectedChunk> alike = edgesOf();
  residency_.unlikeInOddColumns = 5000.0;
  select(above(0.3, 0.7, 1e6));
  int between = 0;
  for (const auto& [index, chunk] : edgesOf()) {
    const std::optional<Neighbour> east = tiling_.neighbour(index, Edge::East);
    const bool hasEast = east && alike.contains(east->index) && alike.contains(index) &&
                         alike.at(index).step == alike.at(east->index).step;
    if (hasEast && east->index.x % 2 != index.x % 2) {
      ++between;
      EXPECT_NE(chunk.skirtEdges & 1U << static_cast<unsigned>(Edge::East), 0U) << toString(index);
      EXPECT_GE(chunk.skirt, 5000.0) << toString(index);
      EXPECT_LT(alike.at(index).skirt, 5000.0) << toString(index);
    }
  }
  EXPECT_GT(between, 5);
}

TEST_F(ChunkTreeTest, SkirtsReachOverEveryGap) {
  // Relief that differs from tile to tile, so that levels and densities are mixed.
  residency_.finerColours = [](const TileIndex& index) { return index.level < 3 + static_cast<int>(index.x % 7); };
  settings_.deepestLevel = 12;
  std::mt19937 random(31);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int unequal = 0;
  for (int i = 0; i < 60; ++i) {
    const double latitude = i % 3 == 0 ? 1.3 + 0.25 * std::abs(unit(random)) : 1.5 * unit(random);
    const double altitude = std::pow(10.0, 5.0 + unit(random));
    select(above(latitude, 3.1 * unit(random), altitude, unit(random), 0.7));
    std::map<TileIndex, SelectedChunk> chunks;
    for (const SelectedChunk& chunk : tree_.selected()) {
      chunks[chunk.index] = chunk;
    }
    for (const auto& [index, chunk] : chunks) {
      // Points just beyond each edge: whichever chunk is drawn there, both skirts hold both errors.
      for (const glm::dvec2 beyond :
           {glm::dvec2(-1e-4, 0.3), glm::dvec2(1.0 + 1e-4, 0.7), glm::dvec2(0.3, -1e-4), glm::dvec2(0.7, 1.0 + 1e-4)}) {
        const GeodeticPosition place = tiling_.geodetic(index, beyond);
        for (int level = 0; level <= settings_.deepestLevel; ++level) {
          const auto other = chunks.find(tiling_.locate(place.latitude, place.longitude, level).index);
          const bool overPole = beyond.y < 0.0 ? index.y == 0 : beyond.y > 1.0 && index.y + 1 == 1U << index.level;
          if (other == chunks.end() || overPole) {
            continue;
          }
          unequal += other->first.level != index.level ? 1 : 0;
          ASSERT_GE(chunk.skirt, chunk.error + other->second.error) << toString(index) << ' ' << toString(other->first);
          ASSERT_GE(other->second.skirt, chunk.error + other->second.error);
        }
      }
    }
  }
  EXPECT_GT(unequal, 100);
}

TEST_F(ChunkTreeTest, FlattenedBodiesNeedNoMoreChunksThanRoundOnes) {
  residency_.finerColours = [](const TileIndex&) { return false; };
  for (const glm::dvec3& radii : {glm::dvec3(1e6, 1e6, 1e5), glm::dvec3(1e6, 1e5, 1e5), glm::dvec3(1e5, 1e5, 1e6),
                                  glm::dvec3(1e6, 1e6, 2e4), glm::dvec3(1e6, 3e5, 1e5)}) {
    const GeodeticTiling tiling(*Ellipsoid::fromRadii(radii));
    ChunkTree tree(tiling);
    residency_.errorAtRoot = 0.2 * tiling.ellipsoid().maximumRadius();
    for (const glm::dvec3& from : {glm::dvec3(3e6, 0.0, 0.0), glm::dvec3(0.0, 0.0, 3e6), glm::dvec3(2e6, 1e6, 1e6)}) {
      residency_.newFrame();
      tree.select(std::vector{testView(from, -from)}, settings_, residency_);
      EXPECT_LT(tree.figures().visited, 3000U) << radii.x << ' ' << radii.y << ' ' << radii.z;
      EXPECT_TRUE(tree.figures().atTarget);
    }
  }
}

/// Errors that never fall, as of heights that are no heights: without a bound there are 4^30 tiles.
TEST_F(ChunkTreeTest, ASelectionEndsWhateverItsErrors) {
  residency_.finerColours = [](const TileIndex&) { return true; };
  residency_.range = {-1e34, 1e34};
  settings_.mostVisited = 2000;
  std::size_t loaded = 0;
  for (const State state : {State::Complete, State::Nothing, State::Drawable}) {
    residency_.stateOf = [state](const TileIndex& index) { return index.level == 0 ? State::Complete : state; };
    residency_.errorAtRoot = 1e34;
    const SelectionView view = above(0.7, 0.2, 2e7);
    for (int frame = 0; frame < 60; ++frame) {
      expectNoOverlaps(select(view));
      EXPECT_LE(tree_.figures().visited, settings_.mostVisited + 4U * maximumLevel);
      EXPECT_LE(tree_.figures().nodes, 8 * settings_.mostVisited);
    }
    EXPECT_GT(tree_.figures().coarsening, 1.0);
    EXPECT_LT(tree_.figures().visited, settings_.mostVisited);
    EXPECT_EQ(tree_.figures().atTarget, state == State::Complete);
    loaded += tree_.selected().size();
  }
  EXPECT_GT(loaded, 0U);
}

TEST_F(ChunkTreeTest, CoarseningFallsWhenThereIsRoom) {
  const SelectionView view = above(0.7, 0.2, 2e7);
  const auto ordinary = select(view);
  settings_.mostVisited = 8000;
  residency_.range = {-1e14, 1e14};
  residency_.errorAtRoot = 1e14;
  residency_.version = 2;
  for (int frame = 0; frame < 30; ++frame) {
    select(view);
  }
  ASSERT_GT(tree_.figures().coarsening, 1.0);
  residency_.range = {0.0, 0.0};
  residency_.errorAtRoot = 1e6;
  residency_.version = 3;
  for (int frame = 0; frame < 400 && tree_.figures().coarsening > 1.0; ++frame) {
    select(view);
    EXPECT_EQ(tree_.figures().atTarget, tree_.figures().coarsening == 1.0) << "it goes on to finer chunks";
  }
  EXPECT_EQ(tree_.figures().coarsening, 1.0);
  EXPECT_EQ(select(view), ordinary);
  EXPECT_TRUE(tree_.figures().atTarget);
}

TEST_F(ChunkTreeTest, EvaluatorsDifferAsNamed) {
  residency_.errorAtRoot = 0.0;
  residency_.finerColours = [](const TileIndex& index) { return index.level < 6; };
  const SelectionView view = above(0.7, 0.2, 1e4, 0.3, 0.3);
  std::map<Evaluator, int> levels;
  for (const Evaluator evaluator :
       {Evaluator::ScreenSpaceError, Evaluator::Distance, Evaluator::ProjectedArea, Evaluator::AvailableData}) {
    settings_.evaluator = evaluator;
    const auto selected = select(view);
    expectNoOverlaps(selected);
    levels[evaluator] = deepest();
  }
  EXPECT_EQ(levels[Evaluator::ScreenSpaceError], 6);
  EXPECT_EQ(levels[Evaluator::AvailableData], 6);
  EXPECT_GT(levels[Evaluator::Distance], 8);
  EXPECT_GT(levels[Evaluator::ProjectedArea], 6);
}

}  // namespace
}  // namespace meridian::globebrowsing
