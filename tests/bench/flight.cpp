// Plays a session recording over the default scene, from a settled first frame, with frames as far apart as on a
// screen:
//   bench-flight --play FILE.osrectxt --frames N --fps F
// Prints the program's statistics; frame_ms is from the start of a frame to its fence, without the pause after it.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "host/api/log.h"
#include "host/app/options.h"
#include "host/app/session.h"
#include "host/app/statistics_report.h"
#include "settled_globe.h"

namespace {

using namespace meridian;
using Clock = std::chrono::steady_clock;

Result<void> fly(const app::Options& options) {
  auto globe = bench::SettledGlobe::create("20,10,20000000", options.size);
  if (!globe) {
    return tl::make_unexpected(globe.error());
  }
  auto session = app::Session::create((*globe)->application(), options, true);
  if (!session) {
    return tl::make_unexpected(session.error());
  }
  Statistics& statistics = (*globe)->application().statistics();
  const auto interval = std::chrono::duration<double>(1.0 / *options.fps);
  for (std::uint64_t number = 0; number < *options.frames; ++number) {
    const auto start = Clock::now();
    statistics.frame = {};
    if (auto advanced = (*session)->advance(); !advanced) {
      return advanced;
    }
    if (number == 0) {
      if (auto settled = (*globe)->settle(); !settled) {
        return settled;
      }
    }
    statistics.frame.frame = (*globe)->frame();
    statistics.endFrame();
    std::this_thread::sleep_until(start + interval);
  }
  fmt::print("{}", app::statisticsReport(statistics, app::peakResidentBytes()));
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  app::Options options;
  options.headless = true;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--play") {
      options.play = argv[i + 1];
    } else if (name == "--frames") {
      options.frames = std::strtoull(argv[i + 1], nullptr, 10);
    } else if (name == "--fps") {
      options.fps = std::strtod(argv[i + 1], nullptr);
    }
  }
  if (!options.play || !options.frames || !options.fps) {
    std::fputs("usage: bench-flight --play FILE.osrectxt --frames N --fps F\n", stderr);
    return 2;
  }
  log::setLevel(log::Level::Warning);
  if (const auto flown = fly(options); !flown) {
    log::error("{}", flown.error().message());
    return 1;
  }
  return 0;
}
