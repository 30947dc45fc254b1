// What layers cost, over the Earth of the default scene with 50 colour layers. Prints one JSON object:
//   bench-layers [--camera LAT,LON,ALT[,HEADING,PITCH]] [--size WxH] [--rounds N]

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "host/api/log.h"
#include "settled_globe.h"

namespace {

using namespace meridian;
using bench::SettledGlobe;
using globebrowsing::Layer;
using globebrowsing::LayerGroupId;
using Clock = std::chrono::steady_clock;

constexpr int layerCount = 50;
constexpr int enabledCount = 8;
constexpr int framesOfAState = 20;
constexpr int framesOfAFade = 60;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

std::ptrdiff_t entries(const char* folder) {
  return std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator());
}

class LayerBenchmark {
 public:
  LayerBenchmark(SettledGlobe& globe, glm::ivec2 size) : globe_(globe), size_(size) {}

  /// Puts 50 layers of the scene's own rasters in the place of its colour layers; the lowest is opaque.
  Result<void> addLayers() {
    auto& earth = dynamic_cast<globebrowsing::RenderableGlobe&>(*globe_.application().renderable("Earth"));
    globebrowsing::LayerGroup& group = earth.layers().group(LayerGroupId::ColorLayers);
    std::vector<Value> files;
    for (const auto& layer : group.layers()) {
      layer->enabled.put(false);
      files.push_back(*layer->request().table.find("FilePath"));
    }
    for (int i = 0; i < layerCount; ++i) {
      const Value table = Table{{},
                                {{"Identifier", fmt::format("L{}", i)},
                                 {"FilePath", files[static_cast<std::size_t>(i) % files.size()]},
                                 {"Opacity", i == 0 ? 1.0 : 0.3}}};
      auto added = earth.layers().addLayer("ColorLayers", {table, "bench", "Layer", ""});
      if (!added) {
        return tl::make_unexpected(added.error());
      }
      layers_.push_back(*added);
    }
    return {};
  }

  /// Everything once, so that programs and tiles are there.
  Result<void> warmUp() {
    for (const int count : {1, enabledCount, enabledCount + 1, enabledCount}) {
      if (auto done = enable(count); !done) {
        return done;
      }
    }
    fade(nullptr);
    layers_[layerCount - 1]->enabled.put(true);
    return globe_.settle();
  }

  Result<void> measureFrames(int rounds) {
    std::vector<double> one;
    std::vector<double> eight;
    std::vector<double> fading;
    // In turn, so that all see the machine in the same mood.
    for (int round = 0; round < rounds; ++round) {
      if (auto done = enable(1); !done) {
        return done;
      }
      still(one);
      if (auto done = enable(enabledCount); !done) {
        return done;
      }
      still(eight);
      const std::uint64_t composed = globe_.surface().tiles().composites().composedCount();
      fade(&fading);
      composed_ += globe_.surface().tiles().composites().composedCount() - composed;
    }
    one_ = median(one);
    eight_ = median(eight);
    fading_ = median(fading);
    composed_ /= static_cast<std::uint64_t>(rounds);
    return {};
  }

  Result<void> measureToggles(int rounds) {
    for (int round = 0; round < rounds; ++round) {
      if (auto done = enable(enabledCount); !done) {
        return done;
      }
      const std::vector<std::uint8_t> before = globe_.picture();
      layers_[layerCount - 1]->enabled.put(true);
      const auto start = Clock::now();
      int frames = 0;
      bool seen = false;
      do {
        globe_.frame();
        ++frames;
        if (!seen && globe_.picture() != before) {
          seen = true;
          toggleFrames_ = std::max(toggleFrames_, frames);
        }
        if (secondsSince(start) > 30.0) {
          return failure("a toggled layer does not arrive: " + globe_.renderer().settled().reason);
        }
      } while (!seen || !globe_.renderer().settled().complete);
      toggleSeconds_ = std::max(toggleSeconds_, secondsSince(start));
      layers_[layerCount - 1]->enabled.put(false);
    }
    return {};
  }

  /// A second globe with 500 layers that are not enabled, as an asset.
  Result<void> measureLoading() {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / fmt::format("meridian-bench-{}.asset", ::getpid());
    writeAsset(file);
    const auto& tiles = globe_.application().statistics().tiles;
    const auto requested = tiles.requested.load();
    const auto threads = entries("/proc/self/task");
    const auto files = entries("/proc/self/fd");
    const auto start = Clock::now();
    Result<void> loaded = globe_.application().load(file.string());
    globe_.frame();
    loadSeconds_ = secondsSince(start);
    std::filesystem::remove(file);
    loadTakes_ = static_cast<std::ptrdiff_t>(tiles.requested - requested) + entries("/proc/self/task") - threads +
                 entries("/proc/self/fd") - files;
    return loaded;
  }

  [[nodiscard]] std::string report() const {
    return fmt::format(
        "{{\"one_ms\": {:.3f}, \"eight_ms\": {:.3f}, \"fading_ms\": {:.3f}, \"composed_in_a_fade\": {}, "
        "\"toggle_frames\": {}, \"toggle_s\": {:.3f}, \"load_s\": {:.3f}, \"load_takes\": {}, \"chunks\": {}}}\n",
        one_, eight_, fading_, composed_, toggleFrames_, toggleSeconds_, loadSeconds_, loadTakes_,
        globe_.surface().selected().size());
  }

 private:
  /// The lowest so many, and settles.
  Result<void> enable(int count) {
    for (int i = 0; i < layerCount; ++i) {
      layers_[static_cast<std::size_t>(i)]->enabled.put(i < count);
    }
    return globe_.settle();
  }
  void still(std::vector<double>& times) {
    for (int i = 0; i < framesOfAState; ++i) {
      times.push_back(globe_.frame());
    }
  }
  /// The uppermost layer, out in 60 frames and in again.
  void fade(std::vector<double>* times) {
    Layer& layer = *layers_[enabledCount - 1];
    for (int i = 1; i <= 2 * framesOfAFade; ++i) {
      layer.fade.put(std::abs(1.0 - static_cast<double>(i) / framesOfAFade));
      const double milliseconds = globe_.frame();
      if (times != nullptr) {
        times->push_back(milliseconds);
      }
    }
  }
  static void writeAsset(const std::filesystem::path& file) {
    std::ofstream text(file);
    text << "local layers = {}\nfor i = 1, 500 do\n"
            "  local path = i % 2 == 0 and openspace.absPath('${CACHE}/data/earth_blue_marble.tif')\n"
            "    or 'https://127.0.0.1:9/' .. i .. '/{z}/{x}/{y}.png'\n"
            "  layers[i] = { Identifier = 'Layer' .. i, Name = 'Layer ' .. i, FilePath = path }\nend\n"
            "asset.onInitialize(function()\n  openspace.addSceneGraphNode({ Identifier = 'Loaded', Renderable = {\n"
            "    Type = 'RenderableGlobe', Radii = 1000, Layers = { ColorLayers = layers } } })\nend)\n";
  }

  SettledGlobe& globe_;
  glm::ivec2 size_;
  std::vector<Layer*> layers_;
  double one_ = 0.0;
  double eight_ = 0.0;
  double fading_ = 0.0;
  std::uint64_t composed_ = 0;
  int toggleFrames_ = 0;
  double toggleSeconds_ = 0.0;  ///< of the slowest
  double loadSeconds_ = 0.0;
  std::ptrdiff_t loadTakes_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  std::string camera = "20,10,20000000";
  glm::ivec2 size(1280, 720);
  int rounds = 5;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--camera") == 0) {
      camera = argv[i + 1];
    } else if (std::strcmp(argv[i], "--rounds") == 0) {
      rounds = std::max(1, std::atoi(argv[i + 1]));
    } else if (std::strcmp(argv[i], "--size") == 0) {
      std::sscanf(argv[i + 1], "%dx%d", &size.x, &size.y);
    }
  }
  log::setLevel(log::Level::Warning);
  auto globe = SettledGlobe::create(camera, size);
  if (!globe) {
    log::error("{}", globe.error().message());
    return 1;
  }
  LayerBenchmark benchmark(**globe, size);
  for (const auto& step : std::initializer_list<std::function<Result<void>()>>{
           [&] { return benchmark.addLayers(); }, [&] { return benchmark.warmUp(); },
           [&] { return benchmark.measureFrames(rounds); }, [&] { return benchmark.measureToggles(rounds); },
           [&] { return benchmark.measureLoading(); }}) {
    if (const Result<void> done = step(); !done) {
      log::error("{}", done.error().message());
      return 1;
    }
  }
  fmt::print("{}", benchmark.report());
  return 0;
}
