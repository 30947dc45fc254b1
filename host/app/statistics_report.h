#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/api/error.h"
#include "host/api/statistics.h"

namespace meridian::app {

/// Of a series: what `--stats` and the statistics panel give of each. All 0 for an empty series.
struct Percentiles {
  double median = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};

/// By the nearest rank: the smallest value that at least p per cent of the series do not exceed; the median of an even
/// count is the mean of the two in the middle. Values that are not finite are left out.
[[nodiscard]] Percentiles percentiles(std::vector<double> series);

/// Bytes of memory that this process has had resident at most, from the kernel's count; 0 where it is not told.
[[nodiscard]] std::uint64_t peakResidentBytes();

/// The JSON object of `--stats`, with the keys of docs/command-line.md (Statistics), ended by a line break.
[[nodiscard]] std::string statisticsReport(const Statistics& statistics, std::uint64_t peakResidentBytes);

/// Before a run, so that it is not lost: makes the folder, and the file if there is none. Errors: it cannot be written.
[[nodiscard]] Result<void> checkStatisticsFile(const std::filesystem::path& file);

/// Writes the report to a file. Errors: the file cannot be created, the disk is full.
[[nodiscard]] Result<void> writeStatistics(const Statistics& statistics, const std::filesystem::path& file);

}  // namespace meridian::app
