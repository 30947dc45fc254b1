#include <vector>

#include <gtest/gtest.h>

#include "fake_residency.h"
#include "globebrowsing/chunks/chunk_tree.h"
#include "globebrowsing/tiling/geodetic_tiling.h"
#include "support/allocation_count.h"
#include "test_views.h"

namespace meridian::globebrowsing {
namespace {

TEST(ChunkTreeAllocationTest, CounterCounts) {
  const std::size_t before = allocationsOfThisThread();
  const std::vector<int> some(100);
  EXPECT_GT(allocationsOfThisThread(), before);
}

TEST(ChunkTreeAllocationTest, SteadyFramesAllocateNothing) {
  const GeodeticTiling tiling(testEarth());
  ChunkTree tree(tiling);
  FakeResidency residency;
  const SelectionView view = viewAbove(testEarth(), {0.7, 0.2, 1e4}, 0.3, 0.2);
  const std::vector<SelectionView> views{view};
  const SelectionSettings settings;
  for (int frame = 0; frame < 3; ++frame) {
    tree.select(views, settings, residency);
  }
  ASSERT_GT(tree.selected().size(), 50U);
  const std::size_t before = allocationsOfThisThread();
  for (int frame = 0; frame < 200; ++frame) {
    tree.select(views, settings, residency);
  }
  EXPECT_EQ(allocationsOfThisThread(), before);
}

TEST(ChunkTreeAllocationTest, SlowMovesAllocateNothing) {
  const GeodeticTiling tiling(testEarth());
  ChunkTree tree(tiling);
  FakeResidency residency;
  const SelectionSettings settings;
  std::vector<SelectionView> views(1);
  const auto fly = [&](int frame) {
    views[0] = viewAbove(testEarth(), {0.7, 0.2 + 1e-12 * frame, 1e4}, 0.3 + 1e-9 * frame, 0.2);
    tree.select(views, settings, residency);
  };
  for (int frame = 0; frame < 5; ++frame) {
    fly(frame);
  }
  const std::size_t drawn = tree.selected().size();
  const std::size_t before = allocationsOfThisThread();
  for (int frame = 5; frame < 300; ++frame) {
    fly(frame);
    ASSERT_EQ(tree.selected().size(), drawn);
  }
  EXPECT_EQ(allocationsOfThisThread(), before);
}

}  // namespace
}  // namespace meridian::globebrowsing
