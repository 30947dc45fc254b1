#include <gmock/gmock.h>

#include "globebrowsing/network/http_fetcher.h"
#include "network_fixture.h"
#include "support/fault_server.h"

namespace meridian::globebrowsing {
namespace {

using Reply = FaultServer::Reply;
using testing::HasSubstr;

class HttpFetcherCache : public testing::Test {
 protected:
  HttpFetcherCache() {
    options.cache.folder = folder.path();
    options.retry.attempts = 2;
  }
  /// Fetches and accepts it, in a fetcher of its own.
  void keep(const std::string& target) {
    HttpFetcher fetcher(options);
    const FetchRequest request{.url = server.url(target)};
    const auto answer = ask(fetcher, request);
    ASSERT_TRUE(answer) << answer.error().message();
    fetcher.accept(request, *answer);
  }

  TestFolder folder;
  FaultServer server;
  NetworkOptions options = quickOptions();
};

TEST_F(HttpFetcherCache, KeepsOnlyWhatWasAccepted) {
  server.on("/a", {.headers = {"Content-Type: image/png"}, .body = "a"});
  HttpFetcher fetcher(options);
  const FetchRequest request{.url = server.url("/a")};
  for (int i = 0; i < 2; ++i) {
    const auto answer = ask(fetcher, request);
    ASSERT_TRUE(answer);
    EXPECT_FALSE(answer->isFromCache);
    if (i == 1) {
      fetcher.accept(request, *answer);
    }
  }
  const auto again = ask(fetcher, request);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->isFromCache);
  EXPECT_FALSE(again->isStale);
  EXPECT_EQ(textOf(*again), "a");
  EXPECT_EQ(again->contentType, "image/png");
  fetcher.accept(request, *again);
  EXPECT_EQ(server.count(), 2U);
  EXPECT_EQ(fetcher.statistics().cacheHits, 1U);
  fetcher.drainCache();
  EXPECT_EQ(fetcher.statistics().stored, 1U);

  const auto other = ask(fetcher, {.url = server.url("/a"), .headers = {"X-Key: other"}});
  ASSERT_TRUE(other);
  EXPECT_FALSE(other->isFromCache) << "another request, though the same address";

  fetcher.reject(request);
  EXPECT_EQ(ask(fetcher, request)->body, nullptr);
  fetcher.drainCache();
  HttpFetcher next(options);
  EXPECT_FALSE(ask(next, request)->isFromCache) << "what was rejected is gone from disk";
}

TEST_F(HttpFetcherCache, NoStoreIsNotKept) {
  server.on("/a", {.headers = {"Cache-Control: no-store"}, .body = "a"});
  keep("/a");
  keep("/a");
  EXPECT_EQ(server.count(), 2U);
}

TEST_F(HttpFetcherCache, AsksWhetherWhatIsOldIsStillGood) {
  server.on("/a", [](const FaultServer::Request& request) {
    const auto tag = request.headers.find("if-none-match");
    if (tag != request.headers.end() && tag->second == "\"v1\"") {
      return Reply{.status = 304, .headers = {"Cache-Control: max-age=1000", "ETag: \"v1\""}};
    }
    return Reply{.headers = {"Cache-Control: max-age=0", "ETag: \"v1\"", "Content-Type: image/png"}, .body = "first"};
  });
  keep("/a");
  {
    HttpFetcher fetcher(options);
    const auto answer = askFor(fetcher, server.url("/a"));
    ASSERT_TRUE(answer);
    EXPECT_TRUE(answer->isFromCache);
    EXPECT_FALSE(answer->isStale);
    EXPECT_EQ(textOf(*answer), "first");
    EXPECT_EQ(answer->contentType, "image/png");
    EXPECT_EQ(fetcher.statistics().revalidated, 1U);
  }
  HttpFetcher fetcher(options);
  EXPECT_TRUE(askFor(fetcher, server.url("/a"))->isFromCache);
  EXPECT_EQ(server.count(), 2U) << "the 304 made it fresh for longer";
}

TEST_F(HttpFetcherCache, TakesWhatIsNewInstead) {
  server.on("/a", [](const FaultServer::Request& request) {
    const std::string version = std::to_string(request.attempt);
    return Reply{.headers = {"Cache-Control: max-age=0", "ETag: \"" + version + "\""}, .body = "version " + version};
  });
  keep("/a");
  keep("/a");
  HttpFetcher fetcher(options);
  const auto answer = askFor(fetcher, server.url("/a"));
  EXPECT_EQ(textOf(*answer), "version 2");
  EXPECT_EQ(server.requests().back().headers.at("if-none-match"), "\"1\"");
}

TEST_F(HttpFetcherCache, OldIsBetterThanNothing) {
  server.on("/old", {.headers = {"Cache-Control: max-age=0"}, .body = "old"});
  server.on("/strict", {.headers = {"Cache-Control: max-age=0, must-revalidate"}, .body = "strict"});
  keep("/old");
  keep("/strict");
  {
    server.on("/old", {.status = 500});
    HttpFetcher fetcher(options);
    const auto answer = askFor(fetcher, server.url("/old"));
    ASSERT_TRUE(answer);
    EXPECT_TRUE(answer->isStale);
    EXPECT_TRUE(answer->isFromCache);
    EXPECT_EQ(textOf(*answer), "old");
    EXPECT_EQ(fetcher.statistics().stale, 1U);
    server.on("/strict", {.status = 500});
    EXPECT_FALSE(askFor(fetcher, server.url("/strict")));
  }
  server.refuse();
  HttpFetcher fetcher(options);
  Asked strict(fetcher, {.url = server.url("/strict")});
  for (int i = 0; i < 100; ++i) {
    const auto answer = askFor(fetcher, server.url("/old"));
    ASSERT_TRUE(answer);
    EXPECT_TRUE(answer->isStale);
  }
  EXPECT_FALSE(strict.isThere());
  server.on("/old", {.body = "new"});
  server.listen();
  EXPECT_TRUE(eventually([&] {
    const auto answer = askFor(fetcher, server.url("/old"));
    return answer && !answer->isStale && textOf(*answer) == "new";
  })) << "and when the server is back it is asked again";
}

TEST_F(HttpFetcherCache, NothingHereDropsWhatWasKept) {
  server.on("/a", {.headers = {"Cache-Control: max-age=0"}, .body = "a"});
  keep("/a");
  server.on("/a", {.status = 404});
  {
    HttpFetcher fetcher(options);
    EXPECT_EQ(askFor(fetcher, server.url("/a"))->body, nullptr);
  }
  options.cache.mode = CacheMode::CacheOnly;
  HttpFetcher fetcher(options);
  EXPECT_FALSE(askFor(fetcher, server.url("/a")));
}

TEST_F(HttpFetcherCache, CacheOnlyAsksNobody) {
  server.on("/a", {.headers = {"Cache-Control: max-age=0, must-revalidate"}, .body = "a"});
  keep("/a");
  options.cache.mode = CacheMode::CacheOnly;
  HttpFetcher fetcher(options);
  const auto answer = askFor(fetcher, server.url("/a"));
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->isStale);
  EXPECT_EQ(textOf(*answer), "a");
  const auto missing = askFor(fetcher, server.url("/b"));
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().remedy, HasSubstr("MERIDIAN_OFFLINE"));
  EXPECT_EQ(server.count(), 1U);

  server.on("/b", {.body = "b"});
  options.cache.mode = CacheMode::ReadWrite;
  fetcher.setOptions(options);
  EXPECT_EQ(textOf(*askFor(fetcher, server.url("/b"))), "b");
}

TEST_F(HttpFetcherCache, OffAndReadOnlyWriteNothing) {
  server.onAnything([](const FaultServer::Request&) { return Reply{.body = "x"}; });
  keep("/kept");
  for (const CacheMode mode : {CacheMode::ReadOnly, CacheMode::Off}) {
    options.cache.mode = mode;
    keep("/new");
    HttpFetcher fetcher(options);
    EXPECT_FALSE(askFor(fetcher, server.url("/new"))->isFromCache);
    EXPECT_EQ(askFor(fetcher, server.url("/kept"))->isFromCache, mode == CacheMode::ReadOnly);
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
