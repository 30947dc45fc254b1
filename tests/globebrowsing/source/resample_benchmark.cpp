#include <benchmark/benchmark.h>

#include "raster_fixture.h"

namespace meridian::globebrowsing {
namespace {

using namespace test;

/// Removed when the program ends.
struct TemporaryFile {
  std::string path;
  ~TemporaryFile() { std::filesystem::remove(path); }
};

/// A tiled RGB TIFF of 16384 x 8192 pixels with overviews, on disk.
const std::string& tiledTiff() {
  static const TemporaryFile made{[] {
    GDALAllRegister();
    std::string file = (std::filesystem::temp_directory_path() / "meridian-bench-resample.tif").string();
    const GDALDatasetUniquePtr small(
        GetGDALDriverManager()->GetDriverByName("MEM")->Create("", 512, 256, 3, GDT_Byte, nullptr));
    std::array<double, 6> transform = northUp(-180, 90, 360.0 / 512);
    small->SetGeoTransform(transform.data());
    for (int band = 1; band <= 3; ++band) {
      std::vector<std::uint8_t> pixels(512 * 256);
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i] = static_cast<std::uint8_t>((i * 2654435761U >> 7U) % 251);
      }
      if (small->GetRasterBand(band)->RasterIO(GF_Write, 0, 0, 512, 256, pixels.data(), 512, 256, GDT_Byte, 0, 0,
                                               nullptr) != CE_None) {
        std::abort();
      }
    }
    char** words = nullptr;
    for (const char* word :
         {"-outsize", "16384", "8192", "-r", "cubic", "-co", "TILED=YES", "-co", "INTERLEAVE=PIXEL"}) {
      words = CSLAddString(words, word);
    }
    GDALTranslateOptions* options = GDALTranslateOptionsNew(words, nullptr);
    CSLDestroy(words);
    const GDALDatasetUniquePtr large(
        GDALDataset::FromHandle(GDALTranslate(file.c_str(), small.get(), options, nullptr)));
    GDALTranslateOptionsFree(options);
    std::array<int, 4> factors{2, 4, 8, 16};
    if (!large || large->BuildOverviews("AVERAGE", 4, factors.data(), 0, nullptr, nullptr, nullptr) != CE_None) {
      std::abort();
    }
    return file;
  }()};
  return made.path;
}

template <class Resample>
void run(benchmark::State& state, const std::string& path, int level, double latitude, Resample resample) {
  if (path.front() == '/' && !std::filesystem::exists(path)) {
    state.SkipWithError("the raster is not on this machine");
    return;
  }
  const auto source = RasterSource::open({path});
  if (!source) {
    state.SkipWithError(source.error().message().c_str());
    return;
  }
  const GeodeticTiling tiling = earth();
  double longitude = -170;
  for (auto _ : state) {
    benchmark::DoNotOptimize(resample(**source, tiling, tileAt(tiling, latitude, longitude, level)));
    longitude = longitude > 160 ? -170 : longitude + 7.3;
  }
  state.counters["tiles/s"] = benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

const auto colour = [](const RasterSource& source, const Tiling& tiling, const TileIndex& index) {
  return resampleColours(source, tiling, index, colourLayout, {});
};
const auto height = [](const RasterSource& source, const Tiling& tiling, const TileIndex& index) {
  return resampleHeights(source, tiling, index, heightLayout, {});
};

void coloursFromTiledTiff(benchmark::State& state) {
  run(state, tiledTiff(), static_cast<int>(state.range(0)), 30, colour);
}
void coloursFromBlueMarble(benchmark::State& state) {
  run(state, blueMarble, static_cast<int>(state.range(0)), 30, colour);
}
void heightsFromEtopo5(benchmark::State& state) {
  run(state, etopo5, static_cast<int>(state.range(0)), 30, height);
}
void heightsFromPolarMoon(benchmark::State& state) {
  run(state, sharedData("dem/moon/DERIVED_ldem4_south_polar_stereo.tif"), 5, -80, height);
}
void coloursFromPolarMars(benchmark::State& state) {
  run(state, sharedData("imagery/mars/mola_clrshade_north_polar.tif"), 5, 75, colour);
}

BENCHMARK(coloursFromTiledTiff)->Arg(2)->Arg(4)->Arg(5)->Arg(9)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(coloursFromBlueMarble)->Arg(1)->Arg(3)->Arg(6)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(heightsFromEtopo5)->Arg(1)->Arg(3)->Arg(6)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(heightsFromPolarMoon)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(coloursFromPolarMars)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace meridian::globebrowsing
