#include <fstream>
#include <set>
#include <sstream>

#include <gmock/gmock.h>

#include "globebrowsing/network/http_fetcher.h"
#include "network_fixture.h"
#include "support/nginx_server.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;

/// A server that we have not written, over HTTP/1.1, over TLS, and over HTTP/2.
class Nginx : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!NginxServer::isInstalled()) {
      return;
    }
    server = std::make_unique<NginxServer>();
    for (int i = 0; i < 200; ++i) {
      std::ofstream(server->root() / (std::to_string(i) + ".png"))
          << std::string(3000, static_cast<char>('a' + i % 26));
    }
  }
  static void TearDownTestSuite() { server.reset(); }
  void SetUp() override {
    if (server == nullptr) {
      GTEST_SKIP() << "nginx is not installed; install nginx-light";
    }
    options.certificateFile = server->authority();
    options.cache.folder = folder.path();
  }

  void fetchAll(const std::string& base) {
    HttpFetcher fetcher(options);
    std::vector<std::unique_ptr<Asked>> asked;
    for (int i = 0; i < 200; ++i) {
      asked.push_back(std::make_unique<Asked>(fetcher, FetchRequest{.url = base + "/" + std::to_string(i) + ".png"}));
    }
    for (std::size_t i = 0; i < asked.size(); ++i) {
      const auto answer = asked[i]->wait();
      ASSERT_TRUE(answer) << answer.error().message();
      EXPECT_EQ(textOf(*answer), std::string(3000, static_cast<char>('a' + i % 26)));
      EXPECT_EQ(answer->contentType, "image/png");
    }
    connections = fetcher.statistics().connections;
  }
  /// Of the requests that the log has since the last call: their protocols, and how many there were.
  static std::pair<std::set<std::string>, std::size_t> served() {
    static std::size_t read = 0;
    std::set<std::string> protocols;
    std::size_t count = 0;
    const auto count200 = [&] {
      std::istringstream log(server->accessLog().substr(read));
      protocols.clear();
      count = 0;
      for (std::string protocol, status, path, connection; log >> protocol >> status >> path >> connection; ++count) {
        protocols.insert(protocol);
      }
      return count >= 200;
    };
    eventually(count200);
    read = server->accessLog().size();
    return {protocols, count};
  }

  static inline std::unique_ptr<NginxServer> server;
  TestFolder folder;
  NetworkOptions options = quickOptions();
  std::uint64_t connections = 0;
};

TEST_F(Nginx, ServesOverHttp1) {
  fetchAll(server->http1());
  EXPECT_LE(connections, 8U);
  EXPECT_EQ(served(), std::pair(std::set<std::string>{"HTTP/1.1"}, std::size_t{200}));
}

TEST_F(Nginx, ServesOverHttp1WithTls) {
  fetchAll(server->http1OverTls());
  EXPECT_LE(connections, 8U);
  EXPECT_EQ(served(), std::pair(std::set<std::string>{"HTTP/1.1"}, std::size_t{200}));
}

TEST_F(Nginx, ServesOverHttp2InOneConnection) {
  fetchAll(server->http2());
  EXPECT_EQ(connections, 1U);
  EXPECT_EQ(served(), std::pair(std::set<std::string>{"HTTP/2.0"}, std::size_t{200}));
}

TEST_F(Nginx, RefusesCertificatesThatNobodyVouchesFor) {
  HttpFetcher fetcher(options);
  for (const std::string& base : {server->selfSigned(), server->otherName()}) {
    const auto answer = askFor(fetcher, base + "/1.png");
    ASSERT_FALSE(answer) << base;
    EXPECT_THAT(answer.error().what, HasSubstr("certificate cannot be verified")) << base;
    EXPECT_THAT(answer.error().remedy, HasSubstr("MERIDIAN_CA_FILE")) << base;
  }
  options.certificateFile.clear();
  HttpFetcher ofTheSystem(options);
  EXPECT_FALSE(askFor(ofTheSystem, server->http2() + "/1.png")) << "the system does not know our authority";
  EXPECT_EQ(fetcher.statistics().transfers + ofTheSystem.statistics().transfers, 3U) << "none is tried again";
}

TEST_F(Nginx, SaysWhichFileOfCertificatesCannotBeRead) {
  options.certificateFile = folder.path() / "missing.pem";
  HttpFetcher fetcher(options);
  const auto answer = askFor(fetcher, server->http2() + "/1.png");
  ASSERT_FALSE(answer);
  EXPECT_THAT(answer.error().what, HasSubstr("missing.pem"));
}

TEST_F(Nginx, AnswersWhetherAFileIsStillTheSame) {
  // Last written long ago, so the guess would be a week; a tenth of a second is what we allow.
  options.cache.rules.maximumHeuristic = std::chrono::seconds(0);
  const FetchRequest request{.url = server->http1() + "/7.png"};
  for (int i = 0; i < 3; ++i) {
    HttpFetcher fetcher(options);
    const auto answer = ask(fetcher, request);
    ASSERT_TRUE(answer);
    fetcher.accept(request, *answer);
    EXPECT_EQ(answer->isFromCache, i > 0);
    EXPECT_EQ(fetcher.statistics().revalidated, i > 0 ? 1U : 0U);
    EXPECT_EQ(answer->body->size(), 3000U);
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
