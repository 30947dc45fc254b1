#include <atomic>
#include <random>

#include <gmock/gmock.h>

#include "globebrowsing/network/http_fetcher.h"
#include "network_fixture.h"
#include "support/fault_server.h"

namespace meridian::globebrowsing {
namespace {

using Reply = FaultServer::Reply;

/// Every third is missing, every seventh fails at first.
Reply answerAnything(const FaultServer::Request& request) {
  const std::size_t number = std::stoul(request.target.substr(1));
  if (number % 3 == 0) {
    return {.status = 404};
  }
  if (number % 7 == 0 && request.attempt == 0) {
    return {.status = 500};
  }
  return {.headers = {"Cache-Control: max-age=" + std::to_string(number % 2 * 100)}, .body = std::string(500, 'x')};
}

TEST(HttpFetcherThreads, NoCallbackAfterItsRequestHasGone) {
  FaultServer server;
  server.onAnything(answerAnything);
  TestFolder folder;
  NetworkOptions options = quickOptions();
  options.cache.folder = folder.path();
  HttpFetcher fetcher(options);
  std::atomic<std::size_t> answers{0};

  const auto storm = [&](unsigned seed) {
    std::mt19937 random(seed);
    struct Slot {
      std::shared_ptr<std::atomic<bool>> isGone;
      std::unique_ptr<PendingFetch> pending;
    };
    std::vector<Slot> slots(20);
    for (int i = 0; i < 1500; ++i) {
      Slot& slot = slots[random() % slots.size()];
      slot.pending.reset();
      if (slot.isGone) {
        *slot.isGone = true;
      }
      slot.isGone = std::make_shared<std::atomic<bool>>(false);
      const FetchRequest request{.url = server.url("/" + std::to_string(random() % 200)),
                                 .priority = static_cast<double>(random() % 100)};
      slot.pending = fetcher.fetch(request, [&, request, isGone = slot.isGone](const Result<Fetched>& answer) {
        EXPECT_FALSE(*isGone);
        ++answers;
        if (answer && answer->body != nullptr) {
          answer->body->size() % 2 == 0 ? fetcher.accept(request, *answer) : fetcher.reject(request);
        }
      });
      if (Slot& other = slots[random() % slots.size()]; other.pending != nullptr) {
        other.pending->setPriority(static_cast<double>(random() % 100));
        static_cast<void>(other.pending->lastFailure());
      }
      if (random() % 20 == 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    }
    EXPECT_TRUE(eventually([&] { return answers > 0; }));  // the last ones are still wanted
  };
  std::vector<std::thread> threads;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    threads.emplace_back(storm, seed);
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_TRUE(eventually([&] { return fetcher.statistics().cancelled + answers == 6000; }))
      << "each is answered or cancelled, never both";
  EXPECT_EQ(fetcher.statistics().requests, 6000U);
  EXPECT_TRUE(eventually([&] { return fetcher.statistics().waiting + fetcher.statistics().running == 0; }));
}

TEST(HttpFetcherThreads, MayBeDestroyedAtAnyMoment) {
  FaultServer server;
  server.onAnything(answerAnything);
  server.on("/stall", Reply{.fault = Reply::Fault::StallAtOnce});
  TestFolder folder;
  for (int round = 0; round < 30; ++round) {
    NetworkOptions options = quickOptions();
    options.cache.folder = folder.path();
    std::vector<std::unique_ptr<PendingFetch>> pending;
    std::atomic<bool> isDestroyed{false};
    {
      HttpFetcher fetcher(options);
      for (int i = 0; i < 40; ++i) {
        const std::string target = i % 10 == 0 ? "/stall" : "/" + std::to_string(i);
        pending.push_back(
            fetcher.fetch({.url = server.url(target)}, [&](const Result<Fetched>&) { EXPECT_FALSE(isDestroyed); }));
      }
      if (round % 3 == 0) {
        ASSERT_TRUE(eventually([&] { return fetcher.statistics().transfers > 0; }));
      }
    }
    isDestroyed = true;
    for (const auto& one : pending) {
      one->setPriority(1.0);  // what outlives its fetcher does nothing
    }
    pending.clear();
  }
}

TEST(HttpFetcherThreads, CallbacksStartAndCancelOthersAndThemselves) {
  FaultServer server;
  server.onAnything(answerAnything);
  HttpFetcher fetcher(quickOptions());
  std::mutex mutex;
  std::map<int, std::unique_ptr<PendingFetch>> pending;
  std::atomic<int> answered{0};

  // Each asks for the next, cancels what lies ten ahead of it, and drops itself.
  std::function<void(int)> start = [&](int number) {
    auto one = fetcher.fetch({.url = server.url("/" + std::to_string(number))}, [&, number](const Result<Fetched>&) {
      ++answered;
      if (number < 300) {
        start(number + 1);
      }
      std::unique_ptr<PendingFetch> itself, other;
      {
        const std::lock_guard lock(mutex);
        itself = std::move(pending[number]);
        other = std::move(pending[number + 1010]);
      }
    });
    const std::lock_guard lock(mutex);
    pending[number] = std::move(one);
  };
  for (int number = 1000; number < 1300; ++number) {
    start(number);
  }
  start(0);
  EXPECT_TRUE(
      eventually([&] { return fetcher.statistics().waiting + fetcher.statistics().running == 0 && answered >= 301; }));
  const std::lock_guard lock(mutex);
  pending.clear();
}

TEST(HttpFetcherThreads, CancellingWaitsForACallbackThatRuns) {
  FaultServer server;
  server.on("/a", Reply{.body = "a"});
  HttpFetcher fetcher(quickOptions());
  for (int round = 0; round < 20; ++round) {
    std::promise<void> entered;
    std::atomic<bool> hasEnded{false};
    auto pending = fetcher.fetch({.url = server.url("/a")}, [&](const Result<Fetched>&) {
      entered.set_value();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      hasEnded = true;
    });
    entered.get_future().wait();
    pending.reset();
    EXPECT_TRUE(hasEnded);
  }
}

TEST(HttpFetcherThreads, ACallbackThatThrowsHarmsNobody) {
  FaultServer server;
  server.on("/a", Reply{.body = "a"});
  HttpFetcher fetcher(quickOptions());
  testing::internal::CaptureStderr();
  std::promise<void> thrown;
  const auto pending = fetcher.fetch({.url = server.url("/a")}, [&](const Result<Fetched>&) {
    thrown.set_value();
    throw std::runtime_error("on purpose");
  });
  thrown.get_future().wait();
  EXPECT_TRUE(askFor(fetcher, server.url("/a")));
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::HasSubstr("on purpose"));
}

}  // namespace
}  // namespace meridian::globebrowsing
