#include "globebrowsing/network/network_options.h"

#include <cstdlib>

#include <gtest/gtest.h>

namespace meridian::globebrowsing {
namespace {

class NetworkEnvironment : public testing::Test {
 protected:
  void SetUp() override { TearDown(); }
  void TearDown() override {
    for (const char* name : {"MERIDIAN_CACHE_MODE", "MERIDIAN_CACHE_SIZE", "MERIDIAN_OFFLINE", "MERIDIAN_CA_FILE",
                             "MERIDIAN_CONNECTIONS_PER_HOST"}) {
      unsetenv(name);
    }
  }
};

TEST_F(NetworkEnvironment, SaysNothingByDefault) {
  const NetworkOptions options = withEnvironment({});
  EXPECT_EQ(options.cache.mode, CacheMode::ReadWrite);
  EXPECT_EQ(options.cache.maximumBytes, NetworkOptions().cache.maximumBytes);
  EXPECT_EQ(options.concurrency.perHost, 8);
  EXPECT_TRUE(options.certificateFile.empty());
}

TEST_F(NetworkEnvironment, SetsWhatItNames) {
  setenv("MERIDIAN_CACHE_MODE", "read-only", 1);
  setenv("MERIDIAN_CACHE_SIZE", "512M", 1);
  setenv("MERIDIAN_CONNECTIONS_PER_HOST", "2", 1);
  setenv("MERIDIAN_CA_FILE", "/some/ca.pem", 1);
  NetworkOptions options = withEnvironment({});
  EXPECT_EQ(options.cache.mode, CacheMode::ReadOnly);
  EXPECT_EQ(options.cache.maximumBytes, 512U << 20);
  EXPECT_EQ(options.concurrency.perHost, 2);
  EXPECT_EQ(options.certificateFile, "/some/ca.pem");
  setenv("MERIDIAN_OFFLINE", "1", 1);
  EXPECT_EQ(withEnvironment({}).cache.mode, CacheMode::CacheOnly);
  setenv("MERIDIAN_OFFLINE", "0", 1);
  EXPECT_EQ(withEnvironment({}).cache.mode, CacheMode::ReadOnly);
}

TEST_F(NetworkEnvironment, SizesHaveUnits) {
  struct Case {
    const char* text;
    std::uint64_t bytes;
  };
  for (const Case& test : {Case{"0", 0}, Case{"123", 123}, Case{"1K", 1024}, Case{"2GiB", std::uint64_t{2} << 30},
                           Case{"1T", std::uint64_t{1} << 40}}) {
    setenv("MERIDIAN_CACHE_SIZE", test.text, 1);
    EXPECT_EQ(withEnvironment({}).cache.maximumBytes, test.bytes) << test.text;
  }
}

TEST_F(NetworkEnvironment, NonsenseIsLeftOut) {
  for (const char* text : {"much", "-1", "1.5G", "1 G", "99999999999T", "M"}) {
    setenv("MERIDIAN_CACHE_SIZE", text, 1);
    EXPECT_EQ(withEnvironment({}).cache.maximumBytes, NetworkOptions().cache.maximumBytes) << text;
  }
  setenv("MERIDIAN_CACHE_MODE", "sometimes", 1);
  setenv("MERIDIAN_OFFLINE", "perhaps", 1);
  EXPECT_EQ(withEnvironment({}).cache.mode, CacheMode::ReadWrite);
  for (const char* text : {"0", "-3", "1001", "eight"}) {
    setenv("MERIDIAN_CONNECTIONS_PER_HOST", text, 1);
    EXPECT_EQ(withEnvironment({}).concurrency.perHost, 8) << text;
  }
}

}  // namespace
}  // namespace meridian::globebrowsing
