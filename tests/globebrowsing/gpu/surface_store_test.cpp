#include "globebrowsing/gpu/surface_store.h"

#include <algorithm>
#include <vector>

#include "../streaming/streamer_fixture.h"
#include "globebrowsing/tiling/geodetic_tiling.h"
#include "gpu_fixture.h"

namespace meridian::globebrowsing {
namespace {

/// Shapes of a bare ellipsoid that are all made, and asked for in every frame.
class SurfaceStoreTest : public GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    if (!graphics_) {
      return;
    }
    store_ = std::make_unique<SurfaceStore>(tiling_, layers_, streamer_, 64);
    for (std::uint32_t x = 0; x < 4; ++x) {
      for (std::uint32_t y = 0; y < 4; ++y) {
        tiles_.push_back({0, 2, x, y});
      }
    }
    for (int n = 0; n < 3; ++n) {
      EXPECT_EQ(frame(0.0), 0U) << "nothing is uploaded without a budget";
      workers_.drain();
    }
  }
  /// How many shapes are there after a frame with so many milliseconds for uploads. The first tile is the least urgent.
  std::size_t frame(double milliseconds) {
    ++number_;
    streamer_.beginFrame();
    store_->beginFrame(number_);
    double priority = 0.0;
    for (const TileIndex& tile : tiles_) {
      store_->want(tile, ++priority);
    }
    graphics::UploadBudget budget;
    budget.begin(milliseconds);
    store_->upload(budget);
    streamer_.endFrame();
    return static_cast<std::size_t>(std::count_if(
        tiles_.begin(), tiles_.end(), [&](const TileIndex& tile) { return store_->find(tile) != nullptr; }));
  }

  std::shared_ptr<const Tiling> tiling_ =
      std::make_shared<GeodeticTiling>(*Ellipsoid::fromRadii({6.4e6, 6.4e6, 6.4e6}));
  WorkerPool workers_{1};
  TileStreamer streamer_{workers_, statistics_, takingAll};
  LayerManager layers_{{&workers_, &streamer_}};
  std::unique_ptr<SurfaceStore> store_;
  std::vector<TileIndex> tiles_;
  std::uint64_t number_ = 0;
};

TEST_F(SurfaceStoreTest, WhatFitsTheBudgetIsUploadedAtOnce) {
  EXPECT_EQ(frame(1e6), tiles_.size());
  EXPECT_FALSE(store_->full());
}

TEST_F(SurfaceStoreTest, AFrameStopsAtItsBudgetAndTheNextGoesOnInTheOrderOfPriorities) {
  // Less than one upload takes, more than it takes to look at the clock. Where another program is given the processor
  // just between, a frame may get nothing: what counts is that frames go on.
  constexpr double briefly = 0.002;
  std::size_t uploaded = 0;
  std::size_t idle = 0;
  while (uploaded < tiles_.size() && idle < 100) {
    const std::size_t now = frame(briefly);
    ASSERT_LE(now, uploaded + 1) << "the first upload used the budget up";
    idle += now == uploaded ? 1 : 0;
    uploaded = now;
    for (std::size_t i = 0; i < tiles_.size(); ++i) {
      ASSERT_EQ(store_->find(tiles_[i]) != nullptr, i + uploaded >= tiles_.size()) << i << " of " << uploaded;
    }
    EXPECT_FALSE(store_->full()) << "a budget that is used up is no pool that is";
  }
  EXPECT_EQ(uploaded, tiles_.size());
}

}  // namespace
}  // namespace meridian::globebrowsing
