#include "host/app/statistics_report.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace meridian::app {
namespace {

using Json = nlohmann::ordered_json;

struct Series {
  const char* name;
  double Statistics::Frame::*member;
};
constexpr Series allSeries[] = {{"frame_ms", &Statistics::Frame::frame},
                                {"cpu_ms", &Statistics::Frame::cpu},
                                {"gpu_ms", &Statistics::Frame::gpu},
                                {"select_ms", &Statistics::Frame::select},
                                {"upload_ms", &Statistics::Frame::upload}};

std::vector<double> valuesOf(const Statistics& statistics, const Series& series) {
  std::vector<double> values;
  values.reserve(statistics.frames().size());
  for (const Statistics::Frame& frame : statistics.frames()) {
    values.push_back(frame.*series.member);
  }
  return values;
}

}  // namespace

Percentiles percentiles(std::vector<double> series) {
  std::erase_if(series, [](double value) { return !std::isfinite(value); });
  if (series.empty()) {
    return {};
  }
  std::sort(series.begin(), series.end());
  const std::size_t count = series.size();
  const auto nearestRank = [&](double percent) {
    const double rank = std::ceil(percent / 100.0 * static_cast<double>(count));
    return series[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
  };
  const double upperMiddle = series[count / 2];
  const double median = count % 2 == 1 ? upperMiddle : 0.5 * (series[count / 2 - 1] + upperMiddle);
  return {median, nearestRank(95.0), nearestRank(99.0), series.back()};
}

std::uint64_t peakResidentBytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0 || usage.ru_maxrss < 0) {
    return 0;
  }
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

std::string statisticsReport(const Statistics& statistics, std::uint64_t peakResidentBytes) {
  Json report;
  report["frames"] = statistics.frames().size();
  Json perFrame;
  for (const Series& series : allSeries) {
    auto values = valuesOf(statistics, series);
    perFrame[series.name] = values;
    const Percentiles figures = percentiles(std::move(values));
    report[series.name] = {
        {"median", figures.median}, {"p95", figures.p95}, {"p99", figures.p99}, {"max", figures.max}};
  }
  report["chunks"] = {{"drawn", statistics.chunks.drawn},
                      {"tree", statistics.chunks.tree},
                      {"culled_frustum", statistics.chunks.culledFrustum},
                      {"culled_horizon", statistics.chunks.culledHorizon}};
  const auto& tiles = statistics.tiles;
  report["tiles"] = {{"requested", tiles.requested.load()}, {"loaded", tiles.loaded.load()},
                     {"failed", tiles.failed.load()},       {"cancelled", tiles.cancelled.load()},
                     {"bytes", tiles.bytes.load()},         {"cache_hits", tiles.cacheHits.load()}};
  const auto& programs = statistics.programs;
  report["programs"] = {{"built", programs.built.load()},
                        {"cached", programs.cached.load()},
                        {"build_ms_max", programs.buildMsMax.load()},
                        {"frames_waited", programs.framesWaited.load()}};
  report["memory"] = {{"peak_rss", peakResidentBytes},
                      {"tile_cache", statistics.memory.tileCache},
                      {"texture_pool", statistics.memory.texturePool}};
  report["settled"] = {{"frames_settled", statistics.settled.framesSettled},
                       {"frames_timed_out", statistics.settled.framesTimedOut},
                       {"wait_ms", statistics.settled.waitMs}};
  report["per_frame"] = std::move(perFrame);
  return report.dump(2) + "\n";
}

Result<void> checkStatisticsFile(const std::filesystem::path& file) {
  std::error_code ignored;
  std::filesystem::create_directories(file.parent_path(), ignored);
  // Appends, so that what is there stays until there is something new.
  if (!std::ofstream(file, std::ios::binary | std::ios::app)) {
    return failure("the figures cannot be written there", file.string(), "name a file in a folder that can be written");
  }
  return {};
}

Result<void> writeStatistics(const Statistics& statistics, const std::filesystem::path& file) {
  const std::string report = statisticsReport(statistics, peakResidentBytes());
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  if (!stream) {
    return failure("the figures cannot be written there", file.string(), "name a file in a folder that can be written");
  }
  stream << report;
  stream.close();
  if (!stream) {
    return failure("the figures could not be written to the end", file.string(), "check the space left on the disk");
  }
  return {};
}

}  // namespace meridian::app
