#include "globebrowsing/network/http_fetcher.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <zlib.h>

#include "network_fixture.h"
#include "support/fault_server.h"

namespace meridian::globebrowsing {
namespace {

using Reply = FaultServer::Reply;
using Fault = FaultServer::Reply::Fault;
using testing::HasSubstr;
using testing::MatchesRegex;

TEST(HttpFetcher, GivesBodyTypeAndStatus) {
  FaultServer server;
  server.on("/tile.png", {.headers = {"Content-Type: image/png"}, .body = "pixels"});
  HttpFetcher fetcher(quickOptions());
  const auto answer = askFor(fetcher, server.url("/tile.png"));
  ASSERT_TRUE(answer) << answer.error().message();
  EXPECT_EQ(textOf(*answer), "pixels");
  EXPECT_EQ(answer->contentType, "image/png");
  EXPECT_EQ(answer->status, 200);
  EXPECT_FALSE(answer->isFromCache);
  const auto request = server.requests().front();
  EXPECT_THAT(request.headers.at("user-agent"), MatchesRegex("Meridian/[0-9.]+"));
  EXPECT_THAT(request.headers.at("accept-encoding"), HasSubstr("gzip"));
}

TEST(HttpFetcher, SendsFurtherHeadersAndRefusesThatOneBecomesTwo) {
  FaultServer server;
  server.on("/a", {.body = "a"});
  HttpFetcher fetcher(quickOptions());
  ASSERT_TRUE(ask(fetcher, {.url = server.url("/a"), .headers = {"X-Key: secret"}}));
  EXPECT_EQ(server.requests().front().headers.at("x-key"), "secret");
  for (const char* header : {"X-Key: a\r\nX-Other: b", "no colon", ": no name", "two words: x"}) {
    EXPECT_FALSE(ask(fetcher, {.url = server.url("/a"), .headers = {header}})) << header;
  }
  EXPECT_EQ(server.count(), 1U);
}

TEST(HttpFetcher, KeepsConnectionsAndItsLimitPerHost) {
  FaultServer server;
  server.onAnything([](const FaultServer::Request&) { return Reply{.body = std::string(1000, 'x')}; });
  HttpFetcher fetcher(quickOptions());
  std::vector<std::unique_ptr<Asked>> asked;
  for (int i = 0; i < 300; ++i) {
    asked.push_back(std::make_unique<Asked>(fetcher, FetchRequest{.url = server.url("/" + std::to_string(i))}));
  }
  for (const auto& one : asked) {
    ASSERT_TRUE(one->wait());
  }
  EXPECT_LE(server.mostAtOnce(), 8U);
  EXPECT_LE(server.connections(), 8U);
  EXPECT_EQ(fetcher.statistics().connections, server.connections());
  EXPECT_EQ(fetcher.statistics().transfers, 300U);
  EXPECT_EQ(fetcher.statistics().bytes, 300'000U);
}

TEST(HttpFetcher, ServesTheGreatestPriorityOfTheMoment) {
  FaultServer server;
  std::promise<void> gate;
  const std::shared_future<void> opened = gate.get_future().share();
  server.onAnything([&](const FaultServer::Request& request) {
    if (request.target == "/first") {
      opened.wait();
    }
    return Reply{.body = "x"};
  });
  NetworkOptions options = quickOptions();
  options.concurrency.perHost = 1;
  HttpFetcher fetcher(options);
  Asked first(fetcher, {.url = server.url("/first")});
  ASSERT_TRUE(eventually([&] { return server.count() == 1; }));
  Asked a(fetcher, {.url = server.url("/a"), .priority = 1.0});
  Asked b(fetcher, {.url = server.url("/b"), .priority = 2.0});
  Asked c(fetcher, {.url = server.url("/c"), .priority = 3.0});
  Asked nan(fetcher, {.url = server.url("/nan"), .priority = std::nan("")});
  a.pending().setPriority(9.0);
  c.pending().setPriority(0.5);
  ASSERT_TRUE(eventually([&] { return fetcher.statistics().waiting == 4; }));
  gate.set_value();
  for (Asked* one : {&first, &a, &b, &c, &nan}) {
    ASSERT_TRUE(one->wait());
  }
  std::vector<std::string> order;
  for (const auto& request : server.requests()) {
    order.push_back(request.target);
  }
  EXPECT_THAT(order, testing::ElementsAre("/first", "/a", "/b", "/c", "/nan"));
}

TEST(HttpFetcher, RequestsForTheSameShareOneTransfer) {
  FaultServer server;
  std::promise<void> gate;
  const std::shared_future<void> opened = gate.get_future().share();
  server.on("/shared", [&](const FaultServer::Request&) {
    opened.wait();
    return Reply{.body = "shared"};
  });
  HttpFetcher fetcher(quickOptions());
  std::vector<std::unique_ptr<Asked>> asked;
  for (int i = 0; i < 10; ++i) {
    asked.push_back(std::make_unique<Asked>(fetcher, FetchRequest{.url = server.url("/shared")}));
  }
  ASSERT_TRUE(eventually([&] { return fetcher.statistics().joined == 9 && server.count() == 1; }));
  asked.pop_back();  // the others still want it
  gate.set_value();
  for (const auto& one : asked) {
    EXPECT_EQ(textOf(*one->wait()), "shared");
  }
  EXPECT_EQ(server.count(), 1U);
}

TEST(HttpFetcher, NothingHereIsRememberedForAWhile) {
  FaultServer server;
  server.on("/204", {.status = 204});
  NetworkOptions options = quickOptions();
  HttpFetcher fetcher(options);
  for (int round = 0; round < 2; ++round) {
    std::vector<std::unique_ptr<Asked>> asked;
    for (int i = 0; i < 10'000; ++i) {
      asked.push_back(std::make_unique<Asked>(fetcher, FetchRequest{.url = server.url("/" + std::to_string(i))}));
    }
    for (const auto& one : asked) {
      const auto answer = one->wait();
      ASSERT_TRUE(answer);
      ASSERT_EQ(answer->body, nullptr);
    }
  }
  EXPECT_EQ(server.count(), 10'001U - 1U) << "each once";
  EXPECT_EQ(fetcher.statistics().negativeHits, 10'000U);
  for (int round = 0; round < 2; ++round) {
    EXPECT_EQ(askFor(fetcher, server.url("/204"))->body, nullptr);
  }
  EXPECT_EQ(server.count("/204"), 1U);

  const auto strict = ask(fetcher, {.url = server.url("/5"), .emptyStatuses = {}});
  ASSERT_FALSE(strict) << "who does not call 404 empty gets the error";
  EXPECT_THAT(strict.error().what, HasSubstr("404"));
}

TEST(HttpFetcher, WhatIsRejectedIsNotAskedAgainForAWhile) {
  FaultServer server;
  server.on("/exception", {.headers = {"Content-Type: text/xml"}, .body = "<ServiceException>no</ServiceException>"});
  NetworkOptions options = quickOptions();
  options.cache.negativeLifetime = std::chrono::seconds(2);
  HttpFetcher fetcher(options);
  const FetchRequest request{.url = server.url("/exception")};
  const auto answer = ask(fetcher, request);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->contentType, "text/xml");
  fetcher.reject(request);
  EXPECT_TRUE(eventually([&] {
    const auto again = ask(fetcher, request);
    return again && again->body != nullptr;
  })) << "until the lifetime is over";
  EXPECT_GE(fetcher.statistics().negativeHits, 1U);
  EXPECT_EQ(server.count(), 2U);
}

TEST(HttpFetcher, TriesAgainWhatMayGetBetter) {
  struct Case {
    const char* name;
    Reply reply;
  };
  for (const Case& test : {
           Case{"500", {.status = 500}},
           Case{"503", {.status = 503}},
           Case{"408", {.status = 408}},
           Case{"429", {.status = 429}},
           Case{"closed", {.fault = Fault::CloseAtOnce}},
           Case{"truncated", {.body = "0123456789", .fault = Fault::Truncate}},
           Case{"promises more", {.body = "0123456789", .fault = Fault::PromiseMore}},
       }) {
    FaultServer server;
    server.on("/x", [&](const FaultServer::Request& request) {
      return request.attempt < 2 ? test.reply : Reply{.body = "good"};
    });
    HttpFetcher fetcher(quickOptions());
    const auto answer = askFor(fetcher, server.url("/x"));
    ASSERT_TRUE(answer) << test.name << ": " << answer.error().message();
    EXPECT_EQ(textOf(*answer), "good") << test.name;
    EXPECT_EQ(server.count(), 3U) << test.name;
    EXPECT_EQ(fetcher.statistics().retries, 2U) << test.name;
  }
}

TEST(HttpFetcher, GivesUpInTheEndAndSaysWhy) {
  struct Case {
    const char* target;
    Reply reply;
    std::size_t attempts;
    const char* what;
  };
  const std::vector<Case> cases{
      {"/500", {.status = 500}, 5, "500"},
      {"/truncated", {.body = "0123456789", .fault = Fault::Truncate}, 5, "broke off"},
      {"/400", {.status = 400}, 1, "400"},
      {"/403", {.status = 403}, 1, "403"},
      {"/304", {.status = 304}, 1, "304"},
      {"/headers", {.fault = Fault::EndlessHeaders}, 1, "headers are larger than"},
      {"/encoding", {.headers = {"Content-Encoding: gzip"}, .body = "this is not gzip"}, 1, "compression"},
      {"/loop", {.status = 302, .headers = {"Location: /loop"}}, 1, "redirects without end"},
      {"/file", {.status = 302, .headers = {"Location: file:///etc/passwd"}}, 1, "neither http nor https"},
      {"/ftp", {.status = 302, .headers = {"Location: ftp://127.0.0.1/x"}}, 1, "neither http nor https"},
  };
  for (const Case& test : cases) {
    FaultServer server;
    server.on(test.target, test.reply);
    HttpFetcher fetcher(quickOptions());
    const auto answer = askFor(fetcher, server.url(test.target));
    ASSERT_FALSE(answer) << test.target;
    EXPECT_THAT(answer.error().what, HasSubstr(test.what)) << test.target;
    EXPECT_EQ(answer.error().where, server.url(test.target));
    EXPECT_FALSE(answer.error().remedy.empty()) << test.target;
    if (std::string(test.target) == "/loop") {
      EXPECT_LE(server.count(), 6U);
    } else {
      EXPECT_EQ(server.count(), test.attempts) << test.target;
    }
  }
}

TEST(HttpFetcher, FollowsRedirectsAndKeepsTheLastAnswersHeaders) {
  FaultServer server;
  server.on("/from", {.status = 301, .headers = {"Location: /to", "Content-Type: text/html"}, .body = "moved"});
  server.on("/to", {.headers = {"Content-Type: image/jpeg"}, .body = "there"});
  HttpFetcher fetcher(quickOptions());
  const auto answer = askFor(fetcher, server.url("/from"));
  ASSERT_TRUE(answer);
  EXPECT_EQ(textOf(*answer), "there");
  EXPECT_EQ(answer->contentType, "image/jpeg");
  NetworkOptions options = quickOptions();
  options.limits.redirects = 0;
  HttpFetcher strict(options);
  EXPECT_THAT(askFor(strict, server.url("/from")).error().what, HasSubstr("301"));
}

TEST(HttpFetcher, AnAnswerLongerThanItPromisesEndsWhereItPromised) {
  FaultServer server;
  server.on("/less", {.body = "0123456789", .fault = Fault::PromiseLess});
  HttpFetcher fetcher(quickOptions());
  EXPECT_EQ(textOf(*askFor(fetcher, server.url("/less"))), "01234");
}

/// Zeros, a thousand to one.
std::string gzipBomb(std::size_t bytes) {
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 9, Z_DEFAULT_STRATEGY);
  const std::string zeros(bytes, '\0');
  std::string packed(bytes / 100 + 1000, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(zeros.data()));
  stream.avail_in = static_cast<uInt>(zeros.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

TEST(HttpFetcher, CountsBytesAfterDecoding) {
  FaultServer server;
  server.on("/bomb", {.headers = {"Content-Encoding: gzip"}, .body = gzipBomb(50'000'000)});
  server.on("/plain", {.body = std::string(2000, 'x')});
  server.on("/error", {.status = 400, .body = std::string(2000, 'x')});
  HttpFetcher fetcher(quickOptions());
  for (const char* target : {"/bomb", "/plain", "/error"}) {
    const auto answer = ask(fetcher, {.url = server.url(target), .maximumBytes = 1999});
    ASSERT_FALSE(answer) << target;
    EXPECT_THAT(answer.error().what, HasSubstr("larger than 1999 bytes"));
    EXPECT_EQ(server.count(target), 1U) << target;
  }
  EXPECT_EQ(ask(fetcher, {.url = server.url("/plain"), .maximumBytes = 2000})->body->size(), 2000U);
  EXPECT_EQ(ask(fetcher, {.url = server.url("/bomb"), .maximumBytes = 50'000'000})->body->size(), 50'000'000U);
}

TEST(HttpFetcher, SlowServersAreGivenUp) {
  struct Case {
    const char* target;
    Reply reply;
  };
  for (const Case& test : {Case{"/silent", {.fault = Fault::StallAtOnce}},
                           Case{"/half", {.body = "0123456789", .fault = Fault::StallInBody}},
                           Case{"/drip", {.body = std::string(60, 'x'), .fault = Fault::Drip}}}) {
    FaultServer server;
    server.on(test.target, test.reply);
    for (const bool isStall : {true, false}) {
      NetworkOptions options = quickOptions();
      options.retry.attempts = 1;
      if (isStall) {
        options.limits.stallTime = std::chrono::seconds(1);
      } else {
        options.limits.totalTime = std::chrono::milliseconds(300);
      }
      HttpFetcher fetcher(options);
      const auto answer = ask(fetcher, {.url = server.url(test.target), .isPatient = false});
      ASSERT_FALSE(answer) << test.target;
      EXPECT_THAT(answer.error().what, HasSubstr("takes too long")) << test.target;
    }
  }
}

TEST(HttpFetcher, RetryAfterHoldsBackTheWholeHost) {
  FaultServer server;
  std::atomic<bool> isBusy{true};
  server.onAnything([&](const FaultServer::Request&) {
    return isBusy ? Reply{.status = 429, .headers = {"Retry-After: 3600"}} : Reply{.body = "good"};
  });
  NetworkOptions options = quickOptions();
  options.retry.maximumRetryAfter = std::chrono::seconds(3);
  HttpFetcher fetcher(options);
  Asked first(fetcher, {.url = server.url("/a")});
  ASSERT_TRUE(eventually([&] { return first.pending().lastFailure().has_value(); }));
  EXPECT_THAT(first.pending().lastFailure()->what, HasSubstr("429"));
  isBusy = false;
  Asked second(fetcher, {.url = server.url("/b")});
  ASSERT_TRUE(first.wait());
  ASSERT_TRUE(second.wait());
  EXPECT_EQ(server.count(), 3U) << "nothing was sent in between";
}

TEST(HttpFetcher, WaitsForAServerThatIsDownAndComesBackByItself) {
  FaultServer server;
  server.onAnything([](const FaultServer::Request&) { return Reply{.body = "back"}; });
  server.refuse();
  HttpFetcher fetcher(quickOptions());
  std::vector<std::unique_ptr<Asked>> asked;
  for (int i = 0; i < 50; ++i) {
    asked.push_back(std::make_unique<Asked>(fetcher, FetchRequest{.url = server.url("/" + std::to_string(i))}));
  }
  ASSERT_TRUE(eventually([&] { return fetcher.statistics().hostsDown == 1 && fetcher.statistics().transfers > 30; }));
  for (const auto& one : asked) {
    EXPECT_FALSE(one->isThere()) << "a tile that waits is not done";
  }
  server.listen();
  for (const auto& one : asked) {
    const auto answer = one->wait();
    ASSERT_TRUE(answer) << answer.error().message();
    EXPECT_EQ(textOf(*answer), "back");
  }
  EXPECT_EQ(server.count(), 50U);
  EXPECT_EQ(fetcher.statistics().failures, 0U);
}

/// Requests that were sent to see whether it is back, and hung, are sent again: here they would hang for an hour.
TEST(HttpFetcher, ComesBackByItselfFromAServerThatStalled) {
  FaultServer server;
  std::atomic<bool> isStalled{true};
  server.onAnything([&](const FaultServer::Request&) {
    return isStalled ? Reply{.fault = Fault::StallAtOnce} : Reply{.body = "back"};
  });
  server.refuse();
  NetworkOptions options = quickOptions();
  options.limits.totalTime = std::chrono::hours(1);
  options.limits.stallTime = std::chrono::hours(1);
  HttpFetcher fetcher(options);
  std::vector<std::unique_ptr<Asked>> asked;
  for (int i = 0; i < 50; ++i) {
    asked.push_back(std::make_unique<Asked>(fetcher, FetchRequest{.url = server.url("/" + std::to_string(i))}));
  }
  ASSERT_TRUE(eventually([&] { return fetcher.statistics().hostsDown == 1; }));
  server.listen();
  ASSERT_TRUE(eventually([&] { return server.count() >= 3; })) << "each hangs";
  isStalled = false;
  for (const auto& one : asked) {
    const auto answer = one->wait();
    ASSERT_TRUE(answer) << answer.error().message();
    EXPECT_EQ(textOf(*answer), "back");
  }
  EXPECT_EQ(fetcher.statistics().failures, 0U);
}

TEST(HttpFetcher, OneThatIsNotPatientSaysThatItsServerIsDown) {
  FaultServer server;
  server.on("/a", {.body = "a"});
  server.refuse();
  NetworkOptions options = quickOptions();
  options.retry.firstPause = options.retry.maximumPause = std::chrono::milliseconds(100);
  HttpFetcher fetcher(options);
  Asked patient(fetcher, {.url = server.url("/a")});
  for (int i = 0; i < 20; ++i) {
    const auto answer = ask(fetcher, {.url = server.url("/a"), .isPatient = false});
    ASSERT_FALSE(answer);
    EXPECT_FALSE(answer.error().remedy.empty());
  }
  EXPECT_FALSE(patient.isThere());
  server.listen();
  ASSERT_TRUE(patient.wait());
  EXPECT_TRUE(ask(fetcher, {.url = server.url("/a"), .isPatient = false}));
}

/// With the default waits, and everything down. What it costs to wait is how often the thread gets up for it.
TEST(HttpFetcher, WaitingCostsNothing) {
  FaultServer server;
  server.refuse();
  NetworkOptions options;
  options.retry.firstDelay = std::chrono::milliseconds(50);
  HttpFetcher fetcher(options);
  std::vector<std::unique_ptr<Asked>> asked;
  for (int i = 0; i < 1000; ++i) {
    asked.push_back(std::make_unique<Asked>(fetcher, FetchRequest{.url = server.url("/" + std::to_string(i))}));
  }
  ASSERT_TRUE(eventually([&] { return fetcher.statistics().hostsDown == 1; }));
  const std::uint64_t before = fetcher.statistics().wakeUps;
  constexpr int frames = 60;
  for (int i = 0; i < frames; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    for (const auto& one : asked) {
      one->pending().setPriority(i);
    }
  }
  EXPECT_LT(fetcher.statistics().wakeUps - before, static_cast<std::uint64_t>(frames) / 2)
      << "some are for another try";
  EXPECT_LT(fetcher.statistics().transfers, 30U);
}

TEST(HttpFetcher, RefusesWhatIsNoWebAddress) {
  HttpFetcher fetcher(quickOptions());
  for (const char* url : {"file:///etc/passwd", "ftp://127.0.0.1/x", "tile.png", ""}) {
    const auto answer = askFor(fetcher, std::string(url));
    ASSERT_FALSE(answer) << url;
    EXPECT_FALSE(answer.error().remedy.empty());
  }
  EXPECT_EQ(fetcher.statistics().transfers, 0U);
}

}  // namespace
}  // namespace meridian::globebrowsing
