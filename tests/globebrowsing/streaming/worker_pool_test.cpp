#include "globebrowsing/streaming/worker_pool.h"

#include <algorithm>
#include <atomic>
#include <latch>
#include <stdexcept>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace meridian::globebrowsing {
namespace {

TEST(WorkerPool, RunsAllThatIsPostedAtLowPriority) {
  WorkerPool pool(3);
  std::atomic<int> ran{0};
  const int wanted = std::min(getpriority(PRIO_PROCESS, 0) + WorkerPool::niceness, 19);
  std::atomic<int> nice{0};
  for (int i = 0; i < 200; ++i) {
    pool.post([&](const std::stop_token&) {
      nice += getpriority(PRIO_PROCESS, 0) == wanted ? 1 : 0;
      ++ran;
    });
  }
  pool.drain();
  EXPECT_EQ(ran, 200);
  EXPECT_EQ(nice, 200);
}

TEST(WorkerPool, DrainAlsoWaitsForWhatTasksPost) {
  WorkerPool pool(2);
  std::atomic<int> ran{0};
  pool.post([&](const std::stop_token&) {
    for (int i = 0; i < 10; ++i) {
      pool.post([&](const std::stop_token&) { ++ran; });
    }
  });
  pool.drain();
  EXPECT_EQ(ran, 10);
}

TEST(WorkerPool, GoesOnAfterATaskThrew) {
  WorkerPool pool(1);
  std::atomic<bool> ran{false};
  pool.post([](const std::stop_token&) { throw std::runtime_error("on purpose, in a test"); });
  pool.post([](const std::stop_token&) { throw 7; });
  pool.post([&](const std::stop_token&) { ran = true; });
  pool.drain();
  EXPECT_TRUE(ran);
}

TEST(WorkerPool, StopDropsWhatWaitsAndTellsWhatRuns) {
  WorkerPool pool(1);
  std::latch started(1);
  std::atomic<bool> told{false};
  std::atomic<bool> second{false};
  pool.post([&](const std::stop_token& stop) {
    started.count_down();
    while (!stop.stop_requested()) {
      std::this_thread::yield();
    }
    told = true;
  });
  pool.post([&](const std::stop_token&) { second = true; });
  started.wait();
  pool.stop();
  EXPECT_TRUE(told);
  EXPECT_FALSE(second);
  pool.post([&](const std::stop_token&) { second = true; });
  pool.drain();
  EXPECT_FALSE(second);
}

TEST(WorkerPool, HasAtLeastOneThread) {
  EXPECT_GE(WorkerPool::defaultSize(), 1U);
  EXPECT_EQ(WorkerPool(0).size(), 1U);
}

}  // namespace
}  // namespace meridian::globebrowsing
