#include "globebrowsing/gpu/slot_pool.h"

#include <random>
#include <set>

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

const auto ignore = [](int) {};

TEST(SlotPool, GivesEveryKeyASlotOfItsOwnUntilItIsFull) {
  SlotPool<int> pool(4);
  std::set<std::uint32_t> slots;
  for (int key = 0; key < 4; ++key) {
    slots.insert(pool.take(key, 1, ignore).value());
  }
  EXPECT_EQ(slots, (std::set<std::uint32_t>{0, 1, 2, 3}));
  EXPECT_EQ(pool.used(), 4U);
  EXPECT_FALSE(pool.take(9, 1, ignore)) << "all were used in this frame";
  EXPECT_FALSE(pool.peek(9));
}

TEST(SlotPool, EvictsTheKeyLongestUnused) {
  SlotPool<int> pool(3);
  for (int key = 0; key < 3; ++key) {
    pool.take(key, static_cast<std::uint64_t>(key + 1), ignore);
  }
  pool.use(0, 10);
  int evicted = -1;
  ASSERT_TRUE(pool.take(7, 11, [&](int key) { evicted = key; }));
  EXPECT_EQ(evicted, 1);
  EXPECT_TRUE(pool.peek(0) && pool.peek(2) && pool.peek(7));
  EXPECT_FALSE(pool.peek(1) || pool.use(1, 11));
}

TEST(SlotPool, KeepsWhatIsMarkedForALaterFrame) {
  SlotPool<int> pool(1);
  pool.take(0, 1, ignore);
  pool.use(0, 3);
  pool.use(0, 2);  // an earlier mark takes nothing back
  EXPECT_FALSE(pool.take(1, 3, ignore));
  EXPECT_TRUE(pool.take(1, 4, ignore));
}

TEST(SlotPool, PeekDoesNotMark) {
  SlotPool<int> pool(1);
  pool.take(0, 1, ignore);
  EXPECT_TRUE(pool.peek(0));
  EXPECT_TRUE(pool.take(1, 2, ignore));
}

TEST(SlotPool, TwoKeysExchangeTheirSlots) {
  SlotPool<int> pool(2);
  const std::uint32_t first = pool.take(0, 1, ignore).value();
  const std::uint32_t second = pool.take(1, 2, ignore).value();
  pool.exchange(0, 1);
  EXPECT_EQ(pool.peek(0), second);
  EXPECT_EQ(pool.peek(1), first);
  int evicted = -1;
  EXPECT_EQ(pool.take(7, 3, [&](int key) { evicted = key; }), first) << "the slot longest unused is still that";
  EXPECT_EQ(evicted, 1);
}

TEST(SlotPool, ReleasesByPredicate) {
  SlotPool<int> pool(4);
  for (int key = 0; key < 4; ++key) {
    pool.take(key, 1, ignore);
  }
  pool.release([](int key) { return key % 2 == 0; });
  EXPECT_EQ(pool.used(), 2U);
  EXPECT_TRUE(pool.take(8, 1, [](int) { FAIL() << "there is a free slot"; }));
}

/// Against a plain model: in any sequence of uses and takes no key of the present frame is lost and no slot is shared.
TEST(SlotPool, NeverLosesAKeyOfThePresentFrame) {
  std::mt19937 random(7);
  SlotPool<int> pool(8);
  for (std::uint64_t frame = 1; frame < 500; ++frame) {
    std::set<int> used;
    for (int n = 0; n < 12; ++n) {
      const int key = static_cast<int>(random() % 40);
      const bool there = pool.use(key, frame).has_value();
      const bool taken = !there && pool.take(key, frame, [&](int gone) { EXPECT_FALSE(used.contains(gone)); });
      EXPECT_TRUE(there || taken || used.size() == 8) << "a slot was refused though one was free or old";
      if (there || taken) {
        used.insert(key);
      }
    }
    std::set<std::uint32_t> slots;
    for (const int key : used) {
      slots.insert(pool.peek(key).value());
    }
    EXPECT_EQ(slots.size(), used.size());
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
