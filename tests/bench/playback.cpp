// Plays a map service's times as fast as is asked, the service being plain files behind nginx on this machine:
//   bench-playback [--seconds S] [--rate STEPS_A_SECOND] [--size WxH]
// Prints one JSON object: what of it is on the screen, by the pictures, and what memory it takes.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "host/api/log.h"
#include "settled_globe.h"
#include "support/nginx_server.h"
#include "support/timed_pyramid.h"

namespace {

using namespace meridian;
using Clock = std::chrono::steady_clock;

struct Options {
  double seconds = 60.0;
  double rate = 10.0;
  glm::ivec2 size{640, 360};
};

constexpr double framesPerSecond = 60.0;
/// Of the globe, in pixels of the picture's height, from this place.
constexpr const char* place = "20,10,9000000";
constexpr double surelyGlobe = 0.3;

double residentMib() {
  long pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> pages;
  return static_cast<double>(pages) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1 << 20);
}

std::filesystem::path writeAsset(const NginxServer& server) {
  const std::filesystem::path file = server.root() / "playback.asset";
  std::ofstream(file)
      << "asset.onInitialize(function()\n  openspace.addSceneGraphNode({ Identifier = 'Earth', Renderable "
         "= { Type = 'RenderableGlobe', Radii = 6378137, PerformShading = false, Layers = { ColorLayers "
         "= { { Identifier = 'Days', Enabled = true, FilePath = '"
      << TimedPyramid::filePath(server.http1()) << "' } } } } })\nend)\n";
  return file;
}

Result<void> play(const Options& options) {
  const NginxServer server;
  const int days = static_cast<int>(options.seconds * options.rate) + 2;
  TimedPyramid{.days = days}.write(server.root(), server.http1());
  auto globe = bench::SettledGlobe::create(place, options.size, writeAsset(server), "2004-01-01T00:00:00");
  if (!globe) {
    return tl::make_unexpected(globe.error());
  }
  const double radius = surelyGlobe * options.size.y;
  int frames = 0;
  int blank = 0;
  int mixed = 0;
  int shown = 0;
  int last = 0;
  double early = 0.0;
  double most = 0.0;
  const auto start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  for (double now = elapsed(); now < options.seconds; now = elapsed()) {
    (*globe)->application().clock().setTime(TimedPyramid::timeOf(now * options.rate));
    (*globe)->frame();
    const TimedPicture picture = TimedPicture::look((*globe)->picture(), options.size.x, options.size.y, radius);
    ++frames;
    blank += picture.isBlank ? 1 : 0;
    mixed += picture.isMixed ? 1 : 0;
    shown += picture.colour >= 0 && picture.colour != last ? 1 : 0;
    last = picture.colour >= 0 ? picture.colour : last;
    const double memory = residentMib();
    (now < options.seconds / 4 ? early : most) = std::max(now < options.seconds / 4 ? early : most, memory);
    std::this_thread::sleep_until(start + std::chrono::duration<double>(frames / framesPerSecond));
  }
  const std::string log = server.accessLog();
  fmt::print(
      "{{\"asked_per_second\": {}, \"shown_per_second\": {}, \"frames\": {}, \"blank_frames\": {}, "
      "\"mixed_frames\": {}, \"memory_growth_mib\": {:.1f}, \"memory_mib\": {:.1f}, \"tiles_loaded\": {}, "
      "\"requests\": {}}}\n",
      options.rate, shown / elapsed(), frames, blank, mixed, most - early, most,
      (*globe)->application().statistics().tiles.loaded.load(), std::count(log.begin(), log.end(), '\n'));
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--seconds") {
      options.seconds = std::strtod(argv[i + 1], nullptr);
    } else if (name == "--rate") {
      options.rate = std::strtod(argv[i + 1], nullptr);
    } else if (name == "--size") {
      std::sscanf(argv[i + 1], "%dx%d", &options.size.x, &options.size.y);
    }
  }
  if (!(options.seconds > 0.0) || !(options.rate > 0.0) || options.size.x < 16 || options.size.y < 16) {
    std::fputs("usage: bench-playback [--seconds S] [--rate STEPS_A_SECOND] [--size WxH]\n", stderr);
    return 2;
  }
  log::setLevel(log::Level::Warning);
  ::setenv("MERIDIAN_CACHE_MODE", "off", 1);  // not for the user's cache
  try {
    if (const auto played = play(options); !played) {
      log::error("{}", played.error().message());
      return 1;
    }
  } catch (const std::exception& exception) {  // of the server
    log::error("{}", exception.what());
    return 1;
  }
  return 0;
}
