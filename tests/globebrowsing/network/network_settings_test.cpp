#include "globebrowsing/network/network_settings.h"

#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include "globebrowsing/network/network_properties.h"
#include "globebrowsing/network/on_demand_fetcher.h"
#include "network_fixture.h"

namespace meridian::globebrowsing {
namespace {

using testing::HasSubstr;
using Kind = NetworkSetting::Kind;

std::string nameOf(const NetworkSetting& setting) {
  return std::string(setting.variable);
}

/// Neither the default nor at an end of the range.
SettingValue otherValue(const NetworkSetting& setting) {
  if (setting.kind == Kind::Line || setting.kind == Kind::Path) {
    return "/other one";
  }
  if (!setting.isNumber()) {
    return 1.0;
  }
  return setting.minimum + (std::get<double>(setting.get({})) == setting.minimum + 7.0 ? 8.0 : 7.0);
}
/// As the environment has it.
std::string textOf(const NetworkSetting& setting, const SettingValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) {
    return *text;
  }
  const auto number = std::get<double>(value);
  if (setting.kind == Kind::Choice) {
    return std::string(cacheModeNames()[static_cast<std::size_t>(number)]);
  }
  if (setting.kind == Kind::Bytes) {
    return fmt::format("{}{}", number, setting.unit.substr(0, 1));
  }
  return fmt::format("{}", number);
}

class NetworkEnvironment : public testing::Test {
 protected:
  void SetUp() override { TearDown(); }
  void TearDown() override {
    for (const NetworkSetting& setting : networkSettings()) {
      unsetenv(nameOf(setting).c_str());
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

TEST_F(NetworkEnvironment, EachVariableIsRead) {
  for (const NetworkSetting& setting : networkSettings()) {
    const SettingValue value = otherValue(setting);
    ASSERT_NE(setting.get({}), value) << setting.variable;
    setenv(nameOf(setting).c_str(), textOf(setting, value).c_str(), 1);
    const NetworkOptions options = withEnvironment({});
    unsetenv(nameOf(setting).c_str());
    EXPECT_EQ(setting.get(options), value) << setting.variable;
    for (const NetworkSetting& other : networkSettings()) {
      const bool isMode = setting.kind == Kind::Choice || setting.kind == Kind::Switch;
      const bool isOthersMode = other.kind == Kind::Choice || other.kind == Kind::Switch;
      if (&other != &setting && !(isMode && isOthersMode)) {
        EXPECT_EQ(other.get(options), other.get({})) << setting.variable << " changes " << other.variable;
      }
    }
  }
}

TEST_F(NetworkEnvironment, WhatIsWrongIsToldAndLeftOut) {
  for (const NetworkSetting& setting : networkSettings()) {
    std::vector<std::string> wrong{"nonsense", "nan", "-5", "5 5", "1e999"};
    if (setting.isNumber()) {
      wrong.push_back(textOf(setting, setting.maximum + 1.0));
      wrong.push_back(textOf(setting, setting.minimum - 1.0));
    } else if (setting.kind == Kind::Line) {
      wrong = {"two\r\nlines", "\xC3\xA4"};
    } else if (setting.kind == Kind::Path) {
      continue;
    }
    for (const std::string& text : wrong) {
      setenv(nameOf(setting).c_str(), text.c_str(), 1);
      testing::internal::CaptureStderr();
      const NetworkOptions options = withEnvironment({});
      const std::string said = testing::internal::GetCapturedStderr();
      EXPECT_EQ(setting.get(options), setting.get({})) << setting.variable << "=" << text;
      EXPECT_THAT(said, HasSubstr(nameOf(setting)));
      EXPECT_THAT(said, HasSubstr(text));
      EXPECT_THAT(said, HasSubstr(setting.kind == Kind::Line ? "printable ASCII" : setting.values()));
    }
    unsetenv(nameOf(setting).c_str());
  }
}

/// The row that docs/network.md has of a setting.
std::string rowOf(const NetworkSetting& setting) {
  const auto code = [](std::string_view text) { return text.empty() ? "" : fmt::format("`{}`", text); };
  std::string values = setting.values();
  if (setting.kind == Kind::Choice) {
    values = fmt::format("`{}`", fmt::join(cacheModeNames(), "`, `"));
  }
  const std::string property =
      setting.property.empty() ? "" : code(setting.property) + (setting.isLive ? "" : ", read only");
  return fmt::format("| {} | {} | {} | {} | {} | {} |", code(setting.variable), property, setting.unit, values,
                     setting.defaultText(), setting.meaning);
}

TEST(NetworkDocumentation, ItsTableIsThatOfTheSettings) {
  std::ifstream file(MERIDIAN_SOURCE_FOLDER "/docs/network.md");
  ASSERT_TRUE(file);
  std::vector<std::string> rows;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("| `MERIDIAN_")) {
      rows.push_back(line);
    }
  }
  std::vector<std::string> expected;
  for (const NetworkSetting& setting : networkSettings()) {
    expected.push_back(rowOf(setting));
  }
  EXPECT_EQ(rows, expected) << fmt::format("{}", fmt::join(expected, "\n"));
}

class NetworkPropertiesTest : public testing::Test {
 protected:
  Property& property(const NetworkSetting& setting) { return *owner_.property(setting.property); }

  PropertyOwner owner_{"GlobeBrowsing"};
  NetworkOptions told_;
  int changes_ = 0;
  NetworkProperties properties_{owner_, {}, [this](const NetworkOptions& options) {
                                  told_ = options;
                                  ++changes_;
                                }};
};

TEST_F(NetworkPropertiesTest, EachThatIsLiveReachesTheFetchersOptions) {
  OnDemandFetcher fetcher(NetworkOptions{});
  PropertyOwner owner("GlobeBrowsing");
  const NetworkProperties properties(owner, {}, [&](const NetworkOptions& options) { fetcher.setOptions(options); });
  for (const bool isStarted : {false, true}) {
    if (isStarted) {
      EXPECT_FALSE(askFor(fetcher, "no address"));
      ASSERT_TRUE(fetcher.hasStarted());
    }
    for (const NetworkSetting& setting : networkSettings()) {
      if (setting.property.empty() || !setting.isLive) {
        continue;
      }
      const SettingValue before = setting.get(fetcher.options());
      const SettingValue value = isStarted ? setting.get({}) : otherValue(setting);
      Property& set = *owner.property(setting.property);
      const auto* text = std::get_if<std::string>(&value);
      const auto done = set.set(text != nullptr ? Value(*text) : Value(std::get<double>(value)));
      ASSERT_TRUE(done) << done.error().message();
      EXPECT_NE(before, value) << setting.property;
      EXPECT_TRUE(eventually([&] { return setting.get(fetcher.options()) == value; })) << setting.property;
    }
  }
}

TEST_F(NetworkPropertiesTest, RefuseWhatIsOutOfRange) {
  for (const NetworkSetting& setting : networkSettings()) {
    if (setting.property.empty()) {
      continue;
    }
    std::vector<Value> wrong{Value(true)};
    if (setting.isNumber() || setting.kind == Kind::Choice) {
      wrong.insert(wrong.end(), {Value(setting.minimum - 1.0), Value(setting.maximum + 1.0), Value("nonsense")});
    } else {
      wrong.emplace_back("two\nlines");
    }
    for (const Value& value : wrong) {
      const auto done = property(setting).set(value);
      ASSERT_FALSE(done) << setting.property;
      EXPECT_THAT(done.error().where, HasSubstr(std::string(setting.property)));
    }
  }
  EXPECT_EQ(changes_, 0);
}

TEST_F(NetworkPropertiesTest, WhatCountsAtStartIsReadOnly) {
  for (const char* name : {"NetworkCacheFolder", "NetworkCaFile"}) {
    EXPECT_TRUE(owner_.property(name)->isReadOnly());
    EXPECT_FALSE(owner_.property(name)->set(Value("/elsewhere")));
  }
}

TEST_F(NetworkPropertiesTest, OneLeavesTheOthersAsTheEnvironmentHadThem) {
  NetworkOptions odd;
  odd.cache.maximumBytes = 123;
  PropertyOwner owner("Odd");
  NetworkOptions told;
  const NetworkProperties properties(owner, odd, [&](const NetworkOptions& options) { told = options; });
  ASSERT_TRUE(owner.property("NetworkAttempts")->set(Value(2.0)));
  EXPECT_EQ(told.retry.attempts, 2);
  EXPECT_EQ(told.cache.maximumBytes, 123U);
}

}  // namespace
}  // namespace meridian::globebrowsing
