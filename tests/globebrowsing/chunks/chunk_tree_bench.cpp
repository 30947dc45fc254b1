// Selection and culling of about a thousand visited chunks; the goal is 0.5 ms, that is 500 ns a chunk.

#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "fake_residency.h"
#include "globebrowsing/chunks/chunk_tree.h"
#include "globebrowsing/tiling/geodetic_tiling.h"
#include "test_views.h"

namespace meridian::globebrowsing {
namespace {

/// What costs nothing itself, so that selection alone is measured.
class FreeResidency final : public TileResidency {
 public:
  void want(const TileIndex&, double) override {}
  void keep(const TileIndex&) override {}
  [[nodiscard]] State state(const TileIndex&) const override { return State::Complete; }
  [[nodiscard]] HeightRange heightRange(const TileIndex&) const override { return {-100.0, 4000.0}; }
  [[nodiscard]] unsigned heightVersion(const TileIndex&) const override { return 1; }
  [[nodiscard]] double geometricError(const TileIndex& index, int step) const override {
    return std::ldexp(1e6, -2 * index.level - 2 * step);
  }
  [[nodiscard]] bool hasFinerColours(const TileIndex&) const override { return true; }
};

void select(benchmark::State& state) {
  const GeodeticTiling tiling(testEarth());
  ChunkTree tree(tiling);
  FreeResidency residency;
  SelectionSettings settings;
  // Dense enough to visit about a thousand chunks.
  settings.scale = 0.01 * static_cast<double>(state.range(0));
  const std::vector<SelectionView> views{viewAbove(testEarth(), {0.7, 0.2, 2e4}, 0.3, 0.3)};
  tree.select(views, settings, residency);
  for (auto _ : state) {
    tree.select(views, settings, residency);
    benchmark::DoNotOptimize(tree.selected().data());
  }
  const double visited = tree.figures().visited;
  state.counters["visited"] = visited;
  state.counters["drawn"] = static_cast<double>(tree.selected().size());
  // Printed with its unit, nanoseconds.
  state.counters["per_visited"] =
      benchmark::Counter(visited, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(select)->Arg(100)->Arg(200)->Arg(300)->Arg(400);

}  // namespace
}  // namespace meridian::globebrowsing
