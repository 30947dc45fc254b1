#include "globebrowsing/streaming/tile_streamer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "streamer_fixture.h"

namespace meridian::globebrowsing {
namespace {

using State = TileAnswer::State;

class TileStreamerTest : public testing::Test {
 protected:
  TileAnswer ask(std::uint32_t x, double priority = 1.0, std::size_t bytes = 1000) {
    const TileKey key = keyOf(stream_, x);
    return streamer_.request(key, priority, [&] { return tileJob(key, bytes); });
  }
  /// Asks until the tiles are there.
  void load(std::initializer_list<std::uint32_t> tiles) {
    streamer_.beginFrame();
    for (const std::uint32_t x : tiles) {
      ask(x);
    }
    streamer_.endFrame();
    pool_.drain();
    while (streamer_.pending() > 0) {
      streamer_.beginFrame();
      for (const std::uint32_t x : tiles) {
        ask(x);
      }
      streamer_.endFrame();
    }
  }
  void idleFrames(int count) {
    for (int i = 0; i < count; ++i) {
      streamer_.beginFrame();
      streamer_.endFrame();
    }
  }

  WorkerPool pool_{1};
  Statistics statistics_;
  TileStreamer streamer_{pool_, statistics_, takingAll};
  std::uint32_t stream_ = streamer_.newStream();
};

TEST_F(TileStreamerTest, ADroppedTileIsMadeAnew) {
  load({1});
  const std::size_t before = streamer_.bytes();
  streamer_.drop(keyOf(stream_, 1));
  EXPECT_LT(streamer_.bytes(), before);
  EXPECT_EQ(streamer_.peek(keyOf(stream_, 1)).state, State::Absent);
  streamer_.drop(keyOf(stream_, 2));  // never there
  Gate gate(pool_);
  ask(1);
  streamer_.drop(keyOf(stream_, 1));  // while it waits
  EXPECT_EQ(streamer_.pending(), 0U);
  EXPECT_EQ(streamer_.pending(stream_), 0U);
  gate.open();
  load({1});
}

TEST_F(TileStreamerTest, ATileIsPendingThenReadyAndItsJobIsMadeOnce) {
  int made = 0;
  const TileKey key = keyOf(stream_, 3);
  const auto askCounting = [&] {
    return streamer_.request(key, 1.0, [&] {
      ++made;
      return tileJob(key, 10);
    });
  };
  streamer_.beginFrame();
  EXPECT_EQ(streamer_.peek(key).state, State::Absent);
  EXPECT_EQ(askCounting().state, State::Pending);
  EXPECT_EQ(askCounting().state, State::Pending);
  streamer_.endFrame();
  pool_.drain();
  EXPECT_EQ(streamer_.beginFrame(), 1U);
  const TileAnswer answer = askCounting();
  ASSERT_EQ(answer.state, State::Ready);
  EXPECT_EQ(dynamic_cast<const CountedTile&>(**answer.data).key(), key);
  EXPECT_EQ(made, 1);
  EXPECT_EQ(statistics_.tiles.requested, 1U);
  EXPECT_EQ(statistics_.tiles.loaded, 1U);
  EXPECT_EQ(statistics_.tiles.bytes, 10U);
}

TEST_F(TileStreamerTest, WorkersTakeTheGreatestPriorityOfTheMoment) {
  std::vector<std::uint32_t> order;
  const auto askRecording = [&](std::uint32_t x, double priority) {
    streamer_.request(keyOf(stream_, x), priority, [&, x] {
      return std::make_unique<FunctionJob>([&order, x](const std::stop_token&) {
        order.push_back(x);
        return TileDataPointer(std::make_shared<CountedTile>(TileKey{}, 1));
      });
    });
  };
  Gate gate(pool_);
  streamer_.beginFrame();
  for (std::uint32_t x = 0; x < 5; ++x) {
    askRecording(x, x);
  }
  streamer_.endFrame();
  streamer_.beginFrame();
  const double priorities[] = {3.0, 7.0, std::numeric_limits<double>::quiet_NaN(), 7.0, 9.0};
  for (std::uint32_t x = 0; x < 5; ++x) {
    askRecording(x, priorities[x]);
  }
  streamer_.endFrame();
  gate.open();
  pool_.drain();
  EXPECT_THAT(order, testing::ElementsAre(4, 1, 3, 0, 2));
}

TEST_F(TileStreamerTest, AJobThatNobodyWantsAnyMoreNeverRuns) {
  std::atomic<int> ran{0};
  Gate gate(pool_);
  const auto askCounting = [&](std::uint32_t x) {
    streamer_.request(keyOf(stream_, x), 1.0, [&] {
      return std::make_unique<FunctionJob>([&](const std::stop_token&) {
        ++ran;
        return TileDataPointer(std::make_shared<CountedTile>(TileKey{}, 1));
      });
    });
  };
  streamer_.beginFrame();
  askCounting(1);
  askCounting(2);
  streamer_.endFrame();
  streamer_.beginFrame();
  askCounting(2);
  streamer_.endFrame();
  EXPECT_EQ(streamer_.pending(), 1U);
  gate.open();
  pool_.drain();
  EXPECT_EQ(ran, 1);
  EXPECT_EQ(streamer_.peek(keyOf(stream_, 1)).state, State::Absent);
  EXPECT_EQ(statistics_.tiles.cancelled, 1U);
}

TEST_F(TileStreamerTest, AJobThatRunsIsAskedToStopWhenNobodyWantsItsTile) {
  std::latch started(1);
  std::atomic<bool> stopped{false};
  streamer_.beginFrame();
  streamer_.request(keyOf(stream_, 1), 1.0, [&] {
    return std::make_unique<FunctionJob>([&](const std::stop_token& stop) -> Result<TileDataPointer> {
      started.count_down();
      while (!stop.stop_requested()) {
        std::this_thread::yield();
      }
      stopped = true;
      return failure("cancelled");
    });
  });
  streamer_.endFrame();
  started.wait();
  streamer_.beginFrame();
  streamer_.touch(keyOf(stream_, 1));
  streamer_.endFrame();
  EXPECT_FALSE(stopped) << "a touch keeps what is pending";
  idleFrames(1);
  pool_.drain();
  EXPECT_TRUE(stopped);
  EXPECT_EQ(streamer_.beginFrame(), 0U);
  EXPECT_EQ(statistics_.tiles.failed, 0U);
  EXPECT_EQ(ask(1).state, State::Pending) << "it can be asked for again";
}

TEST_F(TileStreamerTest, AFailureIsForGoodUntilTheStreamIsForgotten) {
  int made = 0;
  const auto askFailing = [&] {
    return streamer_.request(keyOf(stream_, 1), 1.0, [&] {
      ++made;
      return std::make_unique<FunctionJob>(
          [](const std::stop_token&) -> Result<TileDataPointer> { return failure("the disk is gone", "a.tif"); });
    });
  };
  streamer_.beginFrame();
  askFailing();
  streamer_.endFrame();
  pool_.drain();
  for (int i = 0; i < 4; ++i) {
    streamer_.beginFrame();
    const TileAnswer answer = askFailing();
    ASSERT_EQ(answer.state, State::Failed);
    EXPECT_EQ(answer.error->what, "the disk is gone");
    streamer_.endFrame();
  }
  EXPECT_EQ(made, 1);
  ASSERT_NE(streamer_.lastError(stream_), nullptr);
  EXPECT_EQ(streamer_.lastError(stream_)->where, "a.tif");
  streamer_.forget(stream_);
  EXPECT_EQ(streamer_.lastError(stream_), nullptr);
  streamer_.beginFrame();
  EXPECT_EQ(askFailing().state, State::Pending);
  EXPECT_EQ(made, 2);
  EXPECT_EQ(statistics_.tiles.failed, 1U);
}

TEST_F(TileStreamerTest, WhatAJobThrowsIsItsError) {
  const auto askThrowing = [&] {
    return streamer_.request(keyOf(stream_, 1), 1.0, [] {
      return std::make_unique<FunctionJob>(
          [](const std::stop_token&) -> Result<TileDataPointer> { throw std::runtime_error("surprise"); });
    });
  };
  streamer_.beginFrame();
  askThrowing();
  streamer_.endFrame();
  pool_.drain();
  streamer_.beginFrame();
  const TileAnswer answer = askThrowing();
  ASSERT_EQ(answer.state, State::Failed);
  EXPECT_THAT(answer.error->what, testing::HasSubstr("surprise"));
}

TEST_F(TileStreamerTest, ForgettingAStreamLeavesTheOthers) {
  const std::uint32_t other = streamer_.newStream();
  load({1, 2});
  streamer_.beginFrame();
  streamer_.request(keyOf(other, 1), 1.0, [&] { return tileJob(keyOf(other, 1), 5); });
  ask(7);
  streamer_.forget(stream_);
  EXPECT_EQ(streamer_.pending(), 1U);
  EXPECT_EQ(streamer_.pending(other), 1U);
  streamer_.endFrame();
  EXPECT_EQ(streamer_.bytes(), 0U);
  EXPECT_EQ(streamer_.peek(keyOf(stream_, 2)).state, State::Absent);
}

TEST_F(TileStreamerTest, EvictsTheLeastRecentlyUsedAndNeverWhatIsInUse) {
  load({1, 2, 3, 4});
  const std::size_t each = streamer_.bytes() / 4;
  idleFrames(2);
  streamer_.beginFrame();
  ask(2);
  streamer_.endFrame();
  EXPECT_EQ(statistics_.tiles.cacheHits, 1U);
  TileDataPointer held;
  streamer_.beginFrame();
  held = *streamer_.peek(keyOf(stream_, 1)).data;
  streamer_.endFrame();

  streamer_.setBudget(each * 5 / 2);
  idleFrames(1);
  EXPECT_EQ(streamer_.peek(keyOf(stream_, 1)).state, State::Ready) << "held outside";
  EXPECT_EQ(streamer_.peek(keyOf(stream_, 2)).state, State::Ready) << "used lately";
  EXPECT_EQ(streamer_.peek(keyOf(stream_, 3)).state, State::Absent);
  EXPECT_EQ(streamer_.peek(keyOf(stream_, 4)).state, State::Absent);
  EXPECT_EQ(statistics_.memory.tileCache, streamer_.bytes());

  streamer_.setBudget(0);
  held.reset();
  idleFrames(3);
  EXPECT_EQ(streamer_.bytes(), 0U);
}

TEST_F(TileStreamerTest, KeepsWhatThisAndTheLastFrameAskedForEvenOverTheBudget) {
  streamer_.setBudget(0);
  load({1, 2, 3});
  streamer_.beginFrame();
  ask(1);
  ask(2);
  streamer_.endFrame();
  EXPECT_EQ(streamer_.peek(keyOf(stream_, 3)).state, State::Ready) << "asked for in the last frame";
  streamer_.beginFrame();
  ask(1);
  streamer_.endFrame();
  EXPECT_EQ(streamer_.peek(keyOf(stream_, 3)).state, State::Absent);
  EXPECT_EQ(streamer_.peek(keyOf(stream_, 2)).state, State::Ready);
}

TEST_F(TileStreamerTest, DestructionWaitsForWhatRuns) {
  std::latch started(1);
  std::atomic<bool> ended{false};
  {
    TileStreamer brief(pool_, statistics_);
    const std::uint32_t stream = brief.newStream();
    brief.beginFrame();
    brief.request(keyOf(stream, 1), 1.0, [&] {
      return std::make_unique<FunctionJob>([&](const std::stop_token& stop) -> Result<TileDataPointer> {
        started.count_down();
        while (!stop.stop_requested()) {
          std::this_thread::yield();
        }
        ended = true;
        return failure("cancelled");
      });
    });
    brief.endFrame();
    started.wait();
  }
  EXPECT_TRUE(ended);
}

}  // namespace
}  // namespace meridian::globebrowsing
