#include "globebrowsing/gpu/composite_generations.h"

#include "composites_fixture.h"

namespace meridian::globebrowsing {
namespace {

class CompositeGenerationsTest : public CompositesTest {
 protected:
  static constexpr int height = 32;
  void addDays(bool interpolation) {
    addDaily({height, height, height, height, height, height}, {{"Interpolation", interpolation}});
  }
};

TEST_F(CompositeGenerationsTest, ComposesTheNextStepBesideTheShownOneAndExchangesThem) {
  addDays(false);
  frame(0.5);
  EXPECT_EQ(dayOf(base().shown()), 0.0);
  EXPECT_FALSE(base().hasNext());
  const CompositeGenerations::Generation first = base().shown();
  frame(1.5);
  ASSERT_TRUE(base().hasNext());
  EXPECT_EQ(dayOf(base().shown()), 0.0);
  EXPECT_EQ(dayOf(base().next()), 1.0);
  EXPECT_NE(base().next().side, first.side);
  EXPECT_GT(base().next().since, first.stamp) << "what lies in slots of that side shows other steps";
  EXPECT_EQ(&base().of(base().next().side), &base().next());
  EXPECT_EQ(&base().of(first.side), &base().shown());
  const std::uint64_t changes = base().changes();
  base().endNext(true);
  EXPECT_FALSE(base().hasNext());
  EXPECT_EQ(dayOf(base().shown()), 1.0);
  EXPECT_NE(base().shown().side, first.side);
  EXPECT_GT(base().changes(), changes);
}

TEST_F(CompositeGenerationsTest, WithoutRoomTheNextStepIsComposedOverTheShownOne) {
  addDays(false);
  frame(0.5);
  const CompositeGenerations::Generation first = base().shown();
  frame(1.5);
  base().setCrowded();
  base().endNext(true);
  EXPECT_EQ(dayOf(base().shown()), 1.0);
  EXPECT_EQ(base().shown().side, first.side);
  EXPECT_EQ(base().shown().since, first.since) << "what was composed before is drawn meanwhile";
  EXPECT_GT(base().shown().stamp, first.stamp);
}

TEST_F(CompositeGenerationsTest, FinishesAStepOnTheWayAndGivesUpOneBehindATurn) {
  addDays(false);
  frame(0.5);
  frame(2.5);
  EXPECT_EQ(dayOf(base().next()), 2.0);
  frame(4.5);
  EXPECT_EQ(dayOf(base().next()), 2.0) << "on the way";
  frame(1.5);
  EXPECT_EQ(dayOf(base().next()), 1.0) << "behind the turn";
  frame(0.5);
  EXPECT_FALSE(base().hasNext());
}

TEST_F(CompositeGenerationsTest, BeginsNoStepBeforeItMay) {
  addDays(false);
  frame(0.5);
  mayBegin_ = {false, false};
  frame(1.5);
  EXPECT_FALSE(base().hasNext());
  mayBegin_ = {};
  frame(1.5);
  EXPECT_TRUE(base().hasNext());
}

TEST_F(CompositeGenerationsTest, MixesWithoutBeingExchanged) {
  addDays(true);
  mixes_ = true;
  mayBegin_ = {true, false};
  frame(0.25);
  EXPECT_TRUE(base().pair().isHeld);
  base().endNext(true);
  EXPECT_TRUE(base().pair().isMixed);
  mixes_ = false;
  frame(-1.0);
  EXPECT_FALSE(base().hasNext()) << "given up";
  frame(1.75);
  EXPECT_FALSE(base().hasNext());
  EXPECT_EQ(dayOf(base().shown()), 0.0);
  mayBegin_ = {};
  frame(1.75);
  EXPECT_TRUE(base().hasNext());
}

TEST_F(CompositeGenerationsTest, HoldsAPairWhileTimeIsBetweenItsSteps) {
  addDays(true);
  mixes_ = true;
  frame(0.25);
  ASSERT_NE(base().interpolated(), nullptr);
  ASSERT_TRUE(base().pair().isHeld);
  EXPECT_TRUE(base().pair().isPair);
  EXPECT_EQ(dayOf(base().next()), 1.0);
  EXPECT_NEAR(base().pair().weight, 0.25, 1e-6);
  base().endNext(false);
  EXPECT_FALSE(base().pair().isMixed) << "what is shown is filled first";
  base().endNext(true);
  EXPECT_TRUE(base().pair().isMixed);
  frame(0.75);
  EXPECT_NEAR(base().pair().weight, 0.75, 1e-6);
  EXPECT_EQ(dayOf(base().shown()), 0.0) << "held, not exchanged";
  frame(1.25);
  EXPECT_FALSE(base().pair().isHeld);
  EXPECT_EQ(base().pair().weight, 1.0);
  base().endNext(true);
  EXPECT_EQ(dayOf(base().shown()), 1.0);
  frame(1.25);
  EXPECT_EQ(dayOf(base().next()), 2.0);
  EXPECT_NEAR(base().pair().weight, 0.25, 1e-6);
}

TEST_F(CompositeGenerationsTest, APairWithoutRoomIsGivenUpUntilTheNextStep) {
  addDays(true);
  mixes_ = true;
  frame(0.25);
  base().setCrowded();
  base().endNext(true);
  EXPECT_FALSE(base().hasNext());
  EXPECT_FALSE(base().pair().isPair);
  frame(0.75);
  EXPECT_EQ(base().interpolated(), nullptr);
  EXPECT_FALSE(base().hasNext());
  frame(1.25);
  EXPECT_NE(base().interpolated(), nullptr);
  EXPECT_TRUE(base().hasNext());
}

TEST_F(CompositeGenerationsTest, WithoutMixingItGoesFromStepToStep) {
  addDays(true);
  frame(0.25);
  EXPECT_NE(base().interpolated(), nullptr);
  EXPECT_FALSE(base().hasNext());
  frame(1.25);
  EXPECT_EQ(dayOf(base().next()), 1.0);
  EXPECT_FALSE(base().pair().isHeld);
}

TEST_F(CompositeGenerationsTest, LayersThatStayKeepTheirStepWhenOthersCome) {
  addDays(false);
  frame(0.5);
  frame(1.5);
  ASSERT_TRUE(base().hasNext());
  add({{"Identifier", "S"}, {"Type", "SolidColor"}});
  EXPECT_TRUE(base().isOutdated(CompositeKind::Base, layers_));
  const std::uint64_t changes = base().changes();
  mayBegin_ = {false, false};
  frame(1.5);
  EXPECT_FALSE(base().isOutdated(CompositeKind::Base, layers_));
  EXPECT_GT(base().changes(), changes);
  ASSERT_EQ(base().layers().size(), 2U);
  EXPECT_EQ(base().key().layers().size(), 2U);
  EXPECT_EQ(dayOf(base().shown()), 0.0);
  EXPECT_FALSE(base().hasNext()) << "which was of other layers";
}

TEST_F(CompositeGenerationsTest, OtherHeightsOutdateOnlyWhatColoursThem) {
  add({{"Identifier", "S"}, {"Type", "SolidColor"}});
  frame();
  const std::uint64_t stamp = base().shown().stamp;
  reliefStream_ = 2;
  frame();
  EXPECT_EQ(base().shown().stamp, stamp);
  add({{"Identifier", "H"}, {"Type", "Hillshade"}});
  frame();
  const CompositeGenerations::Generation before = base().shown();
  reliefStream_ = 3;
  frame();
  EXPECT_GT(base().shown().stamp, before.stamp);
  EXPECT_EQ(base().shown().since, before.since) << "what was composed before is drawn meanwhile";
}

}  // namespace
}  // namespace meridian::globebrowsing
