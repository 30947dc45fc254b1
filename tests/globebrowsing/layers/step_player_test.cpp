#include "globebrowsing/layers/step_player.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "../streaming/streamer_fixture.h"
#include "globebrowsing/providers/drawn_tile_provider.h"
#include "layer_fixture.h"

namespace meridian::globebrowsing {
namespace {

using State = TileProvider::State;

/// A step that is as the test says when it is opened.
class TestStep final : public TileProvider {
 public:
  explicit TestStep(bool works) : works_(works) {}

 private:
  Result<void> openData() override { return works_ ? Result<void>() : failure("the step is broken", "test"); }
  Result<ColourPixels> makeColours(const Tiling&, const TileIndex&, std::stop_token) const override {
    return ColourPixels{};
  }
  Result<HeightPixels> makeHeights(const Tiling&, const TileIndex&, const TileLayout&, std::stop_token) const override {
    return HeightPixels{};
  }
  bool dataOverlap(const Tiling&, const TileIndex&) const override { return true; }
  bool dataFiner(const Tiling&, const TileIndex&, const TileLayout&) const override { return false; }

  bool works_;
};

/// A step every 100 seconds, from time 0 to 100 000.
class TestSeries final : public SteppedTileProvider {
 public:
  TileStep at(const Time& now) const override {
    const double n = std::floor(std::clamp(now.tdbSeconds(), 0.0, 99'999.0) / 100.0);
    return {static_cast<std::uint64_t>(n), Time(100.0 * n), Time(100.0 * (n + 1.0)), Time(100.0 * n + instant)};
  }
  [[nodiscard]] bool interpolates() const override { return mixes; }
  Result<std::shared_ptr<TileProvider>> make(const Time& now) const override {
    ++made;
    auto step = std::make_shared<TestStep>(at(now).id != broken);
    alive.push_back(step);
    return step;
  }
  [[nodiscard]] std::size_t stillAlive() const {
    return static_cast<std::size_t>(
        std::count_if(alive.begin(), alive.end(), [](const auto& step) { return !step.expired(); }));
  }

  std::uint64_t broken = 1u << 30;
  bool mixes = false;
  double instant = 0.0;  ///< seconds after a step's begin
  mutable int made = 0;
  mutable std::vector<std::weak_ptr<TestStep>> alive;

 private:
  Result<void> openData() override { return {}; }
};

class StepPlayerTest : public testing::Test {
 protected:
  StepPlayerTest() { EXPECT_TRUE(series_.open()); }

  /// One frame, and afterwards all that it set going.
  void frame(double seconds) {
    Gate gate(workers_);
    player_.update(series_, Time(seconds));
    gate.open();
    workers_.drain();
  }
  [[nodiscard]] double shown() const { return player_.current() ? player_.current()->when().begin.tdbSeconds() : -1.0; }
  [[nodiscard]] std::vector<double> ahead() const {
    std::vector<double> begins;
    for (const LayerStepPointer& step : player_.ahead()) {
      begins.push_back(step->when().begin.tdbSeconds());
    }
    return begins;
  }

  Statistics statistics_;
  WorkerPool workers_{1};
  TileStreamer streamer_{workers_, statistics_, takingAll};
  TestSeries series_;
  StepPlayer player_{&workers_, &streamer_};
};

TEST_F(StepPlayerTest, ShowsAStepOnceItIsOpen) {
  Gate gate(workers_);
  player_.update(series_, Time(50.0));
  EXPECT_EQ(player_.current(), nullptr);
  EXPECT_TRUE(player_.awaits());
  gate.open();
  workers_.drain();
  frame(50.0);
  EXPECT_EQ(shown(), 0.0);
  EXPECT_FALSE(player_.awaits());
  EXPECT_EQ(player_.current()->source(), &series_);
  EXPECT_NE(player_.current()->stream(), 0U);
}

TEST_F(StepPlayerTest, KeepsTheStepBeforeWhileTheNextIsOpened) {
  frame(50.0);
  frame(50.0);
  const LayerStepPointer before = player_.current();
  Gate gate(workers_);
  for (int n = 0; n < 5; ++n) {
    player_.update(series_, Time(150.0));
    EXPECT_EQ(player_.current(), before);
    EXPECT_TRUE(player_.awaits());
  }
  gate.open();
  workers_.drain();
  frame(150.0);
  EXPECT_EQ(shown(), 100.0);
  EXPECT_NE(player_.current()->stream(), before->stream());
}

TEST_F(StepPlayerTest, OpensTheNextStepsInTheDirectionOfPlay) {
  for (double time = 1000.0; time < 1050.0; time += 10.0) {
    frame(time);
  }
  EXPECT_EQ(ahead(), (std::vector<double>{1100.0, 1200.0}));
  frame(1050.0);
  frame(1050.0);
  EXPECT_EQ(ahead(), (std::vector<double>{1100.0, 1200.0})) << "through a pause";
  for (double time = 1050.0; time > 1010.0; time -= 10.0) {
    frame(time);
  }
  EXPECT_EQ(ahead(), (std::vector<double>{900.0, 800.0}));
  frame(50'000.0);
  EXPECT_EQ(ahead(), std::vector<double>()) << "a jump is no direction";
  EXPECT_EQ(series_.made, 6);
}

TEST_F(StepPlayerTest, LeavesOutStepsThatTimeLeapsOver) {
  for (double time = 1000.0; time < 6000.0; time += 250.0) {
    frame(time);
  }
  frame(6000.0);
  frame(6000.0);
  EXPECT_EQ(ahead(), (std::vector<double>{6200.0, 6500.0}));
}

TEST_F(StepPlayerTest, StaysWithinItsMemoryHoweverLongItPlays) {
  frame(0.0);
  for (double time = 0.0; time < 50'000.0; time += 30.0) {
    frame(time);
    ASSERT_LE(series_.stillAlive(), StepPlayer::mostKept);
    ASSERT_NE(player_.current(), nullptr);
  }
  for (double time = 50'000.0; time > 0.0; time -= 770.0) {
    frame(time);
    ASSERT_LE(series_.stillAlive(), StepPlayer::mostKept);
  }
  player_.rest();
  EXPECT_LE(series_.stillAlive(), 1U);
  player_.clear();
  EXPECT_EQ(series_.stillAlive(), 0U);
  EXPECT_EQ(player_.current(), nullptr);
}

TEST_F(StepPlayerTest, NeverQueuesMoreThanItCanOpen) {
  Gate gate(workers_);
  for (double time = 0.0; time < 20'000.0; time += 100.0) {
    player_.update(series_, Time(time));
    std::size_t opening = 0;
    for (const auto& step : series_.alive) {
      const std::shared_ptr<TestStep> alive = step.lock();
      opening += alive && alive->state() == State::Opening ? 1 : 0;
    }
    ASSERT_LE(opening, StepPlayer::mostOpening);
    ASSERT_LE(series_.stillAlive(), StepPlayer::mostKept);
  }
  gate.open();
}

TEST_F(StepPlayerTest, ShowsTheNearestOpenStepWhenTimePlaysFaster) {
  frame(0.0);
  frame(0.0);
  // Whatever is opened comes a frame too late, and time gets faster: what was opened ahead is never the step wanted.
  double last = 0.0;
  int changes = 0;
  for (int n = 1; n < 12; ++n) {
    frame(1000.0 * n * n);
    EXPECT_GE(shown(), last);
    EXPECT_LT(shown(), 1000.0 * n * n);
    changes += shown() > last ? 1 : 0;
    last = shown();
  }
  EXPECT_GT(changes, 3);
}

TEST_F(StepPlayerTest, AJumpShowsNothingOnItsWay) {
  for (double time = 1000.0; time < 1200.0; time += 50.0) {
    frame(time);
  }
  frame(1150.0);
  EXPECT_EQ(ahead(), (std::vector<double>{1200.0, 1300.0}));
  frame(50'000.0);
  EXPECT_EQ(shown(), 1100.0) << "1200 is open, but nobody asked for it";
  frame(50'000.0);
  EXPECT_EQ(shown(), 50'000.0);
}

TEST_F(StepPlayerTest, AStepThatCannotBeOpenedShowsNothing) {
  series_.broken = 1;
  frame(50.0);
  frame(50.0);
  EXPECT_EQ(player_.error(), "");
  frame(150.0);
  frame(150.0);
  EXPECT_EQ(shown(), 100.0);
  EXPECT_EQ(player_.current()->tiles()->state(), State::Failed);
  EXPECT_NE(player_.error().find("the step is broken"), std::string::npos);
  frame(250.0);
  frame(250.0);
  EXPECT_EQ(player_.error(), "");
}

TEST_F(StepPlayerTest, OpensTheStepBeyondTheMomentToMixWith) {
  frame(125.0);
  frame(125.0);
  EXPECT_EQ(player_.other(), nullptr);
  series_.mixes = true;
  Gate gate(workers_);
  player_.update(series_, Time(125.0));
  EXPECT_TRUE(player_.awaits());
  gate.open();
  workers_.drain();
  for (const double time : {100.0, 125.0, 199.0, 160.0}) {
    frame(time);
    ASSERT_NE(player_.other(), nullptr);
    EXPECT_EQ(shown(), 100.0);
    EXPECT_EQ(player_.other()->when().begin.tdbSeconds(), 200.0);
    EXPECT_DOUBLE_EQ(player_.otherWeight(), (time - 100.0) / 100.0);
    EXPECT_FALSE(player_.awaits());
  }
  const LayerStepPointer other = player_.other();
  frame(210.0);
  EXPECT_EQ(player_.current(), other) << "not opened anew";
  player_.rest();
  EXPECT_EQ(player_.other(), nullptr);
}

TEST_F(StepPlayerTest, MixesBeforeTheInstantOfAStepThatIsShownAroundIt) {
  series_.mixes = true;
  series_.instant = 50.0;
  for (const double time : {120.0, 120.0, 120.0, 190.0, 190.0}) {
    frame(time);
  }
  EXPECT_EQ(player_.other()->when().begin.tdbSeconds(), 200.0);
  EXPECT_DOUBLE_EQ(player_.otherWeight(), 0.4);
  frame(120.0);
  EXPECT_EQ(player_.other()->when().begin.tdbSeconds(), 0.0);
  EXPECT_DOUBLE_EQ(player_.otherWeight(), 0.3);
}

TEST_F(StepPlayerTest, MixesNothingWithAStepThatIsNotThere) {
  series_.mixes = true;
  series_.broken = 2;
  for (const double time : {150.0, 150.0, 150.0, 250.0, 250.0}) {
    frame(time);
    EXPECT_EQ(player_.other(), nullptr);
  }
  EXPECT_EQ(shown(), 200.0) << "which has nothing to show";
  EXPECT_FALSE(player_.awaits());
}

TEST_F(StepPlayerTest, ForgetsAStreamWithItsStep) {
  frame(50.0);
  frame(50.0);
  const TileKey key{player_.current()->stream(), {}};
  streamer_.request(key, 1.0, [&] { return tileJob(key, 1000); });
  workers_.drain();
  streamer_.beginFrame();
  EXPECT_EQ(streamer_.peek(key).state, TileAnswer::State::Ready);
  player_.clear();
  EXPECT_EQ(streamer_.peek(key).state, TileAnswer::State::Absent);
}

}  // namespace
}  // namespace meridian::globebrowsing
