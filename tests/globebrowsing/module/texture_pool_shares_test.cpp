#include "globebrowsing/texture_pool_shares.h"

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

using Share = TexturePoolShares::Share;

class TexturePoolSharesTest : public ::testing::Test {
 protected:
  /// One frame; what each of two globes is given, which it takes.
  void frame(double earthPixels, double moonPixels) {
    shares_.beginFrame();
    take(&earth_, earthPixels, earthShare_);
    take(&moon_, moonPixels, moonShare_);
  }
  void take(const int* globe, double pixels, std::optional<Share>& share) {
    share = shares_.bid(globe, pixels);
    if (share == Share::Large) {
      shares_.hold(globe);
    } else {
      shares_.release(globe);
    }
  }
  TexturePoolShares shares_;
  int earth_ = 0;
  int moon_ = 0;
  std::optional<Share> earthShare_;
  std::optional<Share> moonShare_;
};

TEST_F(TexturePoolSharesTest, GivesTheLargeShareToTheLargestGlobe) {
  frame(300.0, 10.0);
  EXPECT_FALSE(earthShare_ || moonShare_) << "nobody has bid yet";
  frame(300.0, 10.0);
  EXPECT_EQ(earthShare_, Share::Large);
  EXPECT_EQ(moonShare_, Share::Small);
}

TEST_F(TexturePoolSharesTest, MovesItWhenAnotherLooksAQuarterLargerAndNeverGivesItTwice) {
  frame(300.0, 10.0);
  frame(300.0, 10.0);
  frame(300.0, 350.0);
  frame(300.0, 350.0);
  EXPECT_EQ(earthShare_, Share::Large) << "hardly smaller";
  for (int n = 0; n < 4; ++n) {
    frame(300.0, 600.0);
    EXPECT_FALSE(earthShare_ == Share::Large && moonShare_ == Share::Large);
  }
  EXPECT_EQ(earthShare_, Share::Small);
  EXPECT_EQ(moonShare_, Share::Large);
}

TEST_F(TexturePoolSharesTest, GivesItToNobodyWhileAllAreSmall) {
  frame(50.0, 10.0);
  frame(50.0, 10.0);
  EXPECT_EQ(earthShare_, Share::Small);
  EXPECT_EQ(moonShare_, Share::Small);
}

TEST_F(TexturePoolSharesTest, SharesOfOneLargeAndFourSmallGlobesMakeThePool) {
  constexpr std::size_t pool = std::size_t{512} << 20;
  EXPECT_EQ(TexturePoolShares::bytes(Share::Large, pool) + 4 * TexturePoolShares::bytes(Share::Small, pool), pool);
}

}  // namespace
}  // namespace meridian::globebrowsing
