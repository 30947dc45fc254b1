// What a view costs while all servers are down, or stalled, and how long it takes to come back when they do:
//   bench-outage [--size WxH]
// Two globes in one process look at the same: one is offline and has what lies on disk, the other one asks the servers.
// Prints one JSON object.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "host/api/log.h"
#include "settled_globe.h"
#include "support/fault_server.h"
#include "support/jpeg_pyramid.h"

namespace {

using namespace meridian;
using bench::SettledGlobe;
using globebrowsing::RenderableGlobe;
using Clock = std::chrono::steady_clock;

constexpr const char* place = "20,10,9000000";
constexpr double framesPerSecond = 30.0;
/// The goals count from here.
constexpr double settlingSeconds = 10.0;
/// The longest pause of a server that is down (RetryOptions::maximumPause).
constexpr double backoffPeriod = 15.0;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string firstWord(const std::filesystem::path& file) {
  std::string word;
  std::ifstream(file) >> word;
  return word;
}

/// Seconds that all threads of the network layer have run, by their own clocks.
double networkSeconds() {
  double nanoseconds = 0.0;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    if (firstWord(thread.path() / "comm").starts_with("network")) {
      nanoseconds += std::strtod(firstWord(thread.path() / "schedstat").c_str(), nullptr);
    }
  }
  return nanoseconds * 1e-9;
}

/// A server of tiles, all alike, that does not want its answers to be taken for fresh.
class Server {
 public:
  Server() { answer(); }
  [[nodiscard]] std::string url(const std::string& layer) const { return server_.url("/" + layer); }
  /// Requests that hang go on hanging.
  void answer() {
    server_.onAnything([this](const FaultServer::Request&) {
      return FaultServer::Reply{.headers = {"Content-Type: image/jpeg", "Cache-Control: max-age=0"}, .body = tile_};
    });
  }
  void stall() {
    server_.onAnything([](const FaultServer::Request&) {
      return FaultServer::Reply{.fault = FaultServer::Reply::Fault::StallAtOnce};
    });
  }
  void refuse() { server_.refuse(); }
  void listen() { server_.listen(); }

 private:
  std::string tile_ = JpegPyramid::tile();
  FaultServer server_;
};

enum class Outage { Down, Stalled };

class OutageBenchmark {
 public:
  OutageBenchmark(const std::filesystem::path& folder, glm::ivec2 size) : folder_(folder), size_(size) {}

  /// The globe that is offline is online first, so that a layer's tiles come to lie on disk.
  Result<void> prepare() {
    auto offline = create();
    if (!offline) {
      return tl::make_unexpected(offline.error());
    }
    offline_ = *std::move(offline);
    if (auto shown = add(*offline_, "Kept").and_then([&] { return offline_->settle(); }); !shown) {
      return shown;
    }
    std::this_thread::sleep_for(std::chrono::seconds(1));  // until it is written
    constexpr auto goOffline =
        "openspace.setPropertyValueSingle('Modules.GlobeBrowsing.NetworkCacheMode', 'cache-only')";
    if (auto set = offline_->application().scripts().run(goOffline, "outage.cpp"); !set) {
      return set;
    }
    auto online = create();
    if (!online) {
      return tl::make_unexpected(online.error());
    }
    online_ = *std::move(online);
    return {};
  }

  /// `seconds` that it lasts. A further layer of whose tiles none is on disk waits for it to end.
  Result<void> measure(Outage outage, double seconds) {
    const std::string lost = outage == Outage::Down ? "LostWhileDown" : "LostWhileStalled";
    outage == Outage::Down ? server_.refuse() : server_.stall();
    if (outage == Outage::Down) {
      // From the disk, though past its lifetime. Before the other: a chunk is composed once all its layers have
      // answered.
      if (auto shown = add(*online_, "Kept").and_then([&] { return online_->settle(); }); !shown) {
        return shown;
      }
    }
    if (auto added = add(*offline_, lost).and_then([&] { return add(*online_, lost); }); !added) {
      return added;
    }
    if (auto settled = offline_->settle(); !settled) {
      return settled;
    }
    watch(seconds);
    if (online_->renderer().settled().complete) {
      return failure("nothing waits for the servers");
    }
    if (online_->picture() != offline_->picture()) {
      return failure("the two globes do not look alike");
    }
    outage == Outage::Down ? server_.listen() : server_.answer();
    if (auto back = waitUntilBack(); !back) {
      return back;
    }
    if (online_->picture() == offline_->picture()) {
      return failure("the layer is not seen");
    }
    return remove(*offline_, lost).and_then([&] { return remove(*online_, lost); });
  }

  [[nodiscard]] std::string report() const {
    return fmt::format(
        "{{\"frame_ratio\": {:.3f}, \"network_cpu_percent\": {:.3f}, \"recovered_s\": {:.2f}, "
        "\"over_backoff_s\": {:.2f}, \"frame_ms\": {:.2f}, \"offline_ms\": {:.2f}}}",
        median(ratios_), cpuPercent_, recovered_, std::max(recovered_ - backoffPeriod, 0.0), median(onlineMs_),
        median(offlineMs_));
  }

 private:
  [[nodiscard]] Result<std::unique_ptr<SettledGlobe>> create() const {
    const std::filesystem::path file = folder_ / "outage.asset";
    std::ofstream(file) << "asset.onInitialize(function()\n  openspace.addSceneGraphNode({ Identifier = 'Earth', "
                           "Renderable = { Type = 'RenderableGlobe', Radii = 6378137, PerformShading = false } })\n"
                           "end)\n";
    return SettledGlobe::create(place, size_, file);
  }

  Result<void> add(SettledGlobe& globe, const std::string& layer) const {
    auto& earth = dynamic_cast<RenderableGlobe&>(*globe.application().renderable("Earth"));
    const Value table = Table{{},
                              {{"Identifier", layer},
                               {"Enabled", true},
                               {"Settings", Table{{}, {{"Multiplier", layer == "Kept" ? 1.0 : 0.5}}}},
                               {"FilePath", JpegPyramid::document(server_.url(layer))}}};
    return earth.layers().addLayer("ColorLayers", {table, "bench", "Layer", ""}).map([](auto*) {});
  }

  static Result<void> remove(SettledGlobe& globe, const std::string& layer) {
    return dynamic_cast<RenderableGlobe&>(*globe.application().renderable("Earth"))
        .layers()
        .deleteLayer("ColorLayers", layer);
  }

  /// Frames of both in turn, as far apart as on a screen.
  void watch(double seconds) {
    ratios_.clear();
    onlineMs_.clear();
    offlineMs_.clear();
    double cpuBefore = 0.0;
    double from = 0.0;
    const auto start = Clock::now();
    int frames = 0;
    for (double now = 0.0; now < seconds; now = secondsSince(start)) {
      const double offline = offline_->frame();
      const double online = online_->frame();
      if (now >= settlingSeconds) {
        if (ratios_.empty()) {
          cpuBefore = networkSeconds();
          from = secondsSince(start);
        }
        offlineMs_.push_back(offline);
        onlineMs_.push_back(online);
        ratios_.push_back(online / offline);
      }
      std::this_thread::sleep_until(start + std::chrono::duration<double>(++frames / framesPerSecond));
    }
    cpuPercent_ = 100.0 * (networkSeconds() - cpuBefore) / (secondsSince(start) - from);
  }

  Result<void> waitUntilBack() {
    const auto start = Clock::now();
    while (!online_->renderer().settled().complete) {
      online_->frame();
      recovered_ = secondsSince(start);
      if (recovered_ > 120.0) {
        return failure("the view does not come back: " + online_->renderer().settled().reason);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return {};
  }

  std::filesystem::path folder_;
  glm::ivec2 size_;
  Server server_;
  std::unique_ptr<SettledGlobe> offline_;
  std::unique_ptr<SettledGlobe> online_;
  std::vector<double> ratios_;
  std::vector<double> offlineMs_;
  std::vector<double> onlineMs_;
  double cpuPercent_ = 0.0;
  double recovered_ = 0.0;
};

Result<void> run(const std::filesystem::path& folder, glm::ivec2 size) {
  OutageBenchmark benchmark(folder, size);
  if (auto prepared = benchmark.prepare(); !prepared) {
    return prepared;
  }
  std::string parts;
  for (const auto& [name, outage, seconds] :
       {std::tuple("down", Outage::Down, 20.0), std::tuple("stalled", Outage::Stalled, 40.0)}) {
    if (auto measured = benchmark.measure(outage, seconds); !measured) {
      return measured;
    }
    parts += fmt::format("{}\"{}\": {}", parts.empty() ? "" : ",\n ", name, benchmark.report());
  }
  fmt::print("{{{}}}\n", parts);
  return {};
}

}  // namespace

int main(int argc, char** argv) {
  glm::ivec2 size(1280, 720);
  if (argc == 3 && argv[1] == std::string("--size")) {
    std::sscanf(argv[2], "%dx%d", &size.x, &size.y);
  }
  log::setLevel(log::Level::Error);
  std::string folder = (std::filesystem::temp_directory_path() / "meridian-outage-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr) {
    std::perror("no folder");
    return 1;
  }
  ::setenv("XDG_CACHE_HOME", folder.c_str(), 1);  // not the user's
  const Result<void> done = run(folder, size);
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  if (!done) {
    log::error("{}", done.error().message());
    return 1;
  }
  return 0;
}
