#include "globebrowsing/network/web_address.h"

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

TEST(WebAddress, NamesTheHostWithItsPort) {
  struct Case {
    const char* url;
    const char* host;
    const char* sent;
  };
  for (const Case& test : {
           Case{"https://example.org/a?b=c#d", "https://example.org:443", "https://example.org/a?b=c"},
           Case{"HTTP://example.org:8080", "http://example.org:8080", "http://example.org:8080/"},
           Case{"http://[::1]:81/x", "http://[::1]:81", "http://[::1]:81/x"},
           Case{"http://example.org/wms?LAYERS=two words", "http://example.org:80",
                "http://example.org/wms?LAYERS=two+words"},
       }) {
    const auto address = parseWebAddress(test.url);
    ASSERT_TRUE(address) << address.error().message();
    EXPECT_EQ(address->host, test.host);
    EXPECT_EQ(address->url, test.sent);
    EXPECT_EQ(address->isEncrypted, address->host.substr(0, 6) == "https:");
  }
}

TEST(WebAddress, RefusesAllButHttp) {
  for (const char* url :
       {"", "tiles/0.png", "/etc/passwd", "file:///etc/passwd", "ftp://example.org/a", "gopher://a", "http://",
        "https://example.org/\r\nHost: other", "http://exa mple.org/", "http://example.org:99999/"}) {
    const auto address = parseWebAddress(url);
    ASSERT_FALSE(address) << url;
    EXPECT_EQ(address.error().where, url);
    EXPECT_FALSE(address.error().remedy.empty());
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
