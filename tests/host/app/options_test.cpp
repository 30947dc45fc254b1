#include "host/app/options.h"

#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace meridian::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

using Parsed = std::variant<Options, EarlyExit>;

Parsed parse(const std::vector<const char*>& arguments) {
  return parseOptions(arguments);
}

Options accepted(const std::vector<const char*>& arguments) {
  const Parsed parsed = parse(arguments);
  if (const auto* exit = std::get_if<EarlyExit>(&parsed)) {
    ADD_FAILURE() << exit->text;
    return {};
  }
  return std::get<Options>(parsed);
}

constexpr double degree = std::numbers::pi / 180.0;

TEST(Options, DefaultsWithoutArguments) {
  const Options options = accepted({});
  EXPECT_TRUE(options.assets.empty());
  EXPECT_FALSE(options.headless);
  EXPECT_FALSE(options.validate);
  EXPECT_EQ(options.size, glm::ivec2(1280, 720));
  EXPECT_FALSE(options.frames || options.fps || options.settleSeconds || options.output || options.stats);
  EXPECT_FALSE(options.hasFixedStep());
  EXPECT_EQ(options.logLevel, log::Level::Info);
}

TEST(Options, TakesTheWholeCommandLine) {
  const Options options = accepted({"earth.asset", "--headless",
                                    "--size",      "640x360",
                                    "--time",      "2026-03-20T14:46:00",
                                    "--camera",    "-46.5,8,20000,180,-30",
                                    "--anchor",    "Earth",
                                    "--set",       "Scene.*.Enabled=false",
                                    "--set",       "A.B={1, 2}",
                                    "--script",    "run.lua",
                                    "--record",    "flight.osrectxt",
                                    "--frames",    "12",
                                    "--fps",       "29.97",
                                    "--settle",    "2.5",
                                    "--output",    "out",
                                    "--stats",     "s.json",
                                    "--log",       "debug",
                                    "moon.asset"});
  EXPECT_THAT(options.assets, ElementsAre("earth.asset", "moon.asset"));
  EXPECT_TRUE(options.headless);
  EXPECT_TRUE(options.hasFixedStep());
  EXPECT_EQ(options.size, glm::ivec2(640, 360));
  ASSERT_TRUE(options.time);
  EXPECT_EQ(options.time->utc(), "2026-03-20T14:46:00.000");
  ASSERT_TRUE(options.camera);
  EXPECT_NEAR(options.camera->position.latitude, -46.5 * degree, 1e-15);
  EXPECT_NEAR(options.camera->position.longitude, 8.0 * degree, 1e-15);
  EXPECT_EQ(options.camera->position.height, 20000.0);
  EXPECT_NEAR(options.camera->heading, std::numbers::pi, 1e-15);
  EXPECT_NEAR(options.camera->pitch, -30.0 * degree, 1e-15);
  EXPECT_EQ(options.anchor, "Earth");
  ASSERT_EQ(options.settings.size(), 2U);
  EXPECT_EQ(options.settings[0].uri, "Scene.*.Enabled");
  EXPECT_EQ(options.settings[0].value, "false");
  EXPECT_EQ(options.settings[1].value, "{1, 2}");
  EXPECT_EQ(options.script, "run.lua");
  EXPECT_EQ(options.record, "flight.osrectxt");
  EXPECT_EQ(options.frames, 12U);
  EXPECT_EQ(options.fps, 29.97);
  EXPECT_EQ(options.settleSeconds, 2.5);
  EXPECT_EQ(options.output, "out");
  EXPECT_EQ(options.stats, "s.json");
  EXPECT_EQ(options.logLevel, log::Level::Debug);
}

TEST(Options, SplitsASettingAtTheFirstEqualsSign) {
  const Options options = accepted({"--set", "A.Url=\"http://host/?a=b\""});
  ASSERT_EQ(options.settings.size(), 1U);
  EXPECT_EQ(options.settings[0].uri, "A.Url");
  EXPECT_EQ(options.settings[0].value, "\"http://host/?a=b\"");
}

TEST(Options, LooksStraightDownWithoutHeadingAndPitch) {
  const Options options = accepted({"--camera", "10,20,3000"});
  ASSERT_TRUE(options.camera);
  EXPECT_EQ(options.camera->heading, 0.0);
  EXPECT_NEAR(options.camera->pitch, -std::numbers::pi / 2.0, 1e-15);
}

TEST(Options, ValidatesFilesAndFolders) {
  const Options options = accepted({"--validate", "assets", "other.asset"});
  EXPECT_TRUE(options.validate);
  EXPECT_THAT(options.assets, ElementsAre("assets", "other.asset"));
}

struct WrongCase {
  const char* name;
  std::vector<const char*> arguments;
  const char* says;  ///< part of the one line
};

class WrongOptions : public ::testing::TestWithParam<WrongCase> {};

TEST_P(WrongOptions, EndWithOneLineAndCodeTwo) {
  const Parsed parsed = parse(GetParam().arguments);
  const auto* exit = std::get_if<EarlyExit>(&parsed);
  ASSERT_NE(exit, nullptr);
  EXPECT_EQ(exit->code, ExitCode::WrongUsage);
  EXPECT_THAT(exit->text, HasSubstr(GetParam().says));
  EXPECT_EQ(exit->text.find('\n'), exit->text.size() - 1) << exit->text;
}

const WrongCase wrongCases[] = {
    {"Unknown", {"--nonsense"}, "--nonsense"},
    {"SizeWithoutValue", {"--size"}, "--size: expected WxH after it, found nothing"},
    {"SizeTwice", {"--size", "1x1", "--size", "2x2"}, "--size: given 2 times, expected once"},
    {"FlagWithValue", {"--headless=foo"}, "--headless: it takes no value, found 'foo'"},
    {"SecondWithoutValue", {"--set", "A.B=1", "--set"}, "--set: expected URI=VALUE after it, found nothing"},
    {"SizeNoNumbers", {"--size", "big"}, "'big'"},
    {"SizeZero", {"--size", "0x720"}, "'0x720'"},
    {"SizeNegative", {"--size", "1280x-720"}, "'1280x-720'"},
    {"SizeNaN", {"--size", "nanxnan"}, "--size"},
    {"SizeTooLarge", {"--size", "16385x1"}, "16384"},
    {"TooManyPixels", {"--size", "16384x16384"}, "67 million at most"},
    {"SizeOverflow", {"--size", "99999999999999999999x1"}, "--size"},
    {"SizeTrailing", {"--size", "12x34x56"}, "--size"},
    {"SizeEmpty", {"--size", ""}, "--size"},
    {"FramesZero", {"--frames", "0"}, "--frames"},
    {"FramesNegative", {"--frames", "-3"}, "--frames"},
    {"FramesFraction", {"--frames", "2.5"}, "--frames"},
    {"FramesHuge", {"--frames", "1e99"}, "--frames"},
    {"FpsZero", {"--fps", "0"}, "--fps"},
    {"FpsNegative", {"--fps", "-30"}, "--fps"},
    {"FpsNaN", {"--fps", "nan"}, "--fps"},
    {"FpsInfinite", {"--fps", "inf"}, "--fps"},
    {"SettleNegative", {"--settle", "-1"}, "--settle"},
    {"SettleNaN", {"--settle", "nan"}, "--settle"},
    {"SettleText", {"--settle", "10s"}, "'10s'"},
    {"CameraTwoNumbers", {"--camera", "1,2"}, "--camera"},
    {"CameraFourNumbers", {"--camera", "1,2,3,4"}, "--camera"},
    {"CameraLatitude", {"--camera", "91,0,1000"}, "--camera"},
    {"CameraLongitude", {"--camera", "0,361,1000"}, "--camera"},
    {"CameraAltitudeInfinite", {"--camera", "0,0,inf"}, "--camera"},
    {"CameraAltitudeTooHigh", {"--camera", "0,0,1e300"}, "--camera"},
    {"CameraAltitudeTooDeep", {"--camera", "0,0,-1e7"}, "--camera"},
    {"CameraNaN", {"--camera", "nan,0,1000"}, "--camera"},
    {"CameraPitch", {"--camera", "0,0,1000,0,-91"}, "--camera"},
    {"CameraText", {"--camera", "north,0,1000"}, "--camera"},
    {"Time", {"--time", "yesterday"}, "--time"},
    {"TimeNotInTheCalendar", {"--time", "2026-02-30"}, "--time"},
    {"SetWithoutValue", {"--set", "A.B"}, "URI=VALUE"},
    {"SetWithoutUri", {"--set", "=1"}, "URI=VALUE"},
    {"SetEmptyValue", {"--set", "A.B="}, "URI=VALUE"},
    {"LogLevel", {"--log", "loud"}, "'loud'"},
    {"EmptyOutput", {"--output", ""}, "--output"},
    {"EmptyAsset", {""}, "ASSET"},
    {"PlayAndRecord", {"--play", "a", "--record", "b"}, "--record"},
    {"PlayAndCamera", {"--play", "a", "--camera", "0,0,1000"}, "--camera"},
    {"ValidateAndOutput", {"--validate", "--output", "a.png"}, "--output"},
    {"ValidateAndPlay", {"--validate", "--play", "a"}, "--play"},
    {"ValidateAndFrames", {"--validate", "--frames", "3"}, "--frames"},
};

INSTANTIATE_TEST_SUITE_P(Options, WrongOptions, ::testing::ValuesIn(wrongCases),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(Options, HelpNamesEveryOption) {
  const Parsed parsed = parse({"--help"});
  const auto& exit = std::get<EarlyExit>(parsed);
  EXPECT_EQ(exit.code, ExitCode::Done);
  for (const char* name :
       {"--headless", "--size", "--time", "--camera", "--anchor", "--set", "--script", "--play", "--record", "--frames",
        "--fps", "--settle", "--output", "--stats", "--validate", "--log", "--version", "--help"}) {
    EXPECT_THAT(exit.text, HasSubstr(name));
  }
}

TEST(Options, VersionIsOneLine) {
  const Parsed parsed = parse({"--version"});
  const auto& exit = std::get<EarlyExit>(parsed);
  EXPECT_EQ(exit.code, ExitCode::Done);
  EXPECT_THAT(exit.text, ::testing::MatchesRegex("meridian [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

}  // namespace
}  // namespace meridian::app
