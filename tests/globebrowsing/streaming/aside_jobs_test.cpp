#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "globebrowsing/streaming/job_queue.h"
#include "streamer_fixture.h"

namespace meridian::globebrowsing {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;
using State = TileAnswer::State;

/// What jobs wait for: data by number, that the test delivers. Safe from any thread.
class Elsewhere {
 public:
  void deliver(std::uint32_t x) {
    std::function<void()> wake;
    {
      const std::lock_guard lock(mutex_);
      delivered_[x] = true;
      if (const auto found = asking_.find(x); found != asking_.end()) {
        wake = std::move(found->second.wake);
      }
    }
    if (wake) {
      wake();
    }
  }
  bool ask(std::uint32_t x, double priority, std::function<void()> wake) {
    const std::lock_guard lock(mutex_);
    if (delivered_[x]) {
      return true;
    }
    asking_[x] = {priority, std::move(wake)};
    return false;
  }
  void setPriority(std::uint32_t x, double priority) {
    const std::lock_guard lock(mutex_);
    asking_[x].priority = priority;
  }
  void drop(std::uint32_t x) {
    const std::lock_guard lock(mutex_);
    asking_.erase(x);
  }
  [[nodiscard]] std::map<std::uint32_t, double> asking() const {
    const std::lock_guard lock(mutex_);
    std::map<std::uint32_t, double> result;
    for (const auto& [x, asked] : asking_) {
      result[x] = asked.priority;
    }
    return result;
  }

 private:
  struct Asked {
    double priority = 0.0;
    std::function<void()> wake;
  };
  mutable std::mutex mutex_;
  std::map<std::uint32_t, Asked> asking_;
  std::map<std::uint32_t, bool> delivered_;
};

class AsideJob final : public TileJob {
 public:
  AsideJob(Elsewhere& elsewhere, const TileKey& key) : elsewhere_(elsewhere), key_(key) {}
  ~AsideJob() override { elsewhere_.drop(key_.index.x); }
  bool prepare(double priority, const std::function<void()>& wake) override {
    return elsewhere_.ask(key_.index.x, priority, wake);
  }
  void setPriority(double priority) override { elsewhere_.setPriority(key_.index.x, priority); }
  Result<TileDataPointer> run(const std::stop_token& /*stop*/) override {
    EXPECT_TRUE(elsewhere_.ask(key_.index.x, 0.0, nullptr)) << "run before its data were there";
    return TileDataPointer(std::make_shared<CountedTile>(key_, 100));
  }
  std::optional<Error> flaw() const override {
    return key_.index.x == 13 ? std::optional<Error>({"a corner is missing", "tile 13"}) : std::nullopt;
  }

 private:
  Elsewhere& elsewhere_;
  TileKey key_;
};

class AsideJobs : public testing::Test {
 protected:
  TileAnswer ask(std::uint32_t x, double priority, std::uint32_t stream = 0) {
    const TileKey key = keyOf(stream == 0 ? stream_ : stream, x);
    return streamer_.request(key, priority, [&] { return std::make_unique<AsideJob>(elsewhere_, key); });
  }
  template <class Ask>
  void frame(Ask&& asks) {
    Gate gate(pool_);  // no job begins before all have been asked for
    streamer_.beginFrame();
    asks();
    streamer_.endFrame();
    gate.open();
    pool_.drain();
  }

  Elsewhere elsewhere_;
  WorkerPool pool_{1};
  Statistics statistics_;
  TileStreamer streamer_{pool_, statistics_, takingAll};
  std::uint32_t stream_ = streamer_.newStream();
};

TEST_F(AsideJobs, WaitWithoutAWorkerAndRunWhenTheirDataAreThere) {
  frame([&] {
    EXPECT_EQ(ask(1, 1.0).state, State::Pending);
    EXPECT_EQ(ask(2, 2.0).state, State::Pending);
  });
  EXPECT_THAT(elsewhere_.asking(), UnorderedElementsAre(std::pair{1U, 1.0}, std::pair{2U, 2.0}));
  // The only worker is free for what can be had at once.
  const TileKey local = keyOf(streamer_.newStream(), 3);
  frame([&] {
    ask(1, 1.0);
    ask(2, 2.0);
    streamer_.request(local, 0.0, [&] { return tileJob(local, 10); });
  });
  elsewhere_.deliver(1);
  pool_.drain();
  frame([&] {
    EXPECT_EQ(ask(1, 1.0).state, State::Ready);
    EXPECT_EQ(ask(2, 2.0).state, State::Pending);
    EXPECT_EQ(streamer_.peek(local).state, State::Ready);
    streamer_.touch(local);
  });
  EXPECT_EQ(statistics_.tiles.failed, 0U);
}

TEST_F(AsideJobs, AreLateWhenNothingComesOfTheirStream) {
  const std::uint32_t other = streamer_.newStream();
  const auto start = std::chrono::steady_clock::now();
  bool late = false;
  while (!late) {
    frame([&] {
      late = ask(1, 1.0).isLate;
      EXPECT_EQ(ask(2, 1.0).isLate, late);
    });
  }
  EXPECT_GE(std::chrono::steady_clock::now() - start, TileStreamer::patience);
  frame([&] {
    EXPECT_TRUE(ask(1, 1.0).isLate);
    EXPECT_TRUE(ask(3, 1.0).isLate) << "the next one will not come either";
    EXPECT_FALSE(ask(4, 1.0, other).isLate) << "another stream";
  });
  elsewhere_.deliver(1);
  pool_.drain();
  frame([&] {
    EXPECT_EQ(ask(1, 1.0).state, State::Ready);
    EXPECT_FALSE(ask(3, 1.0).isLate) << "something has come";
  });
}

TEST_F(AsideJobs, OnlyTheyAreLate) {
  // A worker that is busy with something else is no silent server.
  const TileKey local = keyOf(stream_, 3);
  Gate gate(pool_);
  const auto end = std::chrono::steady_clock::now() + TileStreamer::patience + std::chrono::milliseconds(200);
  while (std::chrono::steady_clock::now() < end) {
    streamer_.beginFrame();
    ASSERT_FALSE(streamer_.request(local, 0.0, [&] { return tileJob(local, 10); }).isLate);
    streamer_.endFrame();
  }
  gate.open();
}

TEST_F(AsideJobs, GiveTheirPrioritiesOnEveryFrame) {
  frame([&] { ask(1, 1.0); });
  frame([&] { ask(1, 9.0); });
  EXPECT_THAT(elsewhere_.asking(), ElementsAre(std::pair{1U, 9.0}));
}

TEST_F(AsideJobs, DropWhatTheyAskedForWhenNobodyWantsThem) {
  frame([&] {
    ask(1, 1.0);
    ask(2, 1.0);
  });
  streamer_.beginFrame();
  ask(2, 1.0);
  streamer_.endFrame();
  EXPECT_THAT(elsewhere_.asking(), ElementsAre(std::pair{2U, 1.0})) << "at once, without a worker";
  EXPECT_EQ(statistics_.tiles.cancelled, 1U);
  streamer_.forget(stream_);
  EXPECT_TRUE(elsewhere_.asking().empty());
}

TEST_F(AsideJobs, AreBoundedSoThatTheMostUrgentBegin) {
  constexpr std::uint32_t bound = JobQueue::begunAhead;
  const auto askAll = [&] {
    for (std::uint32_t x = 0; x < 2 * bound; ++x) {
      ask(x, x);
    }
  };
  frame(askAll);
  ASSERT_EQ(elsewhere_.asking().size(), bound);
  EXPECT_EQ(elsewhere_.asking().begin()->first, bound) << "the most urgent ones";
  // One that is more urgent than all is not held up by those that wait; one that is less urgent waits.
  frame([&] {
    askAll();
    ask(100, 100.0);
    ask(101, 0.5);
  });
  EXPECT_EQ(elsewhere_.asking().size(), bound + 1);
  EXPECT_EQ(elsewhere_.asking().count(100), 1U);
  // Another stream is not held up at all.
  const std::uint32_t other = streamer_.newStream();
  frame([&] {
    askAll();
    ask(100, 100.0);
    ask(102, 0.1, other);
  });
  EXPECT_EQ(elsewhere_.asking().count(102), 1U);
  // As some get theirs, others begin: the best of those that wait.
  elsewhere_.deliver(bound + 1);
  elsewhere_.deliver(bound + 2);
  pool_.drain();
  EXPECT_EQ(elsewhere_.asking().count(bound - 1), 1U);
  EXPECT_EQ(elsewhere_.asking().count(0), 0U);
}

TEST_F(AsideJobs, ThatBecomeMoreUrgentBegin) {
  constexpr std::uint32_t bound = JobQueue::begunAhead;
  frame([&] {
    for (std::uint32_t x = 0; x <= bound; ++x) {
      ask(x, 10.0 + x);
    }
  });
  EXPECT_EQ(elsewhere_.asking().count(0), 0U);
  frame([&] {
    for (std::uint32_t x = 0; x <= bound; ++x) {
      ask(x, x == 0 ? 99.0 : 10.0 + x);
    }
  });
  EXPECT_EQ(elsewhere_.asking().count(0), 1U);
}

TEST_F(AsideJobs, TellWhatIsMissingInWhatTheyMade) {
  elsewhere_.deliver(13);
  frame([&] { ask(13, 1.0); });
  frame([&] { EXPECT_EQ(ask(13, 1.0).state, State::Ready); });
  ASSERT_NE(streamer_.lastError(stream_), nullptr);
  EXPECT_EQ(streamer_.lastError(stream_)->what, "a corner is missing");
  EXPECT_EQ(statistics_.tiles.failed, 0U);
}

TEST_F(AsideJobs, FailWhenPreparingThrows) {
  class ThrowingJob final : public TileJob {
    bool prepare(double, const std::function<void()>&) override { throw std::runtime_error("surprise"); }
    Result<TileDataPointer> run(const std::stop_token&) override { return failure("never"); }
  };
  const auto askIt = [&] {
    return streamer_.request(keyOf(stream_, 1), 1.0, [] { return std::make_unique<ThrowingJob>(); });
  };
  frame([&] { askIt(); });
  frame([&] {
    const TileAnswer answer = askIt();
    ASSERT_EQ(answer.state, State::Failed);
    EXPECT_THAT(answer.error->what, HasSubstr("surprise"));
  });
}

TEST_F(AsideJobs, MayBeWokenBeforeTheyAreAsideAndMoreThanOnce) {
  class HastyJob final : public TileJob {
   public:
    explicit HastyJob(int& prepared) : prepared_(prepared) {}
    bool prepare(double, const std::function<void()>& wake) override {
      wake();
      wake();
      return ++prepared_ == 3;
    }
    Result<TileDataPointer> run(const std::stop_token&) override {
      return TileDataPointer(std::make_shared<CountedTile>(TileKey{}, 1));
    }

   private:
    int& prepared_;
  };
  int prepared = 0;
  const auto askIt = [&] {
    return streamer_.request(keyOf(stream_, 1), 1.0, [&] { return std::make_unique<HastyJob>(prepared); });
  };
  frame([&] { askIt(); });
  frame([&] { EXPECT_EQ(askIt().state, State::Ready); });
  EXPECT_EQ(prepared, 3);
}

TEST(AsideJobsEnd, WithTheStreamer) {
  Elsewhere elsewhere;
  WorkerPool pool(1);
  Statistics statistics;
  {
    TileStreamer streamer(pool, statistics);
    const TileKey key = keyOf(streamer.newStream(), 1);
    streamer.beginFrame();
    streamer.request(key, 1.0, [&] { return std::make_unique<AsideJob>(elsewhere, key); });
    streamer.endFrame();
    pool.drain();
    EXPECT_EQ(elsewhere.asking().size(), 1U);
  }
  EXPECT_TRUE(elsewhere.asking().empty());
  elsewhere.deliver(1);
}

TEST(AsideJobsStress, ManyThreadsDeliverWhileAFlightChangesItsMind) {
  Elsewhere elsewhere;
  WorkerPool pool(2);
  Statistics statistics;
  {
    TileStreamer streamer(pool, statistics);
    const std::uint32_t stream = streamer.newStream();
    std::atomic<bool> isEnding{false};
    std::vector<std::thread> deliverers;
    for (std::uint32_t seed = 0; seed < 2; ++seed) {
      deliverers.emplace_back([&, seed] {
        std::mt19937 random(seed);
        while (!isEnding) {
          elsewhere.deliver(std::uniform_int_distribution<std::uint32_t>(0, 199)(random));
          std::this_thread::yield();
        }
      });
    }
    std::mt19937 random(7);
    for (int i = 0; i < 400; ++i) {
      streamer.beginFrame();
      const std::uint32_t first = i % 160;
      for (std::uint32_t x = first; x < first + 40; ++x) {
        const TileKey key = keyOf(stream, x);
        streamer.request(key, std::uniform_real_distribution<>(0, 1)(random),
                         [&] { return std::make_unique<AsideJob>(elsewhere, key); });
      }
      streamer.endFrame();
      if (i % 20 == 0) {
        pool.drain();
      }
    }
    // In the end all arrive.
    const auto isAllReady = [&] {
      streamer.beginFrame();
      bool all = true;
      for (std::uint32_t x = 0; x < 40; ++x) {
        const TileKey key = keyOf(stream, x);
        all = streamer.request(key, 1.0, [&] { return std::make_unique<AsideJob>(elsewhere, key); }).state ==
                  State::Ready &&
              all;
      }
      streamer.endFrame();
      pool.drain();
      return all;
    };
    while (!isAllReady()) {
      std::this_thread::yield();
    }
    isEnding = true;
    for (std::thread& thread : deliverers) {
      thread.join();
    }
  }
  EXPECT_GE(statistics.tiles.loaded, 40U);
  EXPECT_EQ(statistics.tiles.requested, statistics.tiles.loaded + statistics.tiles.cancelled);
  EXPECT_TRUE(elsewhere.asking().empty());
}

}  // namespace
}  // namespace meridian::globebrowsing
