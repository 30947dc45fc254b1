#include "globebrowsing/network/negative_cache.h"

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

using std::chrono::milliseconds;
constexpr NegativeCache::TimePoint start{};

TEST(NegativeCache, ForgetsAfterItsLifetime) {
  NegativeCache cache(milliseconds(100), 10);
  cache.add("a", 404, start);
  EXPECT_EQ(cache.find("a", start + milliseconds(99)), 404);
  EXPECT_EQ(cache.find("a", start + milliseconds(100)), std::nullopt);
  EXPECT_EQ(cache.find("b", start), std::nullopt);
  cache.add("a", 204, start + milliseconds(50));
  EXPECT_EQ(cache.find("a", start + milliseconds(120)), 204);
  EXPECT_EQ(cache.size(), 1U);
}

TEST(NegativeCache, HoldsNoMoreThanItMay) {
  NegativeCache cache(milliseconds(100), 3);
  for (int i = 0; i < 10; ++i) {
    cache.add(std::to_string(i), 404, start);
  }
  EXPECT_EQ(cache.size(), 3U);
  EXPECT_EQ(cache.find("6", start), std::nullopt);
  EXPECT_EQ(cache.find("7", start), 404);
  cache.add("later", 404, start + milliseconds(100));
  EXPECT_EQ(cache.size(), 1U) << "what is over goes first";
}

TEST(NegativeCache, RemembersNothingWithoutALifetimeOrRoom) {
  for (NegativeCache cache : {NegativeCache(milliseconds(0), 10), NegativeCache(milliseconds(100), 0)}) {
    cache.add("a", 404, start);
    EXPECT_EQ(cache.find("a", start), std::nullopt);
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
