#include "globebrowsing/gpu/composite_owners.h"

#include "composites_fixture.h"
#include "globebrowsing/source/tile_layout.h"

namespace meridian::globebrowsing {
namespace {

class CompositeOwnersTest : public CompositesTest {
 protected:
  static constexpr int coarse = 32;
  static constexpr int fine = 1024;  ///< pixels high: half a root tile's pixel each

  [[nodiscard]] int ownerLevel(bool next = false, int mostLevel = 30) const {
    return owners_.owner(CompositeKind::Base, next, tile, mostLevel).index.level;
  }

  static constexpr TileIndex tile{0, 3, 2, 3};
  HeightComposition relief_{tiling_, layers_, streamer_, reliefLayout, nullptr};
  CompositeOwners owners_{tiling_, generations_, relief_};
};

TEST_F(CompositeOwnersTest, WhatIsTheSameEverywhereNeedsRootsOnly) {
  add({{"Identifier", "S"}, {"Type", "SolidColor"}});
  frame();
  EXPECT_EQ(ownerLevel(), 0);
  EXPECT_FALSE(owners_.hasFiner({0, 0, 0, 0}));
}

TEST_F(CompositeOwnersTest, TilesHaveTheirOwnAsFarAsTheFinestDataGo) {
  add({{"Identifier", "C"}, {"FilePath", picture("c.pgm", coarse)}});
  Layer& layer = add({{"Identifier", "F"}, {"FilePath", picture("f.pgm", fine)}});
  frame();
  EXPECT_EQ(ownerLevel(), 1);
  EXPECT_TRUE(owners_.hasFiner({0, 0, 0, 0}));
  EXPECT_FALSE(owners_.hasFiner({0, 1, 0, 0}));
  EXPECT_EQ(ownerLevel(false, 0), 0) << "who draws coarser colours draws a coarser tile's";
  const AncestorPlace owner = owners_.owner(CompositeKind::Base, false, tile, 30);
  EXPECT_EQ(owner.index, ancestorAt(*tiling_, tile, 1).index);
  EXPECT_EQ(owner.transform, ancestorAt(*tiling_, tile, 1).transform);
  EXPECT_EQ(owners_.owner(CompositeKind::Night, false, tile, 30).index.level, 0);
  layer.enabled.put(false);
  frame();
  EXPECT_EQ(ownerLevel(), 0);
  EXPECT_FALSE(owners_.hasFiner({0, 0, 0, 0}));
}

TEST_F(CompositeOwnersTest, EachGenerationHasItsOwnTilesUnlessTheyAreAPair) {
  addDaily({coarse, fine}, {{"Interpolation", true}});
  frame(0.25);
  EXPECT_EQ(ownerLevel(), 0);
  frame(1.25);
  ASSERT_TRUE(base().hasNext());
  EXPECT_EQ(ownerLevel(false), 0);
  EXPECT_EQ(ownerLevel(true), 1);
  frame(0.25);
  ASSERT_FALSE(base().hasNext());
  mixes_ = true;
  frame(0.25);
  ASSERT_TRUE(base().pair().isPair);
  EXPECT_EQ(ownerLevel(false), 1);
  EXPECT_EQ(ownerLevel(true), 1);
}

}  // namespace
}  // namespace meridian::globebrowsing
