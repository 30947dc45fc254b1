#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "fake_residency.h"
#include "globebrowsing/chunks/chunk_tree.h"
#include "globebrowsing/tiling/geodetic_tiling.h"
#include "test_views.h"

namespace {
std::atomic<std::size_t> allocations{0};

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  void* memory = alignment > alignof(std::max_align_t)
                     ? std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment)
                     : std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  return memory;
}
}  // namespace

// Not inlined: at some levels of optimisation GCC sees malloc or free at only one side of a pair and warns.
[[gnu::noinline]] void* operator new(std::size_t size) {
  return counted(size, 0);
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace meridian::globebrowsing {
namespace {

TEST(ChunkTreeAllocationTest, CounterCounts) {
  const std::size_t before = allocations;
  const std::vector<int> some(100);
  EXPECT_GT(allocations, before);
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
  const std::size_t before = allocations;
  for (int frame = 0; frame < 200; ++frame) {
    tree.select(views, settings, residency);
  }
  EXPECT_EQ(allocations, before);
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
  const std::size_t before = allocations;
  for (int frame = 5; frame < 300; ++frame) {
    fly(frame);
    ASSERT_EQ(tree.selected().size(), drawn);
  }
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace meridian::globebrowsing
