#include "host/app/statistics_report.h"

#include <cmath>
#include <filesystem>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace meridian::app {
namespace {

using ::testing::ElementsAre;
using Json = nlohmann::ordered_json;

std::vector<std::string> keys(const Json& object) {
  std::vector<std::string> names;
  for (const auto& [name, value] : object.items()) {
    names.push_back(name);
  }
  return names;
}

TEST(Percentiles, OfOneToAHundredAreTheNumbersThemselves) {
  std::vector<double> series;
  for (int i = 100; i >= 1; --i) {
    series.push_back(i);
  }
  const Percentiles figures = percentiles(series);
  EXPECT_EQ(figures.median, 50.5);
  EXPECT_EQ(figures.p95, 95.0);
  EXPECT_EQ(figures.p99, 99.0);
  EXPECT_EQ(figures.max, 100.0);
}

TEST(Percentiles, OfOneValueAreThatValue) {
  const Percentiles figures = percentiles({7.0});
  EXPECT_EQ(figures.median, 7.0);
  EXPECT_EQ(figures.p95, 7.0);
  EXPECT_EQ(figures.p99, 7.0);
  EXPECT_EQ(figures.max, 7.0);
}

TEST(Percentiles, OfAnOddCountHaveTheMiddleAsMedian) {
  EXPECT_EQ(percentiles({9.0, 1.0, 5.0}).median, 5.0);
}

TEST(Percentiles, OfNothingAreZero) {
  EXPECT_EQ(percentiles({}).max, 0.0);
}

TEST(Percentiles, LeaveOutWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Percentiles figures = percentiles({nan, 2.0, std::numeric_limits<double>::infinity()});
  EXPECT_EQ(figures.median, 2.0);
  EXPECT_EQ(figures.max, 2.0);
}

TEST(StatisticsReport, HasTheKeysOfTheContract) {
  Statistics statistics;
  statistics.frame = {3.0, 2.0, 1.0, 0.5, 0.25};
  statistics.endFrame();
  statistics.frame = {5.0, 4.0, 1.5, 0.75, 0.5};
  statistics.endFrame();
  statistics.chunks = {1, 2, 3, 4};
  statistics.tiles.requested = 10;
  statistics.tiles.loaded = 9;
  statistics.tiles.failed = 1;
  statistics.tiles.cancelled = 2;
  statistics.tiles.bytes = 4096;
  statistics.tiles.cacheHits = 7;
  statistics.programs.built = 3;
  statistics.programs.cached = 5;
  statistics.programs.buildMsMax = 412.5;
  statistics.programs.framesWaited = 1;
  statistics.memory = {100, 200};
  statistics.settled.framesSettled = 2;
  statistics.settled.framesTimedOut = 1;
  statistics.settled.waitMs = 80.0;

  const std::string text = statisticsReport(statistics, 123456);
  EXPECT_EQ(text.back(), '\n');
  const Json report = Json::parse(text);
  EXPECT_THAT(keys(report), ElementsAre("frames", "frame_ms", "cpu_ms", "gpu_ms", "select_ms", "upload_ms", "chunks",
                                        "tiles", "programs", "memory", "settled", "per_frame"));
  EXPECT_EQ(report["frames"], 2);
  for (const char* series : {"frame_ms", "cpu_ms", "gpu_ms", "select_ms", "upload_ms"}) {
    EXPECT_THAT(keys(report[series]), ElementsAre("median", "p95", "p99", "max")) << series;
    EXPECT_EQ(report["per_frame"][series].size(), 2U) << series;
  }
  EXPECT_EQ(report["frame_ms"]["median"], 4.0);
  EXPECT_EQ(report["frame_ms"]["max"], 5.0);
  EXPECT_EQ(report["per_frame"]["upload_ms"], Json::parse("[0.25, 0.5]"));
  EXPECT_EQ(report["chunks"], Json::parse(R"({"drawn":1,"tree":2,"culled_frustum":3,"culled_horizon":4})"));
  EXPECT_EQ(report["tiles"], Json::parse(R"({"requested":10,"loaded":9,"failed":1,"cancelled":2,"bytes":4096,
                                             "cache_hits":7})"));
  EXPECT_EQ(report["programs"], Json::parse(R"({"built":3,"cached":5,"build_ms_max":412.5,"frames_waited":1})"));
  EXPECT_EQ(report["memory"], Json::parse(R"({"peak_rss":123456,"tile_cache":100,"texture_pool":200})"));
  EXPECT_EQ(report["settled"], Json::parse(R"({"frames_settled":2,"frames_timed_out":1,"wait_ms":80.0})"));
}

TEST(StatisticsReport, OfNoFrameIsStillWhole) {
  const Json report = Json::parse(statisticsReport(Statistics(), 0));
  EXPECT_EQ(report["frames"], 0);
  EXPECT_TRUE(report["per_frame"]["frame_ms"].is_array());
}

TEST(StatisticsReport, PeakMemoryGrowsWithWhatIsTouched) {
  const std::uint64_t before = peakResidentBytes();
  const std::vector<char> block(64U << 20, 1);
  EXPECT_GE(peakResidentBytes() + (1U << 20), std::max<std::uint64_t>(before, block.size()));
  EXPECT_GT(peakResidentBytes(), block.size());
}

TEST(StatisticsReport, ThatCannotBeWrittenSaysWhere) {
  const Statistics statistics;
  const auto missing = writeStatistics(statistics, "/nonexistent/folder/s.json");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().where, "/nonexistent/folder/s.json");
  EXPECT_FALSE(writeStatistics(statistics, std::filesystem::temp_directory_path()));
}

TEST(StatisticsReport, OnAFullDiskIsAnError) {
  EXPECT_FALSE(writeStatistics(Statistics(), "/dev/full"));
}

}  // namespace
}  // namespace meridian::app
