#include <cstdlib>
#include <map>
#include <new>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "streamer_fixture.h"

namespace {
thread_local std::size_t allocations = 0;
}

// Counts this thread's allocations, for the steady frame. Not inlined: GCC 12 would take free for a mismatch of new.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) {
    return memory;
  }
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace meridian::globebrowsing {
namespace {

TEST(TileStreamerStress, RandomRequestsKeepTheCachesPromises) {
  constexpr std::size_t budget = 40'000;
  WorkerPool pool(3);
  Statistics statistics;
  TileStreamer streamer(pool, statistics, {.budgetBytes = budget, .takeMilliseconds = 0.2});
  std::mt19937 random(20161116);
  const auto upTo = [&](std::uint32_t n) { return std::uniform_int_distribution<std::uint32_t>(0, n)(random); };
  std::vector<std::uint32_t> streams{streamer.newStream(), streamer.newStream(), streamer.newStream()};
  std::map<TileKey, TileDataPointer> held;
  std::set<TileKey> readyLastFrame;
  std::atomic<int> running{0};

  for (int frame = 0; frame < 3000; ++frame) {
    streamer.beginFrame();
    std::set<TileKey> readyNow;
    for (std::uint32_t i = 0, count = upTo(30); i < count; ++i) {
      const TileKey key = keyOf(streams[upTo(2)], upTo(60));
      const TileAnswer answer = streamer.request(key, upTo(1000), [&] {
        const std::size_t bytes = 100 + upTo(2000);
        const bool fails = key.index.x % 13 == 0;
        return std::make_unique<FunctionJob>([=, &running](const std::stop_token& stop) -> Result<TileDataPointer> {
          ++running;
          for (int spin = 0; spin < 50 && !stop.stop_requested(); ++spin) {
            std::this_thread::yield();
          }
          --running;
          if (fails) {
            return failure("on purpose");
          }
          return TileDataPointer(std::make_shared<CountedTile>(key, bytes));
        });
      });
      ASSERT_EQ(answer.state == TileAnswer::State::Failed, answer.error != nullptr);
      if (answer.state == TileAnswer::State::Ready) {
        ASSERT_EQ(dynamic_cast<const CountedTile&>(**answer.data).key(), key);
        readyNow.insert(key);
        if (upTo(20) == 0) {
          held[key] = *answer.data;
        }
      }
    }
    if (upTo(10) == 0) {
      held.clear();
    }
    if (upTo(200) == 0) {
      const std::uint32_t gone = upTo(2);
      streamer.forget(streams[gone]);
      for (std::uint32_t x = 0; x <= 60; ++x) {
        ASSERT_EQ(streamer.peek(keyOf(streams[gone], x)).state, TileAnswer::State::Absent);
        readyNow.erase(keyOf(streams[gone], x));
        readyLastFrame.erase(keyOf(streams[gone], x));
        held.erase(keyOf(streams[gone], x));
      }
    }
    streamer.endFrame();
    if (upTo(15) == 0) {
      pool.drain();  // workers at idle priority may get no core for long
    }
    for (const TileKey& key : readyNow) {
      ASSERT_EQ(streamer.peek(key).state, TileAnswer::State::Ready) << "evicted while in use, frame " << frame;
    }
    for (const TileKey& key : readyLastFrame) {
      ASSERT_EQ(streamer.peek(key).state, TileAnswer::State::Ready) << "evicted a frame too early, " << frame;
    }
    for (const auto& [key, data] : held) {
      if (const TileAnswer answer = streamer.peek(key); answer.state == TileAnswer::State::Ready) {
        ASSERT_EQ(*answer.data, data) << "loaded twice while it was held";
      }
    }
    readyLastFrame = std::move(readyNow);
  }
  held.clear();
  for (int i = 0; i < 3; ++i) {
    streamer.beginFrame();
    streamer.endFrame();
  }
  EXPECT_LE(streamer.bytes(), budget);
  EXPECT_EQ(streamer.pending(), 0U);
  pool.drain();
  EXPECT_EQ(running, 0);
  EXPECT_GT(statistics.tiles.loaded, 100U);
  EXPECT_GT(statistics.tiles.cancelled, 100U);
  EXPECT_EQ(statistics.tiles.requested, statistics.tiles.loaded + statistics.tiles.failed + statistics.tiles.cancelled);
}

TEST(TileStreamerStress, ASteadyFrameAllocatesNothing) {
  WorkerPool pool(1);
  Statistics statistics;
  TileStreamer streamer(pool, statistics);
  const std::uint32_t stream = streamer.newStream();
  const auto frame = [&] {
    streamer.beginFrame();
    std::size_t ready = 0;
    for (std::uint32_t x = 0; x < 200; ++x) {
      const TileKey key = keyOf(stream, x);
      ready += streamer.request(key, x, [&] { return tileJob(key, 100); }).state == TileAnswer::State::Ready ? 1U : 0U;
    }
    streamer.endFrame();
    return ready;
  };
  while (frame() < 200) {
    pool.drain();
  }
  const std::size_t before = allocations;
  for (int i = 0; i < 10; ++i) {
    frame();
  }
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace meridian::globebrowsing
