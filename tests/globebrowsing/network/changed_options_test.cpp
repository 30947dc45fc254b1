// Options that change while the network runs: what is asked afterwards heeds them.
#include <gmock/gmock.h>

#include "network_fixture.h"
#include "support/fault_server.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;
using Fault = FaultServer::Reply::Fault;

class ChangedOptions : public testing::Test {
 protected:
  /// With connections and handles that were used before.
  ChangedOptions() {
    server_.on("/", {.body = "good"});
    EXPECT_TRUE(askFor(fetcher_, server_.url("/")));
  }
  template <class Change>
  void change(Change change) {
    change(options_);
    fetcher_.setOptions(options_);
  }

  FaultServer server_;
  NetworkOptions options_ = quickOptions();
  HttpFetcher fetcher_{options_};
};

TEST_F(ChangedOptions, UserAgent) {
  change([](NetworkOptions& options) { options.userAgent = "Somebody/1"; });
  ASSERT_TRUE(askFor(fetcher_, server_.url("/")));
  EXPECT_THAT(server_.requests().front().headers.at("user-agent"), HasSubstr("Meridian/"));
  EXPECT_EQ(server_.requests().back().headers.at("user-agent"), "Somebody/1");
}

TEST_F(ChangedOptions, ABodysBytesUnlessTheRequestSaysItself) {
  change([](NetworkOptions& options) { options.limits.bodyBytes = 3; });
  const auto refused = askFor(fetcher_, server_.url("/"));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message(), HasSubstr("larger than 3 bytes"));
  EXPECT_TRUE(ask(fetcher_, {.url = server_.url("/"), .maximumBytes = 4}));
}

TEST_F(ChangedOptions, RedirectsAndHeaders) {
  server_.on("/old", {.status = 302, .headers = {"Location: /"}});
  EXPECT_TRUE(askFor(fetcher_, server_.url("/old")));
  change([](NetworkOptions& options) { options.limits.redirects = 0; });
  EXPECT_FALSE(askFor(fetcher_, server_.url("/old")));
  change([](NetworkOptions& options) { options.limits.headerBytes = 8; });
  EXPECT_FALSE(askFor(fetcher_, server_.url("/")));
}

TEST_F(ChangedOptions, Attempts) {
  server_.on("/broken", {.status = 500});
  EXPECT_FALSE(askFor(fetcher_, server_.url("/broken")));
  EXPECT_EQ(server_.count("/broken"), 5U);
  change([](NetworkOptions& options) { options.retry.attempts = 2; });
  EXPECT_FALSE(askFor(fetcher_, server_.url("/broken")));
  EXPECT_EQ(server_.count("/broken"), 7U);
}

TEST_F(ChangedOptions, FailuresUntilAHostIsDown) {
  change([](NetworkOptions& options) {
    options.retry.failuresUntilDown = 1;
    options.retry.firstDelay = std::chrono::hours(1);
    options.retry.maximumDelay = std::chrono::hours(1);
  });
  server_.on("/once", [](const FaultServer::Request& request) {
    return FaultServer::Reply{.status = request.attempt == 0 ? 503 : 200, .body = "good"};
  });
  // Of a host that is down the pause counts, which is short; of one that is up the delay, which is not.
  EXPECT_TRUE(askFor(fetcher_, server_.url("/once")));
}

TEST_F(ChangedOptions, TimeLimits) {
  server_.on("/silent", {.fault = Fault::StallAtOnce});
  change([](NetworkOptions& options) {
    options.limits.totalTime = std::chrono::milliseconds(50);
    options.retry.attempts = 1;
  });
  EXPECT_FALSE(ask(fetcher_, {.url = server_.url("/silent"), .isPatient = false}));
}

TEST_F(ChangedOptions, NothingHereIsForgotten) {
  EXPECT_TRUE(askFor(fetcher_, server_.url("/missing")));
  EXPECT_TRUE(askFor(fetcher_, server_.url("/missing")));
  EXPECT_EQ(server_.count("/missing"), 1U);
  change([](NetworkOptions& options) { options.cache.negativeLifetime = std::chrono::milliseconds(0); });
  EXPECT_TRUE(askFor(fetcher_, server_.url("/missing")));
  EXPECT_TRUE(askFor(fetcher_, server_.url("/missing")));
  EXPECT_EQ(server_.count("/missing"), 3U);
}

TEST_F(ChangedOptions, RequestsAtOnce) {
  change([](NetworkOptions& options) { options.concurrency.perHost = 1; });
  std::vector<std::unique_ptr<Asked>> asked;
  for (int i = 0; i < 20; ++i) {
    const std::string target = "/" + std::to_string(i);
    server_.on(target, {.body = "good"});
    asked.push_back(std::make_unique<Asked>(fetcher_, FetchRequest{.url = server_.url(target)}));
  }
  for (const auto& one : asked) {
    EXPECT_TRUE(one->wait());
  }
  EXPECT_EQ(server_.mostAtOnce(), 1U);
}

TEST_F(ChangedOptions, WhatIsUnderWayGoesOnAsItBegan) {
  server_.dripMilliseconds = 20;
  server_.on("/slow", {.body = "slowly", .fault = Fault::Drip});
  Asked slow(fetcher_, {.url = server_.url("/slow")});
  ASSERT_TRUE(eventually([&] { return server_.count("/slow") == 1; }));
  change([](NetworkOptions& options) {
    options.limits.bodyBytes = 2;
    options.userAgent = "Somebody/2";
  });
  const auto answer = slow.wait();
  ASSERT_TRUE(answer) << answer.error().message();
  EXPECT_EQ(textOf(*answer), "slowly");
  // Its handle is one of before, and not used again.
  EXPECT_TRUE(ask(fetcher_, {.url = server_.url("/"), .maximumBytes = 100}));
  EXPECT_EQ(server_.requests().back().headers.at("user-agent"), "Somebody/2");
}

}  // namespace
}  // namespace meridian::globebrowsing
